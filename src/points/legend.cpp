// SPDX-License-Identifier: Apache-2.0
#include "points/legend.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <utility>

#include <fmt/core.h>

#include "base/file_name.h"
#include "base/text.h"

namespace orrery::points {

namespace {

/// Ticks are at least this share of the range apart.
constexpr double kMinShare = 0.1;
/// Numbers from this size on, and ranges below the second, have an exponent.
constexpr double kLargestFixed = 1e6, kSmallestFixed = 1e-3;
/// Smaller ranges have one tick, because the spacing of doubles would be visible.
constexpr double kMinRange = 1e-290, kMinRelativeRange = 1e-12;

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

std::string fixed_text(double value, int decimals) {
  char text[400];
  const auto [end, status] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, std::max(decimals, 0));
  return status == std::errc() ? std::string(text, end) : "?";
}

std::string shortest_text(double value) {
  char text[64];
  const auto [end, status] = std::to_chars(text, text + sizeof text, value);
  std::string out(text, status == std::errc() ? end : text);
  std::erase(out, '+');  // of "1e+300"
  return out;
}

// Lengths in px.
constexpr double kSvgMargin = 12, kSvgFont = 14, kSvgTitleHeight = 28, kSvgBarWidth = 24, kSvgBarHeight = 240,
                 kSvgTickLength = 6, kSvgGap = 6, kSvgPatch = 16, kSvgPatchPitch = 24;
/// Width of a character of a sans-serif font, in font sizes; the true width is unknown.
constexpr double kCharacterWidth = 0.62;
constexpr std::size_t kSvgMaxTextBytes = 120;

/// A string as XML, and its estimated width.
struct Label {
  std::string xml;
  double width = 0;
};

Label label_of(const std::string& text) {
  Label out;
  const std::string_view prefix = base::utf8_prefix(text, kSvgMaxTextBytes);
  const auto add = [&](std::string_view xml) {
    out.xml += xml;
    out.width += kCharacterWidth * kSvgFont;
  };
  for (std::size_t i = 0; i < prefix.size();) {
    const std::size_t length = base::printable_length(prefix, i);
    const std::string_view character = prefix.substr(i, std::max<std::size_t>(length, 1));
    if (length == 0) {
      add("?");
    } else if (character == "<") {
      add("&lt;");
    } else if (character == ">") {
      add("&gt;");
    } else if (character == "&") {
      add("&amp;");
    } else {
      add(character);
    }
    i += character.size();
  }
  if (prefix.size() < text.size()) add("…");
  return out;
}

/// Formats a length with two decimals, independent of the locale.
std::string px(double length) {
  char text[64];
  const auto [end, status] = std::to_chars(text, text + sizeof text, length, std::chars_format::fixed, 2);
  return {text, status == std::errc() ? end : text};
}

std::string hex(const Srgb8& color) {
  std::string out;
  base::append(out, "#%02x%02x%02x", static_cast<unsigned>(color[0]), static_cast<unsigned>(color[1]),
               static_cast<unsigned>(color[2]));
  return out;
}

/// The body of the image, drawn from the top.
class Drawing {
 public:
  void add_title(const std::string& title) {
    if (title.empty()) return;
    add_text(kSvgMargin, y_ + kSvgFont, title, " font-weight=\"bold\"");
    y_ += kSvgTitleHeight;
  }

  void add_bar(const Legend& legend) {
    body_ += "<defs><linearGradient id=\"bar\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">\n";
    const double count = static_cast<double>(legend.bar.size());
    for (std::size_t i = 0; i < legend.bar.size(); ++i) {
      const double offset = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
      body_ += fmt::format("<stop offset=\"{}%\" stop-color=\"{}\"/>\n", px(100 * offset), hex(legend.bar[i]));
    }
    body_ += "</linearGradient></defs>\n";
    y_ += kSvgFont / 2;  // half of the label of a tick at the end
    add_rectangle(kSvgMargin, y_, kSvgBarWidth, kSvgBarHeight, "url(#bar)");
    for (const Tick& tick : ticks_of(legend)) {
      const double y = y_ + kSvgBarHeight * (1 - share_of(tick.value, legend)), x = kSvgMargin + kSvgBarWidth;
      body_ += fmt::format("<path d=\"M{} {}h{}\" stroke=\"#000000\"/>\n", px(x), px(y), px(kSvgTickLength));
      add_text(x + kSvgTickLength + kSvgGap, y + 0.35 * kSvgFont, tick.label);
    }
    y_ += kSvgBarHeight + kSvgFont / 2 + kSvgMargin;
  }

  void add_patch(const Legend::Patch& patch) {
    add_rectangle(kSvgMargin, y_, kSvgPatch, kSvgPatch, hex(patch.color));
    add_text(kSvgMargin + kSvgPatch + kSvgGap, y_ + kSvgPatch / 2 + 0.35 * kSvgFont, patch.label);
    y_ += kSvgPatchPitch;
  }

  std::string svg() const {
    const std::string width = px(std::ceil(width_ + kSvgMargin)), height = px(std::ceil(y_));
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" "
        "font-family=\"sans-serif\" font-size=\"{}\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        "{}</svg>\n",
        width, height, width, height, px(kSvgFont), body_);
  }

 private:
  void add_text(double x, double y, const std::string& text, const std::string& style = {}) {
    const Label label = label_of(text);
    body_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", px(x), px(y), style, label.xml);
    width_ = std::max(width_, x + label.width);
  }

  void add_rectangle(double x, double y, double width, double height, const std::string& fill) {
    body_ += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" stroke=\"#000000\" stroke-width=\"0.5\"/>\n",
        px(x), px(y), px(width), px(height), fill);
    width_ = std::max(width_, x + width);
  }

  std::string body_;
  double y_ = kSvgMargin, width_ = 0;
};

}  // namespace

std::vector<Tick> nice_ticks(double first, double last) {
  const double low = std::min(first, last), high = std::max(first, last);
  const double size = std::max(std::abs(low), std::abs(high)), range = high - low;
  if (!std::isfinite(range)) return {{low, shortest_text(low)}, {high, shortest_text(high)}};
  const bool is_fixed = size == 0 || (size >= kSmallestFixed && size < kLargestFixed);
  if (!(range > std::max(kMinRange, kMinRelativeRange * size))) return {{low, shortest_text(low)}};
  int exponent = exponent_of(range * kMinShare);
  double digit = 1;
  for (const double larger : {2.0, 5.0, 10.0}) {
    if (digit * std::pow(10, exponent) >= range * kMinShare * (1 - 1e-9)) break;
    digit = larger;
  }
  if (digit == 10) {
    digit = 1;
    ++exponent;
  }
  const int largest = exponent_of(size);
  std::vector<Tick> out;
  // Multiples are divided where possible: 3 / 10 is the double closest to 0.3, 3 * 0.1 is not.
  const double power = std::pow(10, std::abs(exponent));
  const auto multiple = [&](double n) { return exponent < 0 ? n * digit / power : n * digit * power; };
  const double step = multiple(1);
  for (double n = std::ceil(low / step - 1e-9); n <= std::floor(high / step + 1e-9); ++n) {
    const double value = n == 0 ? 0 : multiple(n);  // not -0
    Tick tick{value, is_fixed ? fixed_text(value, -exponent) : "0"};
    if (!is_fixed && value != 0) {
      // All use the exponent of the largest.
      const double mantissa = value / std::pow(10, largest);
      tick.label = fixed_text(mantissa, largest - exponent) + 'e' + std::to_string(largest);
    }
    out.push_back(std::move(tick));
  }
  return out;
}

std::vector<Tick> ticks_of(const Legend& legend) {
  const double low = std::min(legend.first, legend.last), high = std::max(legend.first, legend.last);
  constexpr double kTiny = 1e-9;  // relative; ends may be rounded
  const double decades = legend.is_log ? std::log10(high / low) : 0;
  if (!(decades >= 1 - kTiny) || !std::isfinite(decades)) return nice_ticks(legend.first, legend.last);
  constexpr double kMaxTicks = 8;
  const int step = static_cast<int>(std::ceil(decades / kMaxTicks));
  std::vector<Tick> out;
  for (int exponent = exponent_of(low); exponent <= exponent_of(high * (1 + kTiny)); ++exponent) {
    if (exponent % step != 0) continue;
    for (const int digit : {1, 2, 5}) {
      if (digit > 1 && decades >= 3) continue;
      const std::string text = fmt::format("{}e{}", digit, exponent);
      double value = 0;
      std::from_chars(text.data(), text.data() + text.size(), value);  // the closest double
      if (value >= low * (1 - kTiny) && value <= high * (1 + kTiny)) out.push_back({value, shortest_text(value)});
    }
  }
  return out;
}

std::string legend_svg(const Legend& legend) {
  Drawing drawing;
  drawing.add_title(legend.title);
  if (!legend.bar.empty()) drawing.add_bar(legend);
  for (const Legend::Patch& patch : legend.patches) drawing.add_patch(patch);
  if (legend.nan_color) drawing.add_patch({"no value", *legend.nan_color});
  return drawing.svg();
}

double share_of(double value, const Legend& legend) {
  if (legend.is_log && legend.first != legend.last)
    return std::clamp(std::log(value / legend.first) / std::log(legend.last / legend.first), 0.0, 1.0);
  // Halves: the difference of the ends may not be finite.
  const double range = legend.last / 2 - legend.first / 2;
  return range != 0 ? std::clamp((value / 2 - legend.first / 2) / range, 0.0, 1.0) : 0.5;
}

std::vector<Srgb8> bar_pixels(const std::vector<Srgb8>& bar, int width_px, int height_px) {
  const auto width = static_cast<std::size_t>(width_px), height = static_cast<std::size_t>(height_px);
  std::vector<Srgb8> out(width * height);
  for (std::size_t row = 0; row < height; ++row) {
    // The centres of the first and the last row have the colours of the ends.
    const double share = height > 1 ? static_cast<double>(height - 1 - row) / static_cast<double>(height - 1) : 0.5;
    const double at = share * static_cast<double>(bar.size() - 1);
    const auto i = static_cast<std::size_t>(at);
    const Srgb8 &below = bar[i], &above = bar[std::min(i + 1, bar.size() - 1)];
    Srgb8 color{};
    for (std::size_t c = 0; c < 3; ++c)
      color[c] =
          static_cast<std::uint8_t>(std::lround(below[c] + (at - static_cast<double>(i)) * (above[c] - below[c])));
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(row * width), width, color);
  }
  return out;
}

}  // namespace orrery::points
