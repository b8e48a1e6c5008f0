// SPDX-License-Identifier: Apache-2.0
#include "denoise/light_layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "base/text.h"
#include "film/layers.h"
#include "film/light_cells.h"

namespace orrery::denoise {
namespace {

std::optional<std::size_t> index_of(const film::Picture& picture, const std::string& name) {
  for (std::size_t i = 0; i < picture.planes.size(); ++i)
    if (picture.planes[i].name == name) return i;
  return {};
}

/// Names of the light groups, in file order: layers G for which there is a layer G_LOBE.
std::vector<std::string> light_groups(const film::Picture& picture) {
  std::set<std::string> layers;
  for (const film::Plane& plane : picture.planes) layers.insert(plane.layer());
  std::vector<std::string> out;
  for (const film::Plane& plane : picture.planes) {
    const std::string layer = plane.layer();
    const auto has_lobe = [&](const char* lobe) { return layers.count(layer + "_" + lobe) > 0; };
    if (!layer.empty() && !base::contains(out, layer) &&
        std::any_of(std::begin(film::kLobeNames), std::end(film::kLobeNames), has_lobe))
      out.push_back(layer);
  }
  return out;
}

}  // namespace

LightLayers find_light_layers(const film::Picture& picture) {
  LightLayers out;
  const std::vector<std::string> groups = light_groups(picture);
  for (const char letter : {'R', 'G', 'B'}) {
    const std::string end = std::string(".") + letter;
    LightChannel channel;
    channel.beauty = *index_of(picture, std::string(1, letter));
    std::map<std::string, LightChannel::Sum> of_group;
    for (const char* lobe : film::kLobeNames) {
      const auto whole = index_of(picture, lobe + end);
      LightChannel::Sum of_lobe{whole.value_or(0), {}};
      for (const std::string& group : groups) {
        const auto cell = index_of(picture, group + "_" + lobe + end);
        if (!cell) continue;
        of_lobe.cells.push_back(channel.cells.size());
        of_group[group].cells.push_back(channel.cells.size());
        channel.cells.push_back(*cell);
      }
      if (whole && of_lobe.cells.empty()) {
        channel.cells.push_back(*whole);
      } else if (whole) {
        channel.sums.push_back(of_lobe);
      }
    }
    for (auto& [group, sum] : of_group) {
      if (const auto plane = index_of(picture, group + end)) {
        sum.plane = *plane;
        channel.sums.push_back(sum);
      }
    }
    out.channels.push_back(std::move(channel));
  }
  const LightChannel& red = out.channels.front();
  for (const std::size_t cell : red.cells) out.names.push_back(picture.planes[cell].layer());
  for (const LightChannel::Sum& sum : red.sums) out.names.push_back(picture.planes[sum.plane].layer());
  return out;
}

void round_to_sum(std::vector<double>& cells, float beauty, bool is_complete) {
  const double sign = beauty < 0 ? -1 : 1, whole = sign * static_cast<double>(beauty);
  if (whole == 0 || !std::isfinite(whole) || cells.empty()) {
    std::fill(cells.begin(), cells.end(), 0.0);
    return;
  }
  // Light that the regression took below zero in one layer is missing in the others. Without cells of the other sign
  // no sum exceeds the beauty, whose last bit therefore suffices for all of them.
  double sum = 0;
  for (double& cell : cells) sum += cell = std::max(sign * cell, 0.0);
  if (sum > whole || (is_complete && sum > 0))
    for (double& cell : cells) cell *= whole / sum;
  if (sum == 0 && is_complete) cells.front() = whole;
  const auto is_lit = [](double cell) { return cell != 0; };
  const auto last = std::find_if(cells.rbegin(), cells.rend(), is_lit);
  const bool has_rest = is_complete && last != cells.rend();
  film::ExactParts parts(whole);
  sum = 0;
  for (double& cell : cells) {
    sum += cell;
    cell = sign * (has_rest && &cell >= &*last ? parts.rest() : parts.next(sum, true));
  }
}

bool are_complete(const film::Picture& picture, const LightLayers& layers) {
  // Half precision rounds each layer by up to 2^-11 of its value.
  constexpr double kTolerance = 0x1p-9, kSmallest = 0x1p-20;
  for (const LightChannel& channel : layers.channels) {
    const std::vector<float>& beauty = picture.planes[channel.beauty].values;
    for (std::size_t i = 0; i < beauty.size(); ++i) {
      double sum = 0;
      for (const std::size_t cell : channel.cells) sum += static_cast<double>(picture.planes[cell].values[i]);
      const auto whole = static_cast<double>(beauty[i]);
      if (std::abs(sum - whole) > kTolerance * std::abs(whole) + kSmallest) return false;  // false for NaN
    }
  }
  return true;
}

}  // namespace orrery::denoise
