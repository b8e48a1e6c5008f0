// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "plot/plot.h"
#include "points/color_map.h"

namespace orrery::plot {
namespace {

/// The enumerator with a name; none for an empty name.
template <class Enum>
std::optional<Enum> enumerator_of(const std::string& name, const std::vector<std::string>& names) {
  if (name.empty()) return {};
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

const std::vector<std::string>& representation_names() {
  static const std::vector<std::string> names = {"spheres", "ball-and-stick", "sticks"};
  return names;
}

const std::vector<std::string>& style_names() {
  static const std::vector<std::string> names = {"studio", "soft", "flat", "night", "ambient"};
  return names;
}

const std::vector<std::string>& quality_names() {
  static const std::vector<std::string> names = {"draft", "good", "final"};
  return names;
}

std::optional<Style> style_of(const std::string& name) { return enumerator_of<Style>(name, style_names()); }

std::optional<Quality> quality_of(const std::string& name) { return enumerator_of<Quality>(name, quality_names()); }

math::Vec3d color_of(const std::string& text) {
  constexpr std::pair<const char*, const char*> kNames[] = {
      {"white", "#ffffff"}, {"black", "#000000"}, {"grey", "#808080"}, {"gray", "#808080"}};
  const auto* const known =
      std::find_if(std::begin(kNames), std::end(kNames), [&](const auto& n) { return n.first == text; });
  const std::optional<math::Vec3d> srgb = points::parse_hex(known == std::end(kNames) ? text : known->second);
  if (!srgb)
    base::refuse(fmt::format("`{}` is not a colour; write white, black, grey or #rrggbb, e.g. '#202030'", text));
  return points::linear_from_srgb(*srgb / 255);
}

}  // namespace orrery::plot
