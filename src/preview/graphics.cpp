// SPDX-License-Identifier: Apache-2.0
#include "preview/graphics.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <fmt/core.h>

#include "base/base64.h"
#include "preview/png.h"

namespace orrery::preview {
namespace {

/// Number of this process's image in the terminal: a new image with this number replaces it, those of earlier runs
/// stay.
int kitty_image() { return 0x6f000000 + static_cast<int>(getpid() & 0xffffff); }

/// Payload of one escape sequence, base64 characters: kitty's limit.
constexpr std::size_t kKittyChunk = 4096;

constexpr const char* kEscape = "\033";

/// The number of the nearest colour in the 256-colour palette: a cube of six levels per channel, and 24 greys.
int palette_color(const std::uint8_t* rgb) {
  constexpr int kLevels[] = {0, 95, 135, 175, 215, 255};
  const auto squared = [](int v) { return v * v; };
  int number = 16, distance = 0;
  for (int c = 0, weight = 36; c < 3; ++c, weight /= 6) {
    int best = 0;
    for (int i = 1; i < 6; ++i)
      if (std::abs(kLevels[i] - rgb[c]) < std::abs(kLevels[best] - rgb[c])) best = i;
    number += weight * best;
    distance += squared(kLevels[best] - rgb[c]);
  }
  const int grey = std::clamp(((rgb[0] + rgb[1] + rgb[2]) / 3 - 3) / 10, 0, 23);
  const int code = 8 + 10 * grey;
  return squared(code - rgb[0]) + squared(code - rgb[1]) + squared(code - rgb[2]) < distance ? 232 + grey : number;
}

/// The parameters of SGR for a colour; 3: foreground, 4: background.
std::string sgr(int ground, const std::uint8_t* rgb, bool true_color) {
  if (true_color) return fmt::format("{}8;2;{};{};{}", ground, rgb[0], rgb[1], rgb[2]);
  return fmt::format("{}8;5;{}", ground, palette_color(rgb));
}

}  // namespace

std::string kitty(const Bitmap& bitmap, int columns) {
  const std::string payload = base::base64({reinterpret_cast<const char*>(bitmap.codes.data()), bitmap.codes.size()});
  std::string out;
  for (std::size_t at = 0; at < payload.size(); at += kKittyChunk) {
    out += kEscape;
    out += "_G";
    // a=T: transmit and show; f=24: R, G, B; q=2: no answers; C=1: the cursor stays.
    if (at == 0)
      out += fmt::format("a=T,f=24,s={},v={},i={},p=1,c={},q=2,C=1,", bitmap.width, bitmap.height, kitty_image(),
                         columns);  // the number of rows follows from the aspect ratio
    out += at + kKittyChunk < payload.size() ? "m=1;" : "m=0;";
    out += std::string_view(payload).substr(at, kKittyChunk);
    out += "\033\\";
  }
  return out;
}

std::string iterm(const Bitmap& bitmap, int columns, int rows) {
  const std::string png = encode_png(bitmap);
  return fmt::format("\033]1337;File=inline=1;size={};width={};height={};preserveAspectRatio=1:{}\a", png.size(),
                     columns, rows, base::base64(png));
}

std::string half_blocks(const Bitmap& bitmap, bool true_color) {
  constexpr const char* kUpperHalf = "\u2580";
  const std::uint8_t black[3] = {0, 0, 0};
  std::string out;
  for (int y = 0; y < bitmap.height; y += 2) {
    if (y > 0) out += "\r\n";
    std::string upper, lower;
    for (int x = 0; x < bitmap.width; ++x) {
      const std::uint8_t* const above = bitmap.row(y) + 3 * x;
      const std::uint8_t* const below = y + 1 < bitmap.height ? bitmap.row(y + 1) + 3 * x : black;
      const std::string fore = sgr(3, above, true_color), back = sgr(4, below, true_color);
      if (fore != upper && back != lower) {
        out += fmt::format("\033[{};{}m", fore, back);
      } else if (fore != upper) {
        out += fmt::format("\033[{}m", fore);
      } else if (back != lower) {
        out += fmt::format("\033[{}m", back);
      }
      upper = fore;
      lower = back;
      out += kUpperHalf;
    }
    out += "\033[0m";
  }
  return out;
}

std::string drawn(Graphics graphics, const Bitmap& bitmap, int columns, int rows) {
  switch (graphics) {
    case Graphics::kKitty: return kitty(bitmap, columns);
    case Graphics::kIterm: return iterm(bitmap, columns, rows);
    case Graphics::kSixel: return sixel(bitmap);
    case Graphics::kTrueColor: return half_blocks(bitmap, true);
    case Graphics::k256Colors: return half_blocks(bitmap, false);
  }
  return {};
}

std::string removed(Graphics graphics) {
  return graphics == Graphics::kKitty ? fmt::format("\033_Ga=d,d=I,i={},q=2\033\\", kitty_image()) : std::string();
}

}  // namespace orrery::preview
