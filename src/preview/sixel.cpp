// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <vector>

#include <fmt/core.h>

#include "preview/graphics.h"
#include "preview/png.h"

namespace orrery::preview {
namespace {

constexpr int kLevels = 6;  ///< levels per channel: a cube of 216 colours, which every sixel terminal supports
constexpr int kColors = kLevels * kLevels * kLevels;
constexpr int kBand = 6;  ///< px, height of a row of sixels

/// Thresholds of ordered dither, 0 .. 15.
constexpr int kBayer[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

/// The level of a code, rounded up or down by the pixel's threshold.
int level(int code, int x, int y) {
  const int scaled = code * (kLevels - 1) * 16;  // 0 .. 255 * 16 per level
  const int whole = scaled / (255 * 16), rest = scaled % (255 * 16);
  return std::min(whole + (rest > kBayer[y & 3][x & 3] * 255 + 127 ? 1 : 0), kLevels - 1);
}

/// Adds a run of equal sixels.
void add_run(std::string& out, int length, int bits) {
  const char letter = static_cast<char>('?' + bits);
  if (length > 3) {
    out += fmt::format("!{}{}", length, letter);
  } else {
    out.append(static_cast<std::size_t>(length), letter);
  }
}

}  // namespace

std::string sixel(const Bitmap& bitmap) {
  // Square pixels; the size in pixels.
  std::string out = fmt::format("\033P0;1q\"1;1;{};{}", bitmap.width, bitmap.height);
  for (int i = 0; i < kColors; ++i) {
    const auto percent = [](int v) { return v * 100 / (kLevels - 1); };
    out += fmt::format("#{};2;{};{};{}", i, percent(i / 36), percent(i / 6 % 6), percent(i % 6));
  }
  const auto width = static_cast<std::size_t>(bitmap.width);
  std::vector<std::uint8_t> sixels(kColors * width);  // of one row, colour by colour
  for (int top = 0; top < bitmap.height; top += kBand) {
    const int rows = std::min(kBand, bitmap.height - top);
    std::array<bool, kColors> used{};
    for (int y = 0; y < rows; ++y) {
      const std::uint8_t* code = bitmap.row(top + y);
      for (int x = 0; x < bitmap.width; ++x, code += 3) {
        const int color = 36 * level(code[0], x, top + y) + 6 * level(code[1], x, top + y) + level(code[2], x, top + y);
        const auto c = static_cast<std::size_t>(color);
        if (!used[c]) std::fill_n(&sixels[c * width], width, std::uint8_t{0});
        used[c] = true;
        std::uint8_t& bits = sixels[c * width + static_cast<std::size_t>(x)];
        bits = static_cast<std::uint8_t>(bits | 1 << y);
      }
    }
    for (int color = 0; color < kColors; ++color) {
      if (!used[static_cast<std::size_t>(color)]) continue;
      out += fmt::format("#{}", color);
      int length = 0, last = -1;
      for (std::size_t x = 0; x < width; ++x) {
        const int bits = sixels[static_cast<std::size_t>(color) * width + x];
        if (bits != last && length > 0) {
          add_run(out, length, last);
          length = 0;
        }
        last = bits;
        ++length;
      }
      if (last > 0) add_run(out, length, last);
      out += '$';  // back to the left edge, for the next colour
    }
    if (top + kBand < bitmap.height) out += '-';  // the next row of sixels
  }
  return out + "\033\\";
}

}  // namespace orrery::preview
