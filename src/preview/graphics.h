// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::preview {

struct Bitmap;

/// Ways to draw an image in a terminal, from best to worst.
enum class Graphics {
  kKitty,      ///< kitty's protocol, true colour
  kIterm,      ///< iTerm2's inline images, true colour
  kSixel,      ///< DEC sixels, 216 colours with dither
  kTrueColor,  ///< half blocks in 24-bit colours
  k256Colors,  ///< half blocks in the 256-colour palette
};

/// True if each character cell shows two pixels, one above the other. Otherwise, images have any resolution.
inline bool is_text(Graphics graphics) { return graphics == Graphics::kTrueColor || graphics == Graphics::k256Colors; }

/// Returns the bytes that draw a bitmap at the cursor's cell. They leave the cursor in that cell's row or the one below
/// the image; the caller saves and restores it.
///
/// `columns`, `rows`  character cells that the image covers; as text, one column per pixel and one row per two
/// Reference  kitty graphics; iTerm2 images; DEC STD 070; ECMA-48
std::string drawn(Graphics graphics, const Bitmap& bitmap, int columns, int rows);

// The individual formats.
std::string kitty(const Bitmap& bitmap, int columns);
std::string iterm(const Bitmap& bitmap, int columns, int rows);
std::string sixel(const Bitmap& bitmap);
std::string half_blocks(const Bitmap& bitmap, bool true_color);

/// Returns the escape sequence that deletes drawn images, for terminals that store them separately from their text;
/// empty for others.
std::string removed(Graphics graphics);

}  // namespace orrery::preview
