// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "denoise/light_balance.h"
#include "denoise/light_layers.h"
#include "denoise/source_planes.h"
#include "denoise/tile_filter.h"

namespace orrery::denoise {
namespace {

/// Squared differences of patches, in units of the variance, at which their similarity becomes 0: of the filtered
/// halves, of the guides, and of the noisy halves.
constexpr float kTolerance = 32, kGuideTolerance = 4, kVarianceTolerance = 3;

/// Radius of the windows of the guides and of the halves, px. Guides are less noisy than the beauty. A larger window
/// for the halves would blur shadows before the final weights can distinguish them.
constexpr int kRadius = 1;

/// Radius of the windows over which the variance of the filtered halves is averaged, px.
constexpr int kNoiseRadius = 2;
/// Distance of the windows among which the smallest variance is taken, px: at least their radius, so that at an edge
/// between noisy and clean light one of them is on the pixel's side or on the cleaner one.
constexpr int kNoiseStep = 2;

/// Minimum variance of filtered halves, as a fraction of the unfiltered variance: halves can be equal by chance.
constexpr float kMinVariance = 0.06F;

/// Whether planes are constant in all pixels that the filter of a tile reads: it would not change them.
bool are_constant(const std::vector<const PaddedPlane*>& planes, Frame frame, int x, int y) {
  constexpr int kReach = PaddedPlane::kBorder;
  const int left = std::max(x - kReach, 0), right = std::min(x + kTileWidth + kReach, frame.width);
  const int top = std::max(y - kReach, 0), bottom = std::min(y + kTileHeight + kReach, frame.height);
  return std::all_of(planes.begin(), planes.end(), [&](const PaddedPlane* plane) {
    const float first = *plane->at(x, y);
    for (int row = top; row < bottom; ++row)
      if (std::any_of(plane->at(left, row), plane->at(right, row), [first](float v) { return v != first; }))
        return false;
    return true;
  });
}

/// Filters planes with the same weights, and calls `use(index of the plane, x, y, value)` for their pixels.
template <class Use>
void filter_planes(const WeightSource& source, const std::vector<const PaddedPlane*>& planes, Frame frame, Tiles& tiles,
                   Use use) {
  tiles.each([&](Worker& worker, int x, int y) {
    const bool is_constant = are_constant(planes, frame, x, y);
    if (!is_constant) compute_weights(source, x, y, worker.scratch, worker.weights);
    for (std::size_t i = 0; i < planes.size(); ++i) {
      if (is_constant)
        worker.pixels.fill(*planes[i]->at(x, y));
      else
        apply_weights(worker.weights, source.radius, *planes[i], x, y, worker.pixels);
      tiles.each_pixel(x, y,
                       [&](std::size_t in_tile, int column, int row) { use(i, column, row, worker.pixels[in_tile]); });
    }
  });
}

/// Planes filtered with the same weights.
std::vector<Values> filtered(const WeightSource& source, const std::vector<const PaddedPlane*>& planes, Frame frame,
                             Tiles& tiles) {
  std::vector<Values> out(planes.size());
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t i) { out[i].resize(frame.pixels()); });
  filter_planes(source, planes, frame, tiles,
                [&](std::size_t i, int x, int y, float value) { out[i][frame.at(x, y)] = value; });
  return out;
}

/// Filters the guides with weights from their own similarity. Guides are noisy under defocus and motion blur, and
/// behind glass.
///
/// `planes`   the noisy guides are removed
/// Result     kGuides planes
std::vector<PaddedPlane> filtered_guides(SourcePlanes& planes, Frame frame, Tiles& tiles) {
  WeightSource source;
  source.radius = kRadius;
  source.tolerance = kGuideTolerance;
  source.valid = &planes.valid;
  source.variance = &planes.guide_variance;
  std::vector<const PaddedPlane*> noisy;
  for (const PaddedPlane& guide : planes.guides) {
    source.compared.push_back({&guide, &guide});
    noisy.push_back(&guide);
  }
  std::vector<Values> clean = filtered(source, noisy, frame, tiles);
  planes.guides.clear();
  std::vector<PaddedPlane> out;
  for (Values& values : clean) {
    out.push_back(padded(values, frame));
    values = Values();  // frees its memory
  }
  return out;
}

/// The prefiltered halves of the beauty, which determine the final weights.
struct FilteredHalves {
  std::array<PaddedPlane, 3> a, b;
  PaddedPlane variance;  ///< variance of their mean, summed over the channels
};

/// Filters both halves of the beauty with the same weights, over a small window.
///
/// `planes`   the noisy halves are removed
/// `guides`   filtered
/// Reference  rousselle2012
FilteredHalves filtered_halves(SourcePlanes& planes, const std::vector<PaddedPlane>& guides, Frame frame,
                               Tiles& tiles) {
  WeightSource source;
  source.radius = kRadius;
  source.tolerance = kVarianceTolerance;
  source.valid = &planes.valid;
  source.variance = &planes.variance;
  for (const PaddedPlane& guide : guides) source.guides.push_back(&guide);
  source.guide_variance = &planes.guide_variance;
  std::vector<const PaddedPlane*> noisy;
  for (std::size_t c = 0; c < 3; ++c) {
    source.compared.push_back({&planes.a[c], &planes.b[c]});
    noisy.insert(noisy.end(), {&planes.a[c], &planes.b[c]});
  }
  std::vector<Values> clean = filtered(source, noisy, frame, tiles);
  for (auto* const noisy_half : {&planes.a, &planes.b})
    for (PaddedPlane& channel : *noisy_half) channel = {};
  FilteredHalves out;
  std::vector<HalfPair> halves;
  for (std::size_t c = 0; c < 3; ++c) halves.push_back({&clean[2 * c], &clean[2 * c + 1]});
  const Values variance =
      least_around(variance_of(halves, frame, kNoiseRadius, &planes.outliers.limits), frame, kNoiseStep);
  out.variance = padded(
      frame.each([&](int x, int y) { return variance[frame.at(x, y)] + kMinVariance * *planes.variance.at(x, y); }),
      frame);
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::size_t half : {2 * c, 2 * c + 1}) {
      (half == 2 * c ? out.a : out.b)[c] = padded(clean[half], frame);
      clean[half] = Values();
    }
  return out;
}

/// The weights' source for the beauty.
WeightSource beauty_source(const SourcePlanes& planes, const std::array<PaddedPlane, 3>& beauty,
                           const FilteredHalves& halves, const std::vector<PaddedPlane>& guides) {
  WeightSource source;
  source.tolerance = kTolerance;
  source.valid = &planes.valid;
  source.target = {&beauty[0], &beauty[1], &beauty[2]};
  source.variance = &halves.variance;
  for (std::size_t c = 0; c < 3; ++c) source.compared.push_back({&halves.a[c], &halves.b[c]});
  for (const PaddedPlane& guide : guides) source.guides.push_back(&guide);
  source.guide_variance = &planes.guide_variance;
  source.has_regression = true;
  return source;
}

/// Properties of a channel before filtering.
struct ChannelLight {
  bool is_positive;  ///< no value is negative; NaN counts as none
  bool is_complete;  ///< the cells add up to the beauty
};

/// Restores the light of a filtered channel, rounds its cells so that they add up to the beauty, and adds up its
/// layers.
///
/// `before`   the beauty before filtering, without outliers
void finish_channel(film::Picture& picture, Frame frame, const SourcePlanes& planes, const PaddedPlane& before,
                    std::size_t c, const LightChannel& channel, const std::vector<PaddedPlane>& noisy_cells,
                    ChannelLight light) {
  const PaddedPlane& valid = planes.valid;
  std::vector<float>& beauty = picture.planes[channel.beauty].values;
  std::vector<RemovedLight> removed;
  for (const Outlier& outlier : planes.outliers.pixels) {
    if (!outlier.is_spread) continue;
    const auto value = static_cast<double>(*before.at(frame.x(outlier.pixel), frame.y(outlier.pixel)));
    removed.push_back({outlier.pixel, std::max(value * (1 / static_cast<double>(outlier.factors[c]) - 1), 0.0)});
  }
  const LightBalance balance(before, beauty, valid, frame, removed);
  frame.each_row([&](int y) {
    std::vector<double> cells(channel.cells.size());
    auto outlier = planes.outliers.lower_bound(frame.at(0, y));
    for (int x = 0; x < frame.width; ++x) {
      if (*valid.at(x, y) == 0) continue;
      const std::size_t i = frame.at(x, y);
      const double factor = balance.at(x, y, *before.at(x, y), beauty[i]);
      while (outlier != planes.outliers.pixels.end() && outlier->pixel < i) ++outlier;
      const bool is_outlier = outlier != planes.outliers.pixels.end() && outlier->pixel == i;
      const double returned = is_outlier && !outlier->is_spread ? 1 / static_cast<double>(outlier->factors[c]) - 1 : 0;
      beauty[i] = static_cast<float>(factor * static_cast<double>(beauty[i]) +
                                     returned * static_cast<double>(*before.at(x, y)));
      // The regression may overshoot below zero.
      if (light.is_positive) beauty[i] = std::max(beauty[i], 0.0F);
      for (std::size_t k = 0; k < cells.size(); ++k)
        cells[k] = factor * static_cast<double>(picture.planes[channel.cells[k]].values[i]) +
                   returned * static_cast<double>(*noisy_cells[k].at(x, y));
      round_to_sum(cells, beauty[i], light.is_complete);
      for (std::size_t k = 0; k < cells.size(); ++k)
        picture.planes[channel.cells[k]].values[i] = static_cast<float>(cells[k]);
      for (const LightChannel::Sum& sum : channel.sums) {
        double total = 0;
        for (const std::size_t k : sum.cells) total += cells[k];
        picture.planes[sum.plane].values[i] = static_cast<float>(total);
      }
    }
  });
}

/// Index of the alpha plane, unless the whole image is opaque.
std::optional<std::size_t> partial_alpha(const film::Picture& picture) {
  const film::Plane* const plane = picture.find("A");
  if (plane == nullptr || std::all_of(plane->values.begin(), plane->values.end(), [](float a) { return a == 1; }))
    return {};
  return static_cast<std::size_t>(plane - picture.planes.data());
}

Report filter(film::Picture& picture, SourcePlanes planes) {
  const base::StopPoint stop;
  const Frame frame{picture.width, picture.height, &stop};
  const LightLayers lights = find_light_layers(picture);
  const bool is_complete = are_complete(picture, lights);
  Report report{lights.names, true, 0};
  std::array<bool, 3> is_positive{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float>& beauty = picture.planes[lights.channels[c].beauty].values;
    is_positive[c] = std::none_of(beauty.begin(), beauty.end(), [](float v) { return v < 0; });
  }
  Tiles tiles(frame);
  const std::vector<PaddedPlane> guides = filtered_guides(planes, frame, tiles);
  const FilteredHalves halves = filtered_halves(planes, guides, frame, tiles);
  std::array<PaddedPlane, 3> beauty;
  std::array<std::vector<PaddedPlane>, 3> cells;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto without_outliers = [&](std::size_t plane) {
      PaddedPlane out = padded(picture.planes[plane].values, frame);
      for (const Outlier& outlier : planes.outliers.pixels) scale_pixel(out, frame, outlier.pixel, outlier.factors[c]);
      return out;
    };
    beauty[c] = without_outliers(lights.channels[c].beauty);
    for (const std::size_t cell : lights.channels[c].cells) cells[c].push_back(without_outliers(cell));
  }
  const WeightSource source = beauty_source(planes, beauty, halves, guides);
  // Colours are premultiplied, so alpha must be filtered with the same weights.
  const std::optional<std::size_t> alpha = partial_alpha(picture);
  const PaddedPlane noisy_alpha = alpha ? padded(picture.planes[*alpha].values, frame) : PaddedPlane();
  std::vector<const PaddedPlane*> noisy;
  std::vector<std::size_t> targets;
  const auto add = [&](const PaddedPlane& from, std::size_t to) {
    noisy.push_back(&from);
    targets.push_back(to);
  };
  for (std::size_t c = 0; c < 3; ++c) {
    add(beauty[c], lights.channels[c].beauty);
    for (std::size_t i = 0; i < cells[c].size(); ++i) add(cells[c][i], lights.channels[c].cells[i]);
  }
  if (alpha) add(noisy_alpha, *alpha);
  filter_planes(source, noisy, frame, tiles, [&](std::size_t i, int x, int y, float value) {
    if (*planes.valid.at(x, y) != 0) picture.planes[targets[i]].values[frame.at(x, y)] = value;
  });
  // The regression may overshoot.
  if (alpha)
    for (float& a : picture.planes[*alpha].values) a = std::clamp(a, 0.0F, 1.0F);
  for (std::size_t c = 0; c < 3; ++c)
    finish_channel(picture, frame, planes, beauty[c], c, lights.channels[c], cells[c], {is_positive[c], is_complete});
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) report.bad_pixels += *planes.valid.at(x, y) == 0 ? 1 : 0;
  return report;
}

}  // namespace

Report denoise(film::Picture& picture, int threads, bool keeps_halves) {
  for (const char* name : {"R", "G", "B"}) picture.at(name);  // fails without the beauty
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  return arena.execute([&] {
    std::optional<SourcePlanes> planes = source_planes(picture, keeps_halves);
    if (!keeps_halves)
      std::erase_if(picture.planes, [](const film::Plane& plane) { return film::is_half(plane.name); });
    return planes ? filter(picture, std::move(*planes)) : Report();
  });
}

}  // namespace orrery::denoise
