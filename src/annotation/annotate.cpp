// SPDX-License-Identifier: Apache-2.0
#include "annotation/annotate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <fmt/core.h>

#include "base/error.h"
#include "display/color_space.h"
#include "display/develop.h"
#include "display/settings.h"
#include "points/selection.h"
#include "points/sources.h"
#include "scene/value_text.h"

namespace orrery::annotation {
namespace {

// Lengths in font sizes.
constexpr double kMargin = 1, kBarThickness = 0.3, kTextGap = 0.4, kMiddle = 0.36;
/// Font sizes in the height of the image, and smallest font.
constexpr double kFontShare = 32;
constexpr double kSmallestFont = 9;
/// Font size in print, inches: 8 points.
constexpr double kPrintFont = 8.0 / 72;
/// Names in a legend; the others are counted.
constexpr std::size_t kMaxLabels = 20;
/// Width of the texts of a legend, in widths of the image; of a letter, in font sizes; and fewest letters that are
/// shown.
constexpr double kLegendWidth = 0.25, kLetterWidth = 0.6, kFewestLetters = 8, kFewestInLegend = 12;

/// Linear Rec.709, of legends and ink.
constexpr const char* kLegendSpace = "lin_rec709";

/// Luminance below which text is white.
constexpr double kDark = 0.18;

Vec3d ink_over(const scene::Background& background) {
  const bool is_plain = background.backdrop || background.type == scene::BackgroundType::kConstant;
  const Vec3d seen = background.backdrop.value_or(background.color);
  const double luminance = 0.2126 * seen.x + 0.7152 * seen.y + 0.0722 * seen.z;
  return background.alpha != 0 && is_plain && luminance < kDark ? Vec3d{1, 1, 1} : Vec3d{0, 0, 0};
}

/// The name or the file of a scene's font.
std::string font_of(const scene::Scene& scene, const View& view) {
  const std::string font = scene.annotation.font.string();
  return font.empty() ? kDefaultFont : scene::is_file_name(font) ? (view.folder / font).string() : font;
}

/// A title that fits into a width: if necessary in a smaller font, and if that is not enough, without its end.
/// Unchanged if there is not even space for a few letters.
///
/// `size`     font size, px
image::TextLine fitted(const std::string& title, double room, double size, const std::filesystem::path& font) {
  const auto width = [&](const std::string& text, double font_px) {
    return image::text_widths({text}, font_px, font).front();
  };
  image::TextLine out{title, kMargin * size, (kMargin + 0.8) * size, size, 0};
  const double full = width(title, size);
  if (full <= room || room < kFewestLetters * kLetterWidth * kSmallestFont) return out;
  out.size_px = std::max(kSmallestFont, std::floor(size * room / full));
  for (std::size_t bytes = title.size(); bytes > 0;) {
    const double share = room / width(out.text, out.size_px);
    if (share >= 1) break;
    bytes = std::min(bytes - 1, static_cast<std::size_t>(share * static_cast<double>(bytes)));
    out.text = shortened(title, bytes);
  }
  return out;
}

/// The number of decimals in ".2f"; none for other text.
std::optional<int> decimals_of(const std::string& format) {
  if (format.size() != 3 || format[0] != '.' || format[2] != 'f' || format[1] < '0' || format[1] > '9') return {};
  return format[1] - '0';
}

/// The value of "step * 0.005:.2f".
std::string field_text(const std::string& field, int frame, const scene::HeaderNumbers& header) {
  const std::size_t colon = points::end_of_expression(field);
  data::Table table;
  table.rows = 1;
  table.columns = {{"frame", std::vector<double>{static_cast<double>(frame)}}};
  for (const auto& [name, value] : header) table.columns.push_back({name, std::vector<double>{value}});
  std::vector<data::ColumnInfo> columns;
  for (const data::Column& column : table.columns) columns.push_back({column.name, column.type()});
  const auto refuse = [&](const std::string& text, const std::string& remedy) {
    throw base::Error(base::ErrorKind::kBadData,
                      fmt::format("annotation.title: {{{}}}: {}{}", field, text, remedy.empty() ? "" : "; " + remedy));
  };
  try {
    const double value = points::parse_expression(field.substr(0, colon), columns).evaluate(table)[0];
    if (colon == std::string::npos) return scene::number_text(value);
    const std::optional<int> decimals = decimals_of(field.substr(colon + 1));
    if (!decimals) refuse("no format after the colon", "write the number of decimals, e.g. {step:.2f}");
    return fmt::format("{:.{}f}", value, *decimals);
  } catch (const base::Error& error) {
    for (const base::Diagnostic& d : error.diagnostics()) refuse(d.text, d.remedy);
    throw;
  }
}

/// The labels of particles, and letters beyond the tips of the axes that `plot --axes` draws.
std::vector<scene::Label> labels_of(const scene::Scene& scene) {
  constexpr std::string_view kAxis = "axis_";
  constexpr double kBeyond = 0.3;  // in lengths of an axis
  std::vector<scene::Label> out;
  for (const scene::Rod& rod : scene.rods)
    if (rod.name.starts_with(kAxis))
      out.push_back({rod.to + (rod.to - rod.from) * kBeyond, rod.name.substr(kAxis.size())});
  for (const scene::Points& points : scene.points)
    out.insert(out.end(), points.placed_labels.begin(), points.placed_labels.end());
  return out;
}

}  // namespace

std::string title_of(const std::string& title, int frame, const scene::HeaderNumbers& header) {
  std::string out;
  for (std::size_t at = 0; at < title.size();) {
    const std::string_view rest = std::string_view(title).substr(at);
    if (rest.front() != '{' || rest.starts_with("{{")) {
      out += rest.front();
      at += rest.starts_with("{{") || rest.starts_with("}}") ? 2 : 1;
      continue;
    }
    const std::size_t close = rest.find('}');
    if (close == std::string::npos)
      throw base::Error(base::ErrorKind::kBadData,
                        "annotation.title: `{` is not closed; add `}`, or write `{{` for a brace");
    out += field_text(std::string(rest.substr(1, close - 1)), frame, header);
    at += close + 1;
  }
  return out;
}

std::string title_of(const scene::Scene& scene, int frame) {
  const scene::Points* const points = scene.points.empty() ? nullptr : &scene.points[0];
  return points == nullptr ? title_of(scene.annotation.title, frame, {})
                           : title_of(scene.annotation.title, points->frame.value_or(frame), points->header);
}

LegendColors legend_of(const scene::Scene& scene, const std::string& ocio) {
  for (const scene::Points& points : scene.points) {
    const auto conversion = display::pixel_conversion(ocio, scene.color.working_space(), kLegendSpace);
    std::vector<Vec3d> palette;
    for (const Vec3d& color : points.palette) palette.push_back(display::converted(conversion, color));
    LegendColors out;
    out.add(points, palette);
    out.range = points.color_range;
    if (!out.is_empty()) return out;
  }
  return {};
}

Drawing drawing_of(const scene::Scene& scene, const LegendColors& legend, const View& view) {
  const scene::Annotation& annotation = scene.annotation;
  const double automatic = scene.image.dpi > 0 ? kPrintFont * scene.image.dpi : view.height / kFontShare;
  const double size = annotation.font_size > 0 ? annotation.font_size : std::max(kSmallestFont, std::round(automatic));
  const double margin = kMargin * size;
  const std::vector<scene::Label> labels = view.project ? labels_of(scene) : std::vector<scene::Label>();
  Drawing out;
  out.width = view.width;
  out.height = view.height;
  out.ink = ink_over(scene.background);
  out.outline_px = annotation.outline;
  out.outline_depth = annotation.outline_depth;
  out.outline_objects = annotation.outline_objects;
  if (!annotation.title.empty() || annotation.scale_bar || annotation.color_bar || !labels.empty())
    out.font = image::font_file(font_of(scene, view));
  // The legend is below a title and above a scale bar at its side.
  const bool is_left = annotation.color_at.ends_with("left"), is_top = annotation.color_at.starts_with("top");
  const double above = is_left && !annotation.title.empty() ? 2 * size : 0;
  const double below = is_left && annotation.scale_bar ? 2 * size : 0;
  Drawing bar;
  if (annotation.color_bar && !legend.is_empty()) {
    const auto most_bytes =
        static_cast<std::size_t>(std::max(kLegendWidth * view.width / (kLetterWidth * size), kFewestInLegend));
    LegendColors titled = legend;
    if (!annotation.color_title.empty()) titled.title = annotation.color_title;
    bar = legend_drawing(titled, {size, view.height - 2 * margin - above - below, kMaxLabels, most_bytes, out.ink},
                         out.font);
  }
  if (!annotation.title.empty()) {
    const double beside = bar.is_empty() || is_left || !is_top ? 0 : bar.width + margin;
    out.texts.push_back(fitted(title_of(scene, view.frame), view.width - 2 * margin - beside, size, out.font));
  }
  if (annotation.scale_bar && scene.camera.width) {
    const double width = *annotation.scale_bar / *scene.camera.width * view.width, bottom = view.height - margin,
                 top = bottom - kBarThickness * size;
    const std::string unit = annotation.unit.empty() ? "" : " " + annotation.unit;
    out.boxes.push_back({margin, top, margin + width, bottom, out.ink});
    out.texts.push_back({scene::number_text(*annotation.scale_bar) + unit, margin, top - kTextGap * size, size, 0});
  }
  if (!bar.is_empty())
    place(bar, is_left ? margin : view.width - margin - bar.width,
          is_top ? margin + above : view.height - margin - below - bar.height, out);
  for (const scene::Label& label : labels)
    if (const auto at = view.project(label.at))
      out.labels.push_back({label.text, at->first, at->second + kMiddle * size, size, 0.5});
  return out;
}

std::string missing_glyphs(const Drawing& drawing) {
  std::string all;
  for (const std::vector<image::TextLine>* lines : {&drawing.texts, &drawing.labels})
    for (const image::TextLine& line : *lines) all += line.text;
  const bool is_plain = std::all_of(all.begin(), all.end(), [](char c) { return c >= ' ' && c <= '~'; });
  return is_plain ? "" : image::missing_glyphs(all, drawing.font);
}

std::function<Vec3d(const Vec3d&)> shown_by(display::Settings display) {
  display.working_space = kLegendSpace;
  display.backdrop = Vec3d{};  // annotations are on the page: looks of the view do not apply to them
  return [developer = std::make_shared<display::PixelDeveloper>(display)](const Vec3d& color) {
    float rgb[] = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
    std::uint8_t codes[3];
    const float coverage = 0;
    (*developer)(rgb, &coverage, 1, codes);
    return Vec3d{double(codes[0]), double(codes[1]), double(codes[2])} / 255;
  };
}

}  // namespace orrery::annotation
