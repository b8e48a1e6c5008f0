// SPDX-License-Identifier: Apache-2.0
#include "points/color_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "points/color_map_tables.h"

namespace orrery::points {
namespace {

std::vector<ColorMap> make_maps() {
  std::vector<ColorMap> out;
  for (const ContinuousTable& table : kContinuousTables) {
    ColorMap map{table.name, false, {}};
    for (const ColorMapRow& row : table.rows) map.knots.push_back({row.index / 255.0, {row.r, row.g, row.b}});
    out.push_back(std::move(map));
  }
  for (const CategoricalTable& table : kCategoricalTables) {
    ColorMap map{table.name, true, {}};
    for (const std::uint32_t code : table.colors) {
      const Vec3d bytes{static_cast<double>(code >> 16 & 255u), static_cast<double>(code >> 8 & 255u),
                        static_cast<double>(code & 255u)};
      map.knots.push_back({0, bytes / 255});
    }
    out.push_back(std::move(map));
  }
  return out;
}

const std::vector<ColorMap>& maps() {
  static const std::vector<ColorMap> all = make_maps();
  return all;
}

double srgb_from_linear(double light) {
  return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

double linear_component(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

}  // namespace

const ColorMap* find_color_map(std::string_view name) {
  const auto found = std::find_if(maps().begin(), maps().end(), [&](const ColorMap& map) { return map.name == name; });
  return found == maps().end() ? nullptr : &*found;
}

const std::vector<std::string>& color_map_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const ColorMap& map : maps()) out.push_back(map.name);
    return out;
  }();
  return names;
}

Vec3d srgb_at(const ColorMap& map, double t) {
  const std::vector<ColorMap::Knot>& knots = map.knots;
  if (map.is_categorical) {
    const auto count = static_cast<double>(knots.size());
    return knots[static_cast<std::size_t>(std::clamp(std::floor(t * count), 0.0, count - 1))].srgb;
  }
  if (t <= knots.front().t) return knots.front().srgb;
  const auto next = std::upper_bound(knots.begin(), knots.end(), t,
                                     [](double value, const ColorMap::Knot& knot) { return value < knot.t; });
  if (next == knots.end()) return knots.back().srgb;
  const ColorMap::Knot& previous = *std::prev(next);
  const double share = (t - previous.t) / (next->t - previous.t);
  return previous.srgb * (1 - share) + next->srgb * share;
}

std::vector<Vec3d> palette(const ColorMap& map, std::size_t count) {
  std::vector<Vec3d> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
    out[i] = linear_from_srgb(map.is_categorical ? map.knots[i % map.knots.size()].srgb : srgb_at(map, t));
  }
  return out;
}

Vec3d linear_from_srgb(Vec3d srgb) {
  return {linear_component(srgb.x), linear_component(srgb.y), linear_component(srgb.z)};
}

Vec3d srgb_from_linear(Vec3d linear) {
  return {srgb_from_linear(linear.x), srgb_from_linear(linear.y), srgb_from_linear(linear.z)};
}

}  // namespace orrery::points
