// SPDX-License-Identifier: Apache-2.0
#include "plot/write_legend.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/output_file.h"
#include "film/picture.h"
#include "image/format.h"
#include "image/write.h"
#include "points/legend.h"

namespace orrery::plot {
namespace {

/// Size of the bar as an image, px.
constexpr int kBarWidth = 64, kBarHeight = 512;

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

points::Legend legend_of(const scene::Points& points, const display::Settings& display) {
  points::Legend legend;
  legend.title = !points.color.column.empty() ? points.color.column : points.color.element.empty() ? "type" : "element";
  std::vector<points::Srgb8> colors = developed(points.palette, display);
  if (!points.color_names.empty()) {
    for (std::size_t i = 0; i < std::min(colors.size(), points.color_names.size()); ++i)
      legend.patches.push_back({points.color_names[i], colors[i]});
    return legend;
  }
  if (!points.color_range)
    throw base::Error(base::ErrorKind::kUsage, "--legend: the colours are not those of a column, types or elements");
  // The last colour stands for values that are not numbers.
  const bool has_nan = std::find(points.colors.begin(), points.colors.end(), colors.size() - 1) != points.colors.end();
  if (has_nan) legend.nan_color = colors.back();
  colors.pop_back();
  legend.bar = std::move(colors);
  legend.first = points.color_range->low;
  legend.last = points.color_range->high;
  return legend;
}

void write_bar(const std::filesystem::path& file, const points::Legend& legend) {
  if (legend.bar.empty())
    throw base::Error(base::ErrorKind::kUsage,
                      "--legend: an image shows the bar of a colour map only; name an .svg file");
  film::EncodedPicture picture;
  picture.width = kBarWidth;
  picture.height = kBarHeight;
  for (const points::Srgb8& pixel : points::bar_pixels(legend.bar, kBarWidth, kBarHeight))
    picture.values.insert(picture.values.end(), pixel.begin(), pixel.end());
  image::write_encoded(file, picture, "orrery");
}

}  // namespace

void write_legend(const std::filesystem::path& file, const scene::Points& points, const display::Settings& display) {
  const points::Legend legend = legend_of(points, display);
  if (file.extension() == ".svg") return base::write_text_file(file, points::legend_svg(legend));
  if (!image::is_display_format(image::format_of(file)))
    throw base::Error(base::ErrorKind::kUsage, "--legend: name an .svg or .png file");
  write_bar(file, legend);
}

}  // namespace orrery::plot
