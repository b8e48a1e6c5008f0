// SPDX-License-Identifier: Apache-2.0
#include "points/color_map.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "data/table.h"
#include "data/text_lines.h"

namespace orrery::points {

namespace {

/// The maps, each followed by the same one from its last colour to the first: `viridis_r`.
std::vector<ColorMap> make_maps() {
  std::vector<ColorMap> out;
  const auto add = [&](ColorMap map) {
    out.push_back(map);
    map.name += "_r";
    std::reverse(map.knots.begin(), map.knots.end());
    for (ColorMap::Knot& knot : map.knots) knot.t = 1 - knot.t;
    out.push_back(std::move(map));
  };
  for (const ContinuousTable& table : kContinuousTables) {
    ColorMap map{table.name, false, {}};
    for (const ColorMapRow& row : table.rows) map.knots.push_back({row.index / 255.0, {row.r, row.g, row.b}});
    add(std::move(map));
  }
  for (const CategoricalTable& table : kCategoricalTables) {
    ColorMap map{table.name, true, {}};
    for (const std::uint32_t code : table.colors) map.knots.push_back({0, bytes_of(code) / 255});
    add(std::move(map));
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

/// Maximum number of colours. Longer files are not colour maps.
constexpr std::size_t kMaxColors = 65'536;
/// Maximum size of a file: 128 bytes per row.
constexpr std::size_t kMaxBytes = kMaxColors * 128;

constexpr const char* kForms = "a line is `r g b`, `t r g b` or `#rrggbb`";

bool parse_numbers(const std::vector<std::string_view>& words, std::vector<double>& numbers) {
  numbers.resize(words.size());
  for (std::size_t i = 0; i < words.size(); ++i)
    if (!base::from_text(words[i], numbers[i]) || !std::isfinite(numbers[i])) return false;
  return true;
}

/// Collects the rows of a file. The first row determines its form.
class Reader {
 public:
  explicit Reader(data::Faults& faults) : faults_(faults) {}

  void add(std::uint64_t line, std::string_view text) {
    const std::vector<std::string_view> words = data::words_of(text, " \t,\r");
    if (words.empty()) return;
    if (words[0][0] == '#') {
      const std::optional<Vec3d> color = words.size() == 1 ? parse_hex(words[0]) : std::nullopt;
      if (color) add_row(line, kHex, static_cast<double>(rows_.size()), *color);  // otherwise a comment
      return;
    }
    std::vector<double> numbers;
    if (!parse_numbers(words, numbers)) {
      faults_.add_of_many(line, std::string("not a colour: ") + kForms);
    } else if (words.size() == 3) {
      add_row(line, 3, static_cast<double>(rows_.size()), {numbers[0], numbers[1], numbers[2]});
    } else if (words.size() == 4) {
      add_row(line, 4, numbers[0], {numbers[1], numbers[2], numbers[3]});
    } else {
      faults_.add_of_many(line, fmt::format("{} numbers; {}", words.size(), kForms));
    }
  }

  ColorMap take(std::string name) {
    faults_.raise_if_any();
    if (rows_.size() < 2) faults_.fail(0, "fewer than 2 colours", kForms);
    double largest = 0;
    for (const Row& row : rows_) largest = std::max({largest, row.color.x, row.color.y, row.color.z});
    const double scale = form_ == kHex || largest > 1 ? 255 : 1;
    ColorMap map{std::move(name), false, {}};
    const double first = rows_.front().t, span = rows_.back().t - first;
    if (!std::isfinite(span)) faults_.fail(0, "range of t is too large");
    for (const Row& row : rows_) {
      const double t = (row.t - first) / span;
      // Positions so close that they are equal after scaling: the last one counts.
      if (!map.knots.empty() && !(t > map.knots.back().t)) map.knots.pop_back();
      map.knots.push_back({t, row.color / scale});
    }
    return map;
  }

 private:
  struct Row {
    double t;
    Vec3d color;
  };
  static constexpr std::size_t kHex = 1;  ///< as words per row

  void add_row(std::uint64_t line, std::size_t form, double t, Vec3d color) {
    if (rows_.size() == kMaxColors) faults_.fail(line, fmt::format("more than {} colours", kMaxColors));
    if (form_ == 0) form_ = form;
    const bool is_out_of_range =
        std::min({color.x, color.y, color.z}) < 0 || std::max({color.x, color.y, color.z}) > 255;
    if (form != form_) {
      faults_.add_of_many(line, "not in the form of the first row");
    } else if (is_out_of_range) {
      faults_.add_of_many(line, "colour is out of range: 0 to 1, or 0 to 255");
    } else if (!rows_.empty() && !(t > rows_.back().t)) {
      faults_.add_of_many(line, "t does not ascend");
    }
    rows_.push_back({t, color});
  }

  data::Faults& faults_;
  std::size_t form_ = 0;  ///< words per row; 0: no row yet
  std::vector<Row> rows_;
};

}  // namespace

const ColorMap* find_color_map(std::string_view name) { return data::find_named(maps(), name); }

Vec3d bytes_of(std::uint32_t code) {
  return {static_cast<double>(code >> 16 & 255u), static_cast<double>(code >> 8 & 255u),
          static_cast<double>(code & 255u)};
}

std::optional<Vec3d> parse_hex(std::string_view text) {
  std::uint32_t code = 0;
  if (text.size() != 7 || text[0] != '#' || !base::from_text(text.substr(1), code, 16)) return {};
  return bytes_of(code);
}

const std::vector<std::string>& color_map_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const ColorMap& map : maps())
      if (!map.name.ends_with("_r")) out.push_back(map.name);
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

ValueScale::ValueScale(double first, double last, bool is_log)
    : first_(first),
      last_(last),
      is_log_(is_log),
      from_(is_log ? std::log10(first) : first),
      to_(is_log ? std::log10(last) : last),
      unit_(std::isfinite(to_ - from_) ? 1 : 0.5) {}

double ValueScale::share_of(double value) const {
  if (from_ == to_) return 0.5;
  const double inside = std::clamp(is_log_ ? std::log10(value) : value, std::min(from_, to_), std::max(from_, to_));
  return (inside * unit_ - from_ * unit_) / (to_ * unit_ - from_ * unit_);
}

ColorMap read_color_map(const std::filesystem::path& file) {
  base::require_readable(file);
  data::Faults faults(file);
  std::ifstream in(file, std::ios::binary);
  std::string text(kMaxBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw base::Error(base::ErrorKind::kIo, "cannot read " + file.string());
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMaxBytes) faults.fail(0, "file is larger than " + base::bytes_text(kMaxBytes), kForms);

  Reader reader(faults);
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  for (std::uint64_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    reader.add(line, rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return reader.take(file.filename().string());
}

Vec3d parse_color(const std::string& text) {
  // Those of CSS that are used as backgrounds.
  constexpr std::pair<std::string_view, std::string_view> kNames[] = {
      {"white", "#fff"},        {"black", "#000"},           {"grey", "#808080"},
      {"gray", "#808080"},      {"silver", "#c0c0c0"},       {"lightgrey", "#d3d3d3"},
      {"lightgray", "#d3d3d3"}, {"darkgrey", "#a9a9a9"},     {"darkgray", "#a9a9a9"},
      {"red", "#f00"},          {"green", "#008000"},        {"blue", "#00f"},
      {"navy", "#000080"},      {"midnightblue", "#191970"}, {"teal", "#008080"},
      {"cyan", "#0ff"},         {"magenta", "#f0f"},         {"yellow", "#ff0"},
      {"orange", "#ffa500"},    {"brown", "#a52a2a"},        {"maroon", "#800000"},
      {"purple", "#800080"},    {"ivory", "#fffff0"},        {"beige", "#f5f5dc"}};
  const auto* const known =
      std::find_if(std::begin(kNames), std::end(kNames), [&](const auto& n) { return n.first == base::lower(text); });
  std::string code(known == std::end(kNames) ? text : known->second);
  if (code.size() == 4) code = {code[0], code[1], code[1], code[2], code[2], code[3], code[3]};  // #rgb
  const std::optional<Vec3d> srgb = parse_hex(code);
  if (!srgb)
    base::refuse(fmt::format(
        "`{}` is not a colour; write white, grey, navy or the like, or #rrggbb, e.g. '#202030'; for the values of a "
        "column: --color-by COLUMN",
        text));
  return linear_from_srgb(*srgb / 255);
}

}  // namespace orrery::points
