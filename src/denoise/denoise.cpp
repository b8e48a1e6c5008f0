// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/error.h"
#include "denoise/light_layers.h"
#include "denoise/source_planes.h"
#include "denoise/tile_filter.h"

namespace orrery::denoise {
namespace {

/// Squared differences of patches, in variances, from which on they have nothing in common: of guides, and of the
/// beauty with and without two halves.
constexpr float kGuideTolerance = 4, kTolerance = 4, kToleranceOfImage = 2;

/// Radius of the window in which guides are filtered, px. They are less noisy than the beauty.
constexpr int kGuideRadius = 2;

struct Worker {
  TileScratch scratch;
  TileWeights weights;
  TilePixels pixels;
  std::vector<double> cells;
};

/// The tiles of an image.
class Tiles {
 public:
  Tiles(int width, int height) : width_(width), height_(height) {}

  /// Calls `f(worker, x, y)` with the upper left pixel of each tile, on all threads.
  template <class F>
  void each(F f) {
    const int columns = (width_ + kTileWidth - 1) / kTileWidth, rows = (height_ + kTileHeight - 1) / kTileHeight;
    tbb::parallel_for(0, columns * rows, [&](int tile) {
      f(workers_.local(), tile % columns * kTileWidth, tile / columns * kTileHeight);
    });
  }

  /// Calls `f(index in the tile, index in the image)` for the pixels of a tile that are within the image.
  template <class F>
  void each_pixel(int x0, int y0, F f) const {
    for (int y = y0; y < std::min(y0 + kTileHeight, height_); ++y)
      for (int x = x0; x < std::min(x0 + kTileWidth, width_); ++x)
        f(static_cast<std::size_t>((y - y0) * kTileWidth + x - x0),
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x));
  }

 private:
  int width_, height_;
  tbb::enumerable_thread_specific<Worker> workers_;
};

/// Filters the guides, which are noisy where the lens or motion blurs them and behind glass, by their own similarity.
std::vector<PaddedPlane> filtered_guides(const SourcePlanes& planes, int width, int height, Tiles& tiles) {
  WeightSource source;
  source.radius = kGuideRadius;
  source.tolerance = kGuideTolerance;
  source.valid = &planes.valid;
  for (std::size_t g = 0; g < kGuides; ++g)
    source.compared.push_back({&planes.guides[g], &planes.guides[g], &planes.guide_variance[g]});
  std::vector<std::vector<float>> out(
      kGuides, std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)));
  tiles.each([&](Worker& worker, int x, int y) {
    compute_weights(source, x, y, worker.scratch, worker.weights);
    for (std::size_t g = 0; g < kGuides; ++g) {
      apply_weights(worker.weights, source.radius, planes.guides[g], x, y, worker.pixels);
      tiles.each_pixel(x, y, [&](std::size_t from, std::size_t to) { out[g][to] = worker.pixels[from]; });
    }
  });
  std::vector<PaddedPlane> result;
  for (const std::vector<float>& values : out) result.push_back(padded(values, width, height));
  return result;
}

/// The weights' source for the beauty.
WeightSource beauty_source(const SourcePlanes& planes, const std::vector<PaddedPlane>& guides) {
  WeightSource source;
  source.tolerance = planes.has_halves ? kTolerance : kToleranceOfImage;
  source.valid = &planes.valid;
  source.target = planes.target();
  for (std::size_t c = 0; c < 3; ++c)
    source.compared.push_back(planes.has_halves
                                  ? ComparedChannel{&planes.a[c], &planes.b[c], &planes.variance[c]}
                                  : ComparedChannel{&planes.beauty[c], &planes.beauty[c], &planes.variance[c]});
  for (const PaddedPlane& guide : guides) source.guides.push_back(&guide);
  source.guide_variance = &planes.total_guide_variance;
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
  const std::vector<PaddedPlane> guides =
      planes.guides.empty() ? std::vector<PaddedPlane>() : filtered_guides(planes, width, height, tiles);
  const WeightSource source = beauty_source(planes, guides);
  std::vector<std::vector<PaddedPlane>> cells;
  for (const LightChannel& channel : lights.channels) {
    cells.emplace_back();
    for (const std::size_t cell : channel.cells)
      cells.back().push_back(padded(picture.planes[cell].values, width, height));
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
