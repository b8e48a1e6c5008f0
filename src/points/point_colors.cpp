// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "data/elements.h"
#include "math/scalar.h"
#include "points/sources.h"
#include "scene/value_text.h"

namespace orrery::points {
namespace {

/// Number of colours sampled from a continuous map: as many as a display distinguishes.
constexpr std::size_t kMapColors = 256;
/// Maximum number of distinct values in a column of types or elements.
constexpr std::size_t kMaxLabels = 4096;
constexpr std::size_t kMaxPalette = 65536;

Vec3d linear_from_code(std::uint32_t code) { return linear_from_srgb(bytes_of(code) / 255); }

/// Labels of a column, or an error if it has too many distinct values.
std::optional<Labels> labels_or_fault(const data::Table& table, const Rows& rows, const std::string& column,
                                      const char* part, KeyFaults& faults) {
  const bool is_text = table.find(column)->type() == data::ColumnType::kText;
  return require_labels(table, rows, column, kMaxLabels, part, faults,
                        is_text ? "colour by another column" : "use a continuous map, e.g. viridis, or another column");
}

/// Gives each label the colour with its index, of a palette that is still empty.
void set_labels(const Labels& labels, scene::Points& points) {
  points.colors = {labels.of_rows.begin(), labels.of_rows.end()};
  points.color_names = labels.names;
}

/// The index of the colour of an integer among those of a categorical map, whose first is that of 1.
std::size_t category_of(double value, std::size_t count) {
  const auto n = static_cast<double>(count);
  const double place = std::fmod(value - 1, n);
  return std::isfinite(place) ? static_cast<std::size_t>(place < 0 ? place + n : place) : 0;
}

/// Returns the index of each label's colour in a categorical map, before it is reduced modulo the number of colours. If
/// possible, the index does not depend on which labels occur, so that colours do not change between frames and
/// selections: an integer selects the colour with its number, from 1; a string the one with its position among all
/// strings of the column.
std::vector<std::size_t> categories_of(const Labels& labels, const data::Column& column, std::size_t count) {
  std::vector<std::size_t> out(labels.names.size());
  std::iota(out.begin(), out.end(), 0U);
  if (const auto* words = std::get_if<data::Words>(&column.values)) {
    std::vector<std::string> all = words->words;
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), labels.names[i]) - all.begin());
    return out;
  }
  const auto is_integer = [](double v) { return v == std::floor(v) || std::isnan(v); };
  if (!std::all_of(labels.values.begin(), labels.values.end(), is_integer)) return out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = category_of(labels.values[i], count);
  return out;
}

/// Distributes distinct values evenly over a continuous map, or assigns the colours of a categorical one.
std::vector<Vec3d> colors_of(const Labels& labels, const data::Column& column, const ColorMap& map) {
  if (!map.is_categorical) return palette(map, std::max<std::size_t>(labels.names.size(), 1));
  std::vector<Vec3d> out;
  for (const std::size_t category : categories_of(labels, column, map.knots.size()))
    out.push_back(linear_from_srgb(map.knots[category % map.knots.size()].srgb));
  return out;
}

void color_by_label(const Labels& labels, const data::Column& column, const ColorMap& map, scene::Points& points) {
  set_labels(labels, points);
  points.palette = colors_of(labels, column, map);
  points.palette_rec709 = points.palette.size();
  if (!labels.values.empty() && std::isnan(labels.values.back())) {
    points.palette.back() = points.color.nan_color;
    --points.palette_rec709;
  }
}

/// Gives integers, of which there are too many for a name each, the colours that categories_of() gives them, named "1,
/// 11, ...".
///
/// Result     false for columns of other values
bool color_by_remainder(const data::Column& column, const Rows& rows, const ColorMap& map, scene::Points& points) {
  const std::size_t count = map.knots.size();
  bool are_integers = column.type() != data::ColumnType::kText;
  if (!are_integers) return false;
  std::vector<std::uint16_t> colors(rows.size());
  for_each_number(column, rows, [&](std::size_t i, double v) {
    are_integers = are_integers && v == std::floor(v);
    colors[i] = static_cast<std::uint16_t>(category_of(v, count));
  });
  if (!are_integers) return false;
  points.colors = std::move(colors);
  points.palette = palette(map, count);
  points.palette_rec709 = count;
  for (std::size_t i = 1; i <= count; ++i) points.color_names.push_back(fmt::format("{}, {}, ...", i, i + count));
  return true;
}

/// The range of the values of a column that a map shows, if there are any.
std::optional<scene::Interval> range_of(const data::Column& column, const Rows& rows, bool is_log) {
  scene::Interval range{math::kInfinity, -math::kInfinity};
  for_each_shown(column, rows, is_log, [&](double v) {
    range.low = std::min(range.low, v);
    range.high = std::max(range.high, v);
  });
  if (!(range.low <= range.high)) return {};
  return range;
}

void color_by_number(const data::Column& column, const Rows& rows, const ColorMap& map, scene::Points& points,
                     KeyFaults& faults) {
  const scene::PointsColor& color = points.color;
  points.palette = palette(map, kMapColors);
  points.palette_rec709 = kMapColors;
  points.palette.push_back(color.nan_color);
  points.color_range = color.range ? color.range : range_of(column, rows, color.log);
  if (color.log && points.color_range && !(points.color_range->low > 0))
    return faults.error(".color.range", "must be above 0 with color.log");
  const scene::Interval range = points.color_range.value_or(scene::Interval{1, 1});
  const ValueScale scale(range.low, range.high, color.log);
  points.colors.resize(rows.size());
  std::size_t without_log = 0;
  bool has_nan = false;
  for_each_number(column, rows, [&](std::size_t i, double v) {
    if (color.log && v <= 0) ++without_log;
    const bool has_color = color.log ? v > 0 : !std::isnan(v);
    points.colors[i] =
        has_color ? static_cast<std::uint16_t>(scale.share_of(v) * (kMapColors - 1) + 0.5) : std::uint16_t{kMapColors};
    has_nan = has_nan || !has_color;
  });
  points.has_nan_color = has_nan;
  if (without_log > 0)
    faults.warning(".color.log", fmt::format("{} of {} values are not above 0, and have the colour of NaN", without_log,
                                             rows.size()));
}

void color_by_map(const data::Table& table, const Rows& rows, const ColorSource& source, scene::Points& points,
                  KeyFaults& faults) {
  const std::string& name = points.color.column;
  const data::Column& column = *table.find(name);
  if (!source.map->is_categorical && column.type() != data::ColumnType::kText)
    return color_by_number(column, rows, *source.map, points, faults);
  const Labels labels = labels_of(column, rows, kMaxLabels);
  if (labels.of_rows.size() == rows.size()) return color_by_label(labels, column, *source.map, points);
  if (!source.map->is_categorical || !color_by_remainder(column, rows, *source.map, points))
    labels_or_fault(table, rows, name, ".color.column", faults);  // reports that there are too many
}

/// Gives carbon atoms the colours of another column, after those of the elements.
void color_carbons(const data::Table& table, const Rows& rows, const ColorMap& map, scene::Points& points,
                   KeyFaults& faults) {
  const auto carbon = std::find_if(points.color_names.begin(), points.color_names.end(), [](const std::string& name) {
    return data::find_element(name) == data::find_element(6);
  });
  const std::string& name = points.color.carbon;
  const std::optional<Labels> labels = labels_or_fault(table, rows, name, ".color.carbon", faults);
  if (!labels || carbon == points.color_names.end()) return;
  // The first of the colours replaces that of carbon.
  const auto first = static_cast<std::size_t>(carbon - points.color_names.begin()), rest = points.palette.size() - 1;
  const std::vector<Vec3d> colors = colors_of(*labels, *table.find(name), map);
  points.palette[first] = colors[0];
  points.palette.insert(points.palette.end(), colors.begin() + 1, colors.end());
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (points.colors[i] == first && labels->of_rows[i] > 0)
      points.colors[i] = static_cast<std::uint16_t>(rest + labels->of_rows[i]);
  points.color_names[first] = fmt::format("C ({})", labels->names[0]);
  for (std::size_t label = 1; label < labels->names.size(); ++label)
    points.color_names.push_back(fmt::format("C ({})", labels->names[label]));
}

void color_by_element(const data::Table& table, const Rows& rows, const ColorSource& source, scene::Points& points,
                      KeyFaults& faults) {
  const auto labels = labels_or_fault(table, rows, source.columns[0], ".color.element", faults);
  if (!labels) return;
  set_labels(*labels, points);
  // Unknown elements have Jmol's colour of unknown elements.
  constexpr std::uint32_t kUnknown = 0xFF1493;
  // Colours of full saturation look like neon beside others, and on shaded spheres have no highlights. Grey stays.
  constexpr double kWhite = 0.25;
  for (const std::string& name : labels->names) {
    const data::Element* const element = data::find_element(name);
    Vec3d srgb = bytes_of(element != nullptr ? element->color : kUnknown) / 255;
    if (points.color.element == "soft") {
      const double white = kWhite * (std::max({srgb.x, srgb.y, srgb.z}) - std::min({srgb.x, srgb.y, srgb.z}));
      srgb = srgb * (1 - white) + Vec3d{white, white, white};
    }
    points.palette.push_back(linear_from_srgb(srgb));
  }
  if (!points.color.carbon.empty()) color_carbons(table, rows, *source.map, points, faults);
  points.palette_rec709 = points.palette.size();
}

void color_by_type(const data::Table& table, const Rows& rows, const ColorSource& source, scene::Points& points,
                   KeyFaults& faults) {
  const auto labels = labels_or_fault(table, rows, source.columns[0], ".color.type", faults);
  if (!labels) return;
  set_labels(*labels, points);
  const scene::ColorsByType& types = points.color.types;
  std::vector<std::string> missing;
  for (const std::string& name : labels->names) {
    const auto found = std::find_if(types.begin(), types.end(), [&](const auto& type) { return type.first == name; });
    if (found == types.end()) missing.push_back(fmt::format("`{}`", name));
    points.palette.push_back(found == types.end() ? Vec3d{} : found->second);
  }
  constexpr std::size_t kMaxNamed = 10;
  if (!missing.empty()) {
    missing.resize(std::min(missing.size(), kMaxNamed));
    faults.error(".color.type", fmt::format("type {} has no colour; add it", base::joined(missing)));
  }
}

/// The value of full intensity. Floating-point colours are from 0 to 1, but some programs write 0 to 255, in which case
/// most non-zero values exceed 1.
double full_intensity(const data::Table& table, const Rows& rows, const ColorSource& source, KeyFaults& faults) {
  if (source.rgb_maximum != 1) return source.rgb_maximum;
  std::uint64_t above = 0, positive = 0;
  double largest = 0;
  for (const std::string& name : source.columns)
    for_each_number(*table.find(name), rows, [&](std::size_t, double v) {
      above += v > 1 ? 1 : 0;
      positive += v > 0 ? 1 : 0;
      if (v > largest) largest = v;
    });
  constexpr double kMaxOvershoot = 2;
  if (2 * above <= positive || largest <= kMaxOvershoot) return 1;
  const double full = largest > 255 ? 65535 : 255;
  faults.warning(".color.rgb", "most values exceed 1; full intensity is taken as " + scene::number_text(full));
  return full;
}

/// The file's colours as 24 bits per sphere.
std::vector<std::uint32_t> bytes_of(const data::Table& table, const Rows& rows, const ColorSource& source,
                                    KeyFaults& faults) {
  const double full = full_intensity(table, rows, source, faults);
  std::vector<std::uint32_t> out(rows.size());
  std::uint64_t nan = 0, out_of_range = 0;
  for (const std::string& name : source.columns) {
    for_each_number(*table.find(name), rows, [&](std::size_t i, double v) {
      nan += std::isnan(v) ? 1 : 0;
      out_of_range += v < 0 || v > full ? 1 : 0;
      const double byte = std::isnan(v) ? 0 : std::clamp(v / full, 0.0, 1.0) * 255;
      out[i] = out[i] << 8 | static_cast<std::uint32_t>(byte + 0.5);
    });
  }
  if (nan > 0) faults.warning(".color.rgb", fmt::format("{} values are NaN and are replaced by 0", nan));
  if (out_of_range > 0)
    faults.warning(".color.rgb",
                   fmt::format("{} values are outside 0..{} and were clamped", out_of_range, scene::number_text(full)));
  return out;
}

void color_by_rgb(const data::Table& table, const Rows& rows, const ColorSource& source, scene::Points& points,
                  KeyFaults& faults) {
  std::vector<std::uint32_t> bytes = bytes_of(table, rows, source, faults);
  constexpr std::uint32_t kColors = std::uint32_t{1} << 24;
  std::vector<std::uint32_t> index(kColors);
  std::vector<std::uint32_t> distinct;
  for (int dropped = 0;; ++dropped) {
    // Keeps the high bits of each channel and the middle of the dropped ones.
    const std::uint32_t low = (1U << dropped) - 1, middle = dropped > 0 ? 1U << (dropped - 1) : 0;
    const std::uint32_t keep = ~(low << 16 | low << 8 | low), set = middle << 16 | middle << 8 | middle;
    distinct.clear();
    std::fill(index.begin(), index.end(), 0);
    for (std::uint32_t& b : bytes) {
      b = (b & keep) | set;
      index[b] = 1;
    }
    for (std::uint32_t b = 0; b < kColors; ++b) {
      if (index[b] == 0) continue;
      index[b] = static_cast<std::uint32_t>(distinct.size());
      distinct.push_back(b);
    }
    if (distinct.size() <= kMaxPalette) break;
  }
  for (const std::uint32_t code : distinct) points.palette.push_back(linear_from_code(code));
  points.palette_rec709 = points.palette.size();
  points.colors.resize(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) points.colors[i] = static_cast<std::uint16_t>(index[bytes[i]]);
}

void set_map(const scene::PointsColor& color, const std::filesystem::path& folder, ColorSource& out,
             KeyFaults& faults) {
  if (const ColorMap* map = find_color_map(color.map)) {
    out.map = *map;
  } else if (color.has_map_file()) {
    out.map = read_color_map(folder / color.map);
  } else {
    const std::string suggestion = base::did_you_mean(color.map, color_map_names());
    faults.error(".color.map",
                 fmt::format("there is no colour map \"{}\"; {}maps are {}, and files with an extension, e.g. map.txt",
                             color.map, suggestion.empty() ? "" : suggestion + " ", base::joined(color_map_names())));
  }
}

/// True if the text is not a column, and cannot be a misspelt one.
bool is_expression(const std::string& text, const data::FrameInfo& info) {
  constexpr std::string_view kSymbols = "+-*/^(){}<>=!&|`\"' ";
  return data::find_named(info.columns, text) == nullptr && text.find_first_of(kSymbols) != std::string::npos;
}

void parse_column(const std::string& text, const data::FrameInfo& info, ColorSource& out, KeyFaults& faults) {
  try {
    out.expression = parse_expression(text, info.columns);
    out.columns = out.expression->columns();
  } catch (const base::Error& error) {
    faults.error(".color.column", fmt::format("`{}` is no column, and no expression: {}", text, fault_text(error)));
  }
}

/// Gives rows that match rules the colours of these, which are the last linear Rec.709 ones of the palette.
void color_by_rules(const data::Table& table, const Rows& rows, const std::vector<Rule<Vec3d>>& rules,
                    scene::Points& points, KeyFaults& faults) {
  if (points.colors.empty()) {
    constexpr Vec3d kOthers{0.8, 0.8, 0.8};
    points.colors.assign(rows.size(), 0);
    points.palette = {kOthers};
    points.palette_rec709 = 1;
  }
  const std::size_t first = points.palette_rec709, count = rules.size();
  if (points.palette.size() + count > kMaxPalette)
    return faults.error(".color.where", "there are too many colours; leave out `color.rgb`, or some of the rules");
  for (std::uint16_t& color : points.colors)
    if (color >= first) color = static_cast<std::uint16_t>(color + count);
  const auto at = static_cast<std::ptrdiff_t>(first);
  for (std::size_t r = 0; r < count; ++r)
    points.palette.insert(points.palette.begin() + at + static_cast<std::ptrdiff_t>(r), rules[r].value);
  if (!points.color_names.empty()) points.color_names.insert(points.color_names.begin() + at, count, "");
  points.palette_rec709 += count;
  std::size_t rule = 0;
  std::vector<Rule<std::uint16_t>> indices;
  for (const Rule<Vec3d>& of : rules) indices.push_back({of.condition, static_cast<std::uint16_t>(first + rule++)});
  apply_rules(table, rows, indices, points.color.where, ".color.where", faults,
              [&](std::size_t i, std::uint16_t color) { points.colors[i] = color; });
}

}  // namespace

void add_expression(const ColorSource& source, const scene::PointsColor& color, data::Table& table, KeyFaults& faults) {
  if (!source.expression) return;
  std::vector<double> values = source.expression->evaluate(table);
  std::size_t bad = 0;
  for (double& value : values) {
    if (std::isfinite(value)) continue;
    value = std::numeric_limits<double>::quiet_NaN();
    ++bad;
  }
  if (bad > 0)
    faults.warning(".color.column", fmt::format("{} of {} values of `{}` are not finite, and have the colour of NaN",
                                                bad, values.size(), color.column));
  table.columns.push_back({color.column, std::move(values)});
}

ColorSource color_source(const data::FrameInfo& info, const scene::PointsColor& color,
                         const std::filesystem::path& folder, KeyFaults& faults) {
  ColorSource out;
  const int set = (color.column.empty() ? 0 : 1) + (color.element.empty() ? 0 : 1) + (color.types.empty() ? 0 : 1) +
                  (color.rgb ? 1 : 0);
  if (set > 1) {
    faults.error(".color", "only one of `column`, `element`, `type` and `rgb` can be set");
  } else if (!color.column.empty()) {
    out.kind = ColorSource::Kind::kMap;
    set_map(color, folder, out, faults);
    if (is_expression(color.column, info)) {
      parse_column(color.column, info, out, faults);
    } else if (require_column(info, color.column, false, ".color.column", faults)) {
      out.columns = {color.column};
    }
  } else if (!color.element.empty()) {
    out.kind = ColorSource::Kind::kElement;
    out.columns = {require_role(info, info.roles.element, "column of chemical elements", ".color.element", faults)};
    if (!color.carbon.empty()) {
      set_map(color, folder, out, faults);
      if (require_column(info, color.carbon, false, ".color.carbon", faults)) out.columns.push_back(color.carbon);
    }
  } else if (!color.types.empty()) {
    out.kind = ColorSource::Kind::kType;
    out.columns = {require_role(info, info.roles.type, "column of particle types", ".color.type", faults)};
  } else if (color.rgb) {
    out.kind = ColorSource::Kind::kRgb;
    out.columns = {info.roles.rgb.begin(), info.roles.rgb.end()};
    out.rgb_maximum = info.roles.rgb_maximum;
    require_role(info, info.roles.rgb[0], "colours", ".color.rgb", faults);
  }
  out.rules = rules_of(info, color.where, ".color.where", parse_color, faults);
  return out;
}

void set_colors(const data::Table& table, const Rows& rows, const ColorSource& source, scene::Points& points,
                KeyFaults& faults) {
  switch (source.kind) {
    case ColorSource::Kind::kNone: break;
    case ColorSource::Kind::kMap: color_by_map(table, rows, source, points, faults); break;
    case ColorSource::Kind::kElement: color_by_element(table, rows, source, points, faults); break;
    case ColorSource::Kind::kType: color_by_type(table, rows, source, points, faults); break;
    case ColorSource::Kind::kRgb: color_by_rgb(table, rows, source, points, faults); break;
  }
  if (!source.rules.empty()) color_by_rules(table, rows, source.rules, points, faults);
}

}  // namespace orrery::points
