// SPDX-License-Identifier: Apache-2.0
#include "film/light_cells.h"

#include <algorithm>

#include "film/layers.h"
#include "film/sums.h"
#include "math/scalar.h"

namespace orrery::film {
namespace {

using kernel::Int128;
using kernel::kLobes;

Int128 magnitude(Int128 v) { return v < 0 ? -v : v; }

}  // namespace

LightCells::LightCells(const LayerRequest& request, std::span<const LayerSums::Channels> light,
                       const kernel::PixelSum& beauty)
    : groups_(request.light_cells() / kLobes), values_(request.light_cells() * 3) {
  for (std::size_t c = 0; c < 3; ++c) divide(request, light, beauty, c);
}

/// All groups of one lobe precede those of the next: the lobes then have the same bits with and without groups.
void LightCells::divide(const LayerRequest& request, std::span<const LayerSums::Channels> light,
                        const kernel::PixelSum& beauty, std::size_t c) {
  const auto whole = math::in_single_precision(mean(beauty.rgb[c], beauty.weight));
  if (whole == 0) return;
  Int128 total = 0, all = 0;
  for (const LayerSums::Channels& sum : light) {
    total += sum[c];
    all += magnitude(sum[c]);
  }
  if (all == 0) {
    // The events are below the unit of the sums, but their sum, a few units at most, is not.
    const auto with_sources = [](const LightGroup& group) { return group.has_sources(); };
    const auto group = std::find_if(request.groups.begin(), request.groups.end(), with_sources);
    const bool found = request.light_groups && group != request.groups.end();
    cell(found ? static_cast<std::size_t>(group - request.groups.begin()) : 0, 1, c) = whole;
    return;
  }
  // A path's radiance is the rounded sum of its events; the difference is spread over the cells in proportion.
  const double excess = mean(beauty.rgb[c] - total, beauty.weight);
  ExactParts parts(whole);
  Int128 sum = 0, seen = 0;
  for (std::size_t lobe = 0; lobe < kLobes; ++lobe) {
    for (std::size_t group = 0; group < groups_; ++group) {
      const std::size_t i = group * kLobes + lobe;
      if (light[i][c] == 0) continue;
      sum += light[i][c];
      seen += magnitude(light[i][c]);
      const double share = static_cast<double>(seen) / static_cast<double>(all);
      // `excess` is rounded; no cell must become negative if no event is.
      cell(group, lobe, c) =
          seen == all ? parts.rest() : parts.next(mean(sum, beauty.weight) + excess * share, total == all);
    }
  }
}

float LightCells::of(std::size_t group, kernel::Lobe lobe, std::size_t channel) const {
  return static_cast<float>(values_[(group * kLobes + static_cast<std::size_t>(lobe)) * 3 + channel]);
}

float LightCells::of_lobe(kernel::Lobe lobe, std::size_t channel) const {
  double sum = 0;
  for (std::size_t group = 0; group < groups_; ++group) sum += of(group, lobe, channel);
  return static_cast<float>(sum);
}

float LightCells::of_group(std::size_t group, std::size_t channel) const {
  double sum = 0;
  for (int lobe = 0; lobe < kLobes; ++lobe) sum += of(group, static_cast<kernel::Lobe>(lobe), channel);
  return static_cast<float>(sum);
}

}  // namespace orrery::film
