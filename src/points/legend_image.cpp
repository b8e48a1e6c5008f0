// SPDX-License-Identifier: Apache-2.0
#include "points/legend.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

#include "base/file_name.h"

namespace orrery::points {
namespace {

// Lengths in px.
constexpr int kMargin = 16, kBarWidth = 48, kBarHeight = 512, kTick = 8, kGap = 8, kPatch = 24, kPatchPitch = 34;
/// Size of a pixel of the font, px.
constexpr int kScale = 2;
constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kPitch = (kGlyphWidth + 1) * kScale;
constexpr int kTextHeight = kGlyphHeight * kScale;
constexpr std::size_t kMaxTextBytes = 60;

constexpr Srgb8 kWhite = {255, 255, 255}, kBlack = {0, 0, 0};

/// Printable ASCII characters, starting with the space: 7 rows of 5 pixels, from the top left, which is bit 34.
constexpr char kFirstGlyph = ' ';
// clang-format off
constexpr std::uint64_t kFont[] = {
    0x000000000, 0x108421004, 0x294000000, 0x295F57D4A, 0x11F4717C4, 0x672222273, 0x32544564D, 0x108000000,
    0x088842082, 0x208210888, 0x009575480, 0x0084F9080, 0x000001888, 0x0000F8000, 0x0000000C6, 0x042222210,
    0x3A33AE62E, 0x11842108E, 0x3A213221F, 0x7C223062E, 0x08CA97C42, 0x7E1E0862E, 0x3A10F462E, 0x7C2221084,
    0x3A317462E, 0x3A317842E, 0x00C6018C0, 0x00C601888, 0x088882082, 0x001F07C00, 0x208208888, 0x3A2131004,
    0x3A37ADA0E, 0x3A31FC631, 0x7A31F463E, 0x3A308422E, 0x7A318C63E, 0x7E10F421F, 0x7E10F4210, 0x3A30BC62E,
    0x4631FC631, 0x38842108E, 0x1C4210A4C, 0x4654C5251, 0x42108421F, 0x4775AC631, 0x4739ACE71, 0x3A318C62E,
    0x7A31F4210, 0x3A318D64D, 0x7A31F5251, 0x3E107043E, 0x7C8421084, 0x46318C62E, 0x46318C544, 0x4631AD771,
    0x462A22A31, 0x462A21084, 0x7C222221F, 0x39084210E, 0x420820821, 0x38421084E, 0x115100000, 0x00000001F,
    0x208000000, 0x000E0BE2F, 0x421E8C63E, 0x000E8422E, 0x042F8C62F, 0x000E8FE0E, 0x191E42108, 0x000F8BC2E,
    0x421E8C631, 0x100C2108E, 0x080610A4C, 0x4212A6292, 0x30842108E, 0x001AAD6B5, 0x001E8C631, 0x000E8C62E,
    0x001E8FA10, 0x000F8BC21, 0x0016CC210, 0x000F8383E, 0x211E42126, 0x00118C66D, 0x00118C544, 0x0011AD6AA,
    0x001151151, 0x00118BC2E, 0x001F1111F, 0x0C8441083, 0x108421084, 0x608411098, 0x011510000,
};
// clang-format on

/// A string in characters of the font: one for each UTF-8 character.
std::string in_font(const std::string& text) {
  const std::string_view prefix = base::utf8_prefix(text, kMaxTextBytes);
  constexpr char kLastGlyph = static_cast<char>(kFirstGlyph + std::size(kFont) - 1);
  std::string out;
  for (const char c : prefix) {
    const bool continues = (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
    if (!continues) out += c >= kFirstGlyph && c <= kLastGlyph ? c : '?';
  }
  return prefix.size() < text.size() ? out + "..." : out;
}

int width_of(const std::string& text) { return static_cast<int>(text.size()) * kPitch; }

/// A label next to the bar or a patch.
struct Text {
  int x = 0, middle = 0;
  std::string text;
};

class Image {
 public:
  Image(int width, int height) {
    out_.width = width;
    out_.height = height;
    out_.pixels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kWhite);
  }

  Srgb8& at(int x, int y) {
    return out_
        .pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(out_.width) + static_cast<std::size_t>(x)];
  }
  void fill(int x, int y, int width, int height, const Srgb8& color) {
    for (int row = y; row < y + height; ++row)
      for (int column = x; column < x + width; ++column) at(column, row) = color;
  }
  /// Fills the inside; the border is outside.
  void fill_framed(int x, int y, int width, int height, const Srgb8& color) {
    fill(x - 1, y - 1, width + 2, height + 2, kBlack);
    fill(x, y, width, height, color);
  }
  void write(const Text& text) {
    int x = text.x;
    for (const char c : text.text) {
      const std::uint64_t glyph = kFont[static_cast<std::size_t>(c - kFirstGlyph)];
      for (int i = 0; i < kGlyphWidth * kGlyphHeight; ++i)
        if ((glyph >> (kGlyphWidth * kGlyphHeight - 1 - i) & 1u) != 0)
          fill(x + i % kGlyphWidth * kScale, text.middle - kTextHeight / 2 + i / kGlyphWidth * kScale, kScale, kScale,
               kBlack);
      x += kPitch;
    }
  }
  LegendImage take() { return std::move(out_); }

 private:
  LegendImage out_;
};

}  // namespace

LegendImage legend_image(const Legend& legend) {
  std::vector<Legend::Patch> patches = legend.patches;
  if (legend.nan_color) patches.push_back({"no value", *legend.nan_color});
  // Computes the layout first, then the size of the image.
  std::vector<Text> texts;
  int y = kMargin;
  if (!legend.title.empty()) {
    texts.push_back({kMargin, y + kTextHeight / 2, in_font(legend.title)});
    y += kTextHeight + kMargin;
  }
  const int bar_top = y;
  std::vector<int> ticks;
  if (!legend.bar.empty()) {
    for (const Tick& tick : ticks_of(legend)) {
      const double share = share_of(tick.value, legend);
      ticks.push_back(bar_top + static_cast<int>(std::lround((1 - share) * (kBarHeight - 1))));
      texts.push_back({kMargin + kBarWidth + kTick + kGap, ticks.back(), in_font(tick.label)});
    }
    y += kBarHeight + kMargin;
  }
  const int patches_top = y;
  for (std::size_t i = 0; i < patches.size(); ++i, y += kPatchPitch)
    texts.push_back({kMargin + kPatch + kGap, y + kPatch / 2, in_font(patches[i].label)});
  int right = kMargin + (legend.bar.empty() ? kPatch : kBarWidth + kTick);
  for (const Text& text : texts) right = std::max(right, text.x + width_of(text.text));

  Image image(right + kMargin, std::max(y + (patches.empty() ? 0 : kMargin + kPatch - kPatchPitch), 2 * kMargin));
  if (!legend.bar.empty()) {
    image.fill_framed(kMargin, bar_top, kBarWidth, kBarHeight, kWhite);
    const std::vector<Srgb8> colors = bar_pixels(legend.bar, 1, kBarHeight);
    for (int row = 0; row < kBarHeight; ++row)
      image.fill(kMargin, bar_top + row, kBarWidth, 1, colors[static_cast<std::size_t>(row)]);
  }
  for (const int tick : ticks) image.fill(kMargin + kBarWidth + 1, tick, kTick, 1, kBlack);
  for (std::size_t i = 0; i < patches.size(); ++i)
    image.fill_framed(kMargin, patches_top + static_cast<int>(i) * kPatchPitch, kPatch, kPatch, patches[i].color);
  for (const Text& text : texts) image.write(text);
  return image.take();
}

}  // namespace orrery::points
