// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orrery::image {

/// A line of text.
struct TextLine {
  std::string text;     ///< UTF-8
  double x = 0, y = 0;  ///< px from the top left, a point of the baseline
  double size_px = 16;  ///< of the font
  double anchor = 0;    ///< where that point is: 0 at the start of the text, 0.5 in the middle, 1 at the end
};

/// Returns the file of a font.
///
/// `font`     a file, or the name of one without its extension in the system's folders of fonts
/// Errors     base::Error(kMissingInput)
std::filesystem::path font_file(const std::string& font);

/// The name of a font's family, as the file gives it: "DejaVu Sans". Not checked: it may contain any characters.
///
/// Errors     base::Error(kBadData) if the file is not a font
std::string font_family(const std::filesystem::path& font);

/// Draws the coverage of a line of text, 0..1, over that of an image.
///
/// Shape      `coverage`: width * height, row by row from the top
/// Errors     base::Error(kBadData) if the file is not a font
void draw_text(const TextLine& line, const std::filesystem::path& font, int width, int height,
               std::vector<float>& coverage);

/// The widths of lines of text.
///
/// Units      px
/// Errors     as draw_text()
std::vector<double> text_widths(const std::vector<std::string>& lines, double size_px,
                                const std::filesystem::path& font);

/// Returns the characters of a text for which the font has no glyphs, each once.
///
/// Errors     as draw_text()
std::string missing_glyphs(const std::string& text, const std::filesystem::path& font);

}  // namespace orrery::image
