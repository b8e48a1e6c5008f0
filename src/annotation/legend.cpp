// SPDX-License-Identifier: Apache-2.0
#include "annotation/legend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "annotation/annotate.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/text.h"
#include "display/settings.h"
#include "film/picture.h"
#include "image/format.h"
#include "image/write.h"
#include "math/pixels.h"

namespace orrery::annotation {
namespace {

// Lengths in font sizes.
constexpr double kTitleHeight = 1.5, kTitleBaseline = 0.8, kColorWidth = 1, kBarHeight = 12, kColorGap = 0.4,
                 kTickLength = 0.3, kLineWidth = 0.06, kPatchPitch = 1.5, kMiddleOfText = 0.36, kTickPitch = 1.1;

/// Of legends in files, px. Screens and papers show SVG at its own size.
constexpr double kSvgFont = 14, kImageFont = 28;
constexpr std::size_t kMaxTextBytes = 60;
/// Few programs could open a larger image.
constexpr std::size_t kMaxImageLabels = 500;

/// Adds the parts of a legend from the top.
class LegendLayout {
 public:
  LegendLayout(const LegendStyle& style, const std::filesystem::path& font)
      : style_(style), em_(style.font_px), line_(std::max(1.0, kLineWidth * em_)) {
    out_.font = font;
    out_.ink = style.ink;
  }

  void add_title(const std::string& title) {
    add_text(title, 0, kTitleBaseline * em_);
    y_ += kTitleHeight * em_;
  }

  void add_bar(const LegendColors& colors) {
    const points::ValueScale scale(colors.range->low, colors.range->high, colors.is_log);
    const double right = kColorWidth * em_;
    const double height = std::max(1.0, std::min(kBarHeight * em_, style_.height_px - y_ - em_));
    add_frame(right, height);
    out_.bars.push_back({0, y_, right, y_ + height, colors.bar});
    for (const Tick& tick : ticks_of(scale, std::max(0.1, kTickPitch * em_ / height))) {
      const double y = y_ + height * (1 - scale.share_of(tick.value)), end = right + kTickLength * em_;
      out_.boxes.push_back({right, y - line_ / 2, end, y + line_ / 2, out_.ink});
      add_text(tick.label, end + kColorGap * em_, y + kMiddleOfText * em_);
    }
    y_ += height + em_;
  }

  void add_patch(const std::string& label, const std::optional<Vec3d>& color) {
    if (color) {
      add_frame(kColorWidth * em_, em_);
      out_.boxes.push_back({0, y_, kColorWidth * em_, y_ + em_, *color});
    }
    add_text(label, (kColorWidth + kColorGap) * em_, y_ + (0.5 + kMiddleOfText) * em_);
    y_ += kPatchPitch * em_;
  }

  Drawing take() {
    std::vector<std::string> texts;
    for (const image::TextLine& text : out_.texts) texts.push_back(text.text);
    const std::vector<double> widths = image::text_widths(texts, em_, out_.font);
    double width = 0;
    for (std::size_t i = 0; i < widths.size(); ++i) width = std::max(width, out_.texts[i].x + widths[i]);
    out_.width = static_cast<int>(std::ceil(width));
    out_.height = static_cast<int>(std::ceil(y_));
    return std::move(out_);
  }

 private:
  void add_text(const std::string& text, double x, double y) {
    out_.texts.push_back({shortened(text, style_.most_bytes), x, y, em_, 0});
  }

  /// A frame about a bar or a patch at the left; a white one would not be seen on white.
  void add_frame(double width, double height) {
    out_.boxes.push_back({-line_, y_ - line_, width + line_, y_ + height + line_, out_.ink});
  }

  const LegendStyle style_;
  const double em_, line_;
  double y_ = 0;
  Drawing out_;
};

/// A legend on white, in display colours.
Drawing page(const LegendColors& colors, const display::Settings& display, double font_px) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  constexpr std::size_t kMany = std::numeric_limits<std::size_t>::max();
  const Drawing legend = legend_drawing(shown_colors(colors, display), {font_px, kAny, kMany, kMaxTextBytes},
                                        image::font_file(kDefaultFont));
  Drawing out;
  out.font = legend.font;
  out.width = legend.width + static_cast<int>(2 * font_px);
  out.height = legend.height + static_cast<int>(2 * font_px);
  out.boxes.push_back({0, 0, static_cast<double>(out.width), static_cast<double>(out.height), {1, 1, 1}});
  place(legend, font_px, font_px, out);
  return out;
}

std::optional<double> number_of(std::string_view label) {
  const auto value = base::number_of<double>(label);
  return value && !std::isnan(*value) ? value : std::nullopt;
}

}  // namespace

std::string shortened(const std::string& text, std::size_t most_bytes) {
  const std::string_view prefix = base::utf8_prefix(text, most_bytes);
  return std::string(prefix) + (prefix.size() < text.size() ? "…" : "");
}

bool LabelOrder::operator()(std::string_view a, std::string_view b) const {
  const std::optional<double> x = number_of(a), y = number_of(b);
  if (x && y && *x != *y) return *x < *y;
  return x.has_value() != y.has_value() ? x.has_value() : a < b;
}

void LegendColors::add(const scene::Points& frame, const std::vector<Vec3d>& palette) {
  const scene::PointsColor& key = frame.color;
  title = !key.column.empty() ? key.column : key.element.empty() ? "type" : "element";
  for (std::size_t i = 0; i < std::min(palette.size(), frame.color_names.size()); ++i) {
    if (frame.color_names[i].empty()) continue;
    const auto [label, is_new] = labels.try_emplace(frame.color_names[i], palette[i]);
    has_conflict = has_conflict || (!is_new && label->second != palette[i]);
  }
  if (!frame.color_names.empty() || key.column.empty() || palette.empty()) return;
  is_log = key.log;
  bar.assign(palette.begin(), palette.end() - 1);
  if (frame.has_nan_color) nan_color = palette.back();
}

Drawing legend_drawing(const LegendColors& colors, const LegendStyle& style, const std::filesystem::path& font) {
  LegendLayout layout(style, font);
  layout.add_title(colors.title);
  if (colors.labels.empty()) {
    layout.add_bar(colors);
    if (colors.nan_color) layout.add_patch("no value", *colors.nan_color);
    return layout.take();
  }
  const double room = std::max((style.height_px / style.font_px - kTitleHeight) / kPatchPitch, 1.0);
  const std::size_t most =
      room < static_cast<double>(style.most_labels) ? static_cast<std::size_t>(room) : style.most_labels;
  const bool has_rest = colors.labels.size() > most;
  std::size_t left = has_rest ? most - 1 : colors.labels.size();
  for (auto label = colors.labels.begin(); left > 0; ++label, --left) layout.add_patch(label->first, label->second);
  if (has_rest) layout.add_patch(fmt::format("{} more", colors.labels.size() - most + 1), {});
  return layout.take();
}

LegendColors shown_colors(LegendColors colors, const display::Settings& display) {
  const std::function<Vec3d(const Vec3d&)> shown = shown_by(display);
  for (auto& [label, color] : colors.labels) color = shown(color);
  for (Vec3d& color : colors.bar) color = shown(color);
  if (colors.nan_color) colors.nan_color = shown(*colors.nan_color);
  return colors;
}

void write_legend(const std::filesystem::path& file, const LegendColors& colors, const display::Settings& display) {
  if (colors.is_empty())
    base::refuse("--legend: there is no legend: no colour is that of a value of a column, of a type or of an element");
  if (base::extension(file) == ".svg")
    return base::write_text_file(file, svg(page(colors, display, kSvgFont), std::identity()));
  if (!image::is_display_format(image::format_of(file))) base::refuse("--legend: name an .svg or .png file");
  if (colors.labels.size() > kMaxImageLabels)
    base::refuse(fmt::format("--legend: an image shows up to {} values; name an .svg file", kMaxImageLabels));
  const Drawing drawing = page(colors, display, kImageFont);
  film::EncodedPicture picture;
  picture.width = drawing.width;
  picture.height = drawing.height;
  picture.values.resize(3 * math::pixel_count(drawing.width, drawing.height));
  blend(draw(drawing, std::identity()), picture);
  image::write_encoded(file, picture, "orrery");
}

}  // namespace orrery::annotation
