// SPDX-License-Identifier: Apache-2.0
#include "annotation/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "base/hash.h"
#include "base/text.h"
#include "math/pixels.h"

namespace orrery::annotation {
namespace {

/// Width of the contour of labels, as a part of the size of their font.
constexpr double kContour = 0.12;

/// Layers of colour with coverage, one over the other.
class Canvas {
 public:
  Canvas(int width, int height) : overlay_{width, height, {}} { overlay_.rgba.resize(4 * pixels()); }

  std::size_t pixels() const { return math::pixel_count(overlay_.width, overlay_.height); }

  /// Puts a colour over a pixel.
  void paint(std::size_t pixel, const Vec3d& color, double coverage) {
    if (!(coverage > 0)) return;
    const double a = std::min(coverage, 1.0), colors[] = {color.x, color.y, color.z, 1};
    float* const to = &overlay_.rgba[4 * pixel];
    for (std::size_t c = 0; c < 4; ++c) to[c] = static_cast<float>(to[c] * (1 - a) + colors[c] * a);
  }

  void paint(const std::vector<float>& coverage, const Vec3d& color) {
    for (std::size_t i = 0; i < coverage.size(); ++i) paint(i, color, coverage[i]);
  }

  void paint(const Box& box, const Vec3d& color) {
    paint(box.left, box.top, box.right, box.bottom, [&](int) { return color; });
  }

  /// `colors`   of the bar, as they are to be shown
  void paint(const Bar& bar, const std::vector<Vec3d>& colors) {
    paint(bar.left, bar.top, bar.right, bar.bottom, [&](int y) {
      const double share = std::clamp((bar.bottom - y - 0.5) / (bar.bottom - bar.top), 0.0, 1.0);
      const double at = share * static_cast<double>(colors.size() - 1);
      const auto i = static_cast<std::size_t>(at);
      const double t = at - static_cast<double>(i);
      return colors[i] * (1 - t) + colors[std::min(i + 1, colors.size() - 1)] * t;
    });
  }

  Overlay take() { return std::move(overlay_); }

 private:
  /// `color_of`   the colour of a row of pixels
  template <class F>
  void paint(double left, double top, double right, double bottom, F color_of) {
    const auto covered = [](double begin, double end, int at) {
      return std::max(0.0, std::min(end, at + 1.0) - std::max(begin, static_cast<double>(at)));
    };
    const auto first = [](double at) { return std::max(0, static_cast<int>(std::floor(at))); };
    for (int y = first(top); y < std::min<double>(overlay_.height, bottom); ++y)
      for (int x = first(left); x < std::min<double>(overlay_.width, right); ++x)
        paint(math::pixel_index(x, y, overlay_.width), color_of(y), covered(left, right, x) * covered(top, bottom, y));
  }

  Overlay overlay_;
};

/// The largest coverage within a distance of each pixel.
std::vector<float> dilated(const std::vector<float>& coverage, int width, int height, int reach) {
  // Dilates rows, and makes them columns.
  const auto pass = [reach](const std::vector<float>& from, int length, int rows) {
    std::vector<float> to(from.size());
    for (int y = 0; y < rows; ++y) {
      const float* const row = &from[math::pixel_index(0, y, length)];
      for (int x = 0; x < length; ++x)
        to[math::pixel_index(y, x, rows)] =
            *std::max_element(row + std::max(0, x - reach), row + std::min(length, x + reach + 1));
    }
    return to;
  };
  return pass(pass(coverage, width, height), height, width);
}

std::string hex(const Vec3d& color) {
  const auto byte = [](double c) { return static_cast<int>(std::lround(std::clamp(c, 0.0, 1.0) * 255)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.x), byte(color.y), byte(color.z));
}

std::string xml(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = base::printable_length(text, at);
    const std::string character = text.substr(at, std::max<std::size_t>(length, 1));
    out += length == 0        ? "?"
           : character == "<" ? "&lt;"
           : character == ">" ? "&gt;"
           : character == "&" ? "&amp;"
                              : character;
    at += character.size();
  }
  return out;
}

std::string svg_text(const image::TextLine& line, const std::string& ink, const std::string& contour) {
  const std::string outline =
      contour.empty()
          ? ""
          : fmt::format(" stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
                        contour, 2 * kContour * line.size_px);
  return fmt::format(
      "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.2f}\" text-anchor=\"{}\" fill=\"{}\"{}>{}</text>\n", line.x,
      line.y, line.size_px,
      line.anchor < 0.25   ? "start"
      : line.anchor < 0.75 ? "middle"
                           : "end",
      ink, outline, xml(line.text));
}

std::string svg_bar(const Bar& bar, std::size_t number, const std::function<Vec3d(const Vec3d&)>& shown) {
  const std::size_t last = bar.colors.size() - 1;
  std::string out = fmt::format("<linearGradient id=\"bar{}\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">\n", number);
  for (std::size_t i = 0; i <= last; ++i)
    out +=
        fmt::format("<stop offset=\"{:.2f}%\" stop-color=\"{}\"/>\n",
                    last > 0 ? 100 * static_cast<double>(i) / static_cast<double>(last) : 0, hex(shown(bar.colors[i])));
  return out + fmt::format(
                   "</linearGradient>\n<rect x=\"{:.3f}\" y=\"{:.3f}\" width=\"{:.3f}\" height=\"{:.3f}\" "
                   "fill=\"url(#bar{})\"/>\n",
                   bar.left, bar.top, bar.right - bar.left, bar.bottom - bar.top, number);
}

/// The font of a drawing and a replacement, for an attribute in double quotes.
std::string svg_font(const std::filesystem::path& font) {
  std::string family = font.empty() ? "" : image::font_family(font);
  std::erase_if(family, [](char c) { return c == '"' || c == '\'' || c == '\\'; });
  return family.empty() ? "sans-serif" : fmt::format("'{}', sans-serif", xml(family));
}

Vec3d opposite(const Vec3d& ink) { return Vec3d{1, 1, 1} - ink; }

/// Puts a pixel of an overlay over the codes of a pixel, which are R, G, B and, if it has alpha, A.
template <class Code>
void blend_pixel(const float* over, double largest, bool has_alpha, Code* pixel) {
  if (!(over[3] > 0)) return;
  const auto code = [&](double v) { return static_cast<Code>(std::lround(std::clamp(v, 0.0, 1.0) * largest)); };
  const double below = (has_alpha ? pixel[3] / largest : 1) * (1 - over[3]), alpha = below + over[3];
  for (std::size_t c = 0; c < 3; ++c) pixel[c] = code((pixel[c] / largest * below + over[c]) / alpha);
  if (has_alpha) pixel[3] = code(alpha);
}

}  // namespace

void place(const Drawing& part, double x, double y, Drawing& into) {
  for (const Box& box : part.boxes)
    into.boxes.push_back({box.left + x, box.top + y, box.right + x, box.bottom + y, box.color});
  for (const Bar& bar : part.bars)
    into.bars.push_back({bar.left + x, bar.top + y, bar.right + x, bar.bottom + y, bar.colors});
  for (image::TextLine text : part.texts) {
    text.x += x;
    text.y += y;
    into.texts.push_back(std::move(text));
  }
}

std::vector<Box> covered_by(const Drawing& drawing) {
  constexpr double kDescent = 0.25;  // below the baseline, in font sizes
  std::vector<Box> out = drawing.boxes;
  for (const Bar& bar : drawing.bars) out.push_back({bar.left, bar.top, bar.right, bar.bottom, {}});
  for (const image::TextLine& line : drawing.texts) {
    const double width = image::text_widths({line.text}, line.size_px, drawing.font).front();
    const double left = line.x - line.anchor * width;
    out.push_back({left, line.y - line.size_px, left + width, line.y + kDescent * line.size_px, {}});
  }
  return out;
}

Overlay draw(const Drawing& drawing, const std::function<Vec3d(const Vec3d&)>& shown) {
  Canvas canvas(drawing.width, drawing.height);
  const Vec3d ink = shown(drawing.ink);
  canvas.paint(drawing.lines, ink);
  for (const Box& box : drawing.boxes) canvas.paint(box, shown(box.color));
  for (const Bar& bar : drawing.bars) {
    std::vector<Vec3d> colors;
    for (const Vec3d& color : bar.colors) colors.push_back(shown(color));
    canvas.paint(bar, colors);
  }
  std::vector<float> coverage(drawing.texts.empty() ? 0 : canvas.pixels());
  for (const image::TextLine& line : drawing.texts)
    image::draw_text(line, drawing.font, drawing.width, drawing.height, coverage);
  canvas.paint(coverage, ink);
  for (const image::TextLine& line : drawing.labels) {
    coverage.assign(canvas.pixels(), 0);
    image::draw_text(line, drawing.font, drawing.width, drawing.height, coverage);
    const int reach = std::max(1, static_cast<int>(std::lround(kContour * line.size_px)));
    canvas.paint(dilated(coverage, drawing.width, drawing.height, reach), shown(opposite(drawing.ink)));
    canvas.paint(coverage, ink);
  }
  return canvas.take();
}

std::string stamped(const std::string& stamp, const Drawing& drawing) {
  if (drawing.is_empty()) return stamp;
  std::ifstream font(drawing.font, std::ios::binary);
  const std::string glyphs(std::istreambuf_iterator<char>(font), {});
  return base::text_hash(fmt::format("{}\n{}\n{} {} {}\n{}\n{}", stamp, drawing.font.string(), drawing.outline_px,
                                     drawing.outline_depth, drawing.outline_objects, svg(drawing, std::identity()),
                                     glyphs));
}

void blend(const Overlay& overlay, film::EncodedPicture& picture) {
  const auto channels = static_cast<std::size_t>(picture.channels);
  const double largest = picture.bits == 8 ? 255 : 65535;
  for (std::size_t i = 0; i < overlay.rgba.size() / 4; ++i)
    blend_pixel(&overlay.rgba[4 * i], largest, channels == 4, &picture.values[channels * i]);
}

void blend(const Overlay& overlay, int x, int y, std::span<std::uint8_t> rgb) {
  const std::size_t first = math::pixel_index(x, y, overlay.width);
  for (std::size_t i = 0; i < rgb.size() / 3; ++i) blend_pixel(&overlay.rgba[4 * (first + i)], 255, false, &rgb[3 * i]);
}

void add_layer(const Overlay& overlay, film::Picture& picture) {
  constexpr const char* kNames[] = {"annotation.R", "annotation.G", "annotation.B", "annotation.A"};
  for (std::size_t c = 0; c < 4; ++c) {
    film::Plane plane{kNames[c], std::vector<float>(overlay.rgba.size() / 4), film::PlaneKind::kLight};
    for (std::size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = overlay.rgba[4 * i + c];
    picture.planes.push_back(std::move(plane));
  }
}

std::string svg(const Drawing& drawing, const std::function<Vec3d(const Vec3d&)>& shown, std::string_view png) {
  const std::string ink = hex(shown(drawing.ink)), contour = hex(shown(opposite(drawing.ink)));
  std::string body;
  if (!png.empty())
    body += fmt::format("<image width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n", drawing.width,
                        drawing.height, base::base64(png));
  for (const Box& box : drawing.boxes)
    body += fmt::format("<rect x=\"{:.3f}\" y=\"{:.3f}\" width=\"{:.3f}\" height=\"{:.3f}\" fill=\"{}\"/>\n", box.left,
                        box.top, box.right - box.left, box.bottom - box.top, hex(shown(box.color)));
  for (std::size_t i = 0; i < drawing.bars.size(); ++i) body += svg_bar(drawing.bars[i], i, shown);
  for (const image::TextLine& line : drawing.texts) body += svg_text(line, ink, "");
  for (const image::TextLine& line : drawing.labels) body += svg_text(line, ink, contour);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"{2}\">\n{3}</svg>\n",
      drawing.width, drawing.height, svg_font(drawing.font), body);
}

}  // namespace orrery::annotation
