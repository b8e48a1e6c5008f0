// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/error.h"
#include "denoise/light_layers.h"
#include "denoise/prefilter.h"
#include "denoise/source_planes.h"
#include "denoise/tiles.h"

namespace orrery::denoise {
namespace {

/// Squared differences of patches of the beauty, in variances, from which on they have nothing in common: of filtered
/// halves, and without halves.
constexpr float kTolerance = 8, kToleranceOfImage = 2.5F;

/// The weights' source for the beauty.
WeightSource beauty_source(const SourcePlanes& planes, const FilteredHalves& halves,
                           const std::vector<PaddedPlane>& guides) {
  WeightSource source;
  source.tolerance = planes.has_halves ? kTolerance : kToleranceOfImage;
  source.valid = &planes.valid;
  source.target = planes.target();
  source.variance = planes.has_halves ? &halves.variance : &planes.variance;
  for (std::size_t c = 0; c < 3; ++c)
    source.compared.push_back(planes.has_halves ? ComparedChannel{&halves.a[c], &halves.b[c]}
                                                : ComparedChannel{&planes.beauty[c], &planes.beauty[c]});
  for (const PaddedPlane& guide : guides) source.guides.push_back(&guide);
  source.guide_variance = &planes.guide_variance;
  source.has_regression = !guides.empty();
  return source;
}

Report filter(film::Picture& picture) {
  const int width = picture.width, height = picture.height;
  const SourcePlanes planes = source_planes(picture);
  const LightLayers lights = find_light_layers(picture);
  const bool is_complete = are_complete(picture, lights);
  Report report{lights.names, planes.missing, !planes.guides.empty(), 0};
  std::array<bool, 3> is_positive{};  // no value is negative; NaN counts as none
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float>& beauty = picture.planes[lights.channels[c].beauty].values;
    is_positive[c] = std::none_of(beauty.begin(), beauty.end(), [](float v) { return v < 0; });
  }
  Tiles tiles(width, height);
  const Frame frame{width, height};
  const std::vector<PaddedPlane> guides =
      planes.guides.empty() ? std::vector<PaddedPlane>() : filtered_guides(planes, frame, tiles);
  const FilteredHalves halves = planes.has_halves ? filtered_halves(planes, guides, frame, tiles) : FilteredHalves();
  const WeightSource source = beauty_source(planes, halves, guides);
  std::vector<std::vector<PaddedPlane>> cells;
  for (const LightChannel& channel : lights.channels) {
    cells.emplace_back();
    for (const std::size_t cell : channel.cells) cells.back().push_back(padded(picture.planes[cell].values, frame));
  }
  tiles.each([&](Worker& worker, int x, int y) {
    compute_weights(source, x, y, worker.scratch, worker.weights);
    std::vector<TilePixels> filtered;
    for (std::size_t c = 0; c < 3; ++c) {
      const LightChannel& channel = lights.channels[c];
      apply_weights(worker.weights, source.radius, planes.beauty[c], x, y, worker.pixels);
      filtered.resize(channel.cells.size());
      for (std::size_t i = 0; i < filtered.size(); ++i)
        apply_weights(worker.weights, source.radius, cells[c][i], x, y, filtered[i]);
      worker.cells.resize(filtered.size());
      tiles.each_pixel(x, y, [&](std::size_t from, std::size_t to) {
        if (*planes.valid.at(static_cast<int>(to % static_cast<std::size_t>(width)),
                             static_cast<int>(to / static_cast<std::size_t>(width))) == 0)
          return;
        // The regression may overshoot below zero.
        const float beauty = is_positive[c] ? std::max(worker.pixels[from], 0.0F) : worker.pixels[from];
        picture.planes[channel.beauty].values[to] = beauty;
        if (filtered.empty()) return;
        for (std::size_t i = 0; i < filtered.size(); ++i) worker.cells[i] = static_cast<double>(filtered[i][from]);
        round_to_sum(worker.cells, beauty, is_complete);
        for (std::size_t i = 0; i < filtered.size(); ++i)
          picture.planes[channel.cells[i]].values[to] = static_cast<float>(worker.cells[i]);
        for (const LightChannel::Sum& sum : channel.sums) {
          double total = 0;
          for (const std::size_t i : sum.cells) total += worker.cells[i];
          picture.planes[sum.plane].values[to] = static_cast<float>(total);
        }
      });
    }
  });
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) report.bad_pixels += *planes.valid.at(x, y) == 0 ? 1 : 0;
  return report;
}

}  // namespace

Report denoise(film::Picture& picture, int threads) {
  for (const char* name : {"R", "G", "B"})
    if (picture.find(name) == nullptr)
      throw base::Error(base::ErrorKind::kBadData, std::string("the image has no channel ") + name);
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  return arena.execute([&] { return filter(picture); });
}

void remove_halves(film::Picture& picture) {
  std::erase_if(picture.planes, [](const film::Plane& plane) {
    return plane.name.starts_with("half_a.") || plane.name.starts_with("half_b.");
  });
}

}  // namespace orrery::denoise
