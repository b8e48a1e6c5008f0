// SPDX-License-Identifier: Apache-2.0
#include "annotation/legend_colors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "image/format.h"
#include "image/write.h"
#include "points/legend.h"

namespace orrery::annotation {
namespace {

/// Colours as the display shows them.
///
/// Units      scene-linear Rec.709 to display-referred, 8 bits per channel
std::vector<points::Srgb8> developed(const std::vector<math::Vec3d>& colors, display::Settings settings) {
  settings.working_space = "lin_rec709";
  film::Picture row;
  row.width = static_cast<int>(colors.size());
  row.height = 1;
  for (const char* name : {"R", "G", "B"}) row.planes.push_back({name, {}, film::PlaneKind::kLight});
  for (const math::Vec3d& c : colors) {
    row.planes[0].values.push_back(static_cast<float>(c.x));
    row.planes[1].values.push_back(static_cast<float>(c.y));
    row.planes[2].values.push_back(static_cast<float>(c.z));
  }
  const film::EncodedPicture encoded = display::develop(row, settings, 8);
  std::vector<points::Srgb8> out(colors.size());
  for (std::size_t i = 0; i < 3 * colors.size(); ++i) out[i / 3][i % 3] = static_cast<std::uint8_t>(encoded.values[i]);
  return out;
}

points::Legend legend_of(const LegendColors& colors, const display::Settings& display) {
  points::Legend legend;
  legend.title = colors.title;
  if (!colors.labels.empty()) {
    for (const auto& [label, color] : colors.labels) legend.patches.push_back({label, developed({color}, display)[0]});
    return legend;
  }
  if (!colors.range)
    throw base::Error(base::ErrorKind::kUsage, "--legend: the colours are not those of a column, types or elements");
  legend.bar = developed(colors.bar, display);
  if (colors.nan_color) legend.nan_color = developed({*colors.nan_color}, display)[0];
  legend.first = colors.range->low;
  legend.last = colors.range->high;
  legend.is_log = colors.is_log;
  return legend;
}

void write_image(const std::filesystem::path& file, const points::Legend& legend) {
  if (legend.patches.size() > points::kMaxImagePatches)
    throw base::Error(
        base::ErrorKind::kUsage,
        fmt::format("--legend: an image shows up to {} values; name an .svg file", points::kMaxImagePatches));
  const points::LegendImage image = points::legend_image(legend);
  film::EncodedPicture picture;
  picture.width = image.width;
  picture.height = image.height;
  for (const points::Srgb8& pixel : image.pixels)
    picture.values.insert(picture.values.end(), pixel.begin(), pixel.end());
  image::write_encoded(file, picture, "orrery");
}

std::optional<double> number_of(std::string_view label) {
  double value = 0;
  const auto [end, error] = std::from_chars(label.data(), label.data() + label.size(), value);
  if (error != std::errc() || end != label.data() + label.size() || std::isnan(value)) return {};
  return value;
}

}  // namespace

bool LabelOrder::operator()(std::string_view a, std::string_view b) const {
  const std::optional<double> x = number_of(a), y = number_of(b);
  if (x && y && *x != *y) return *x < *y;
  return x.has_value() != y.has_value() ? x.has_value() : a < b;
}

void LegendColors::add(const scene::Points& frame) {
  const scene::PointsColor& key = frame.color;
  title = !key.column.empty() ? key.column : key.element.empty() ? "type" : "element";
  for (std::size_t i = 0; i < std::min(frame.palette.size(), frame.color_names.size()); ++i) {
    const auto [label, is_new] = labels.try_emplace(frame.color_names[i], frame.palette[i]);
    has_conflict = has_conflict || (!is_new && label->second != frame.palette[i]);
  }
  if (!frame.color_names.empty() || key.column.empty() || frame.palette.empty()) return;
  // The last colour stands for values that are not numbers.
  const std::size_t last = frame.palette.size() - 1;
  is_log = key.log;
  bar.assign(frame.palette.begin(), frame.palette.end() - 1);
  if (std::find(frame.colors.begin(), frame.colors.end(), last) != frame.colors.end()) nan_color = frame.palette[last];
}

std::string legend_svg(const LegendColors& colors, const display::Settings& display) {
  if (colors.labels.empty() && !colors.range) return {};
  return points::legend_svg(legend_of(colors, display));
}

void write_legend(const std::filesystem::path& file, const LegendColors& colors, const display::Settings& display) {
  const points::Legend legend = legend_of(colors, display);
  if (base::extension(file) == ".svg") return base::write_text_file(file, points::legend_svg(legend));
  if (!image::is_display_format(image::format_of(file)))
    throw base::Error(base::ErrorKind::kUsage, "--legend: name an .svg or .png file");
  write_image(file, legend);
}

}  // namespace orrery::annotation
