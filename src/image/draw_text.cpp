// SPDX-License-Identifier: Apache-2.0
// OpenImageIO 2.4 draws text as well, but wrong characters beyond Latin-1.
#include "image/draw_text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <type_traits>

#include <fmt/core.h>

#include "base/error.h"
#include "base/module.h"
#include "base/text.h"
#include "math/pixels.h"

namespace orrery::image {
namespace {

namespace fs = std::filesystem;

/// FreeType's unit of lengths.
constexpr double kUnitsPerPixel = 64;

/// Characters of a text; invalid bytes are question marks.
std::vector<std::string_view> characters_of(std::string_view text) {
  std::vector<std::string_view> out;
  for (std::size_t at = 0; at < text.size(); at += out.back().size()) {
    const std::size_t length = base::printable_length(text, at);
    out.push_back(length == 0 ? "?" : text.substr(at, length));
  }
  return out;
}

/// The code point of a character in UTF-8.
std::uint32_t code_of(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  std::uint32_t code = character.size() == 1 ? first : first & (0x7Fu >> character.size());
  for (const char c : character.substr(1)) code = code << 6 | (static_cast<unsigned char>(c) & 0x3Fu);
  return code;
}

constexpr char kSystemFonts[] = "/usr/share/fonts";

/// Reports that a font cannot be used.
[[noreturn]] void refuse(base::ErrorKind kind, const std::string& what) {
  throw base::Error(kind, fmt::format("{}; set --font (annotation.font) to a .ttf or .otf file, or to the name of a "
                                      "font in {}, e.g. DejaVuSans",
                                      what, kSystemFonts));
}

/// A font at a size.
class Face {
 public:
  Face(const fs::path& font, double size_px) {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    if (FT_Init_FreeType(&library) != 0)
      throw base::Error(base::ErrorKind::kInternal, "FreeType cannot be initialised");
    library_.reset(library);
    if (FT_New_Face(library, font.c_str(), 0, &face) != 0)
      refuse(base::ErrorKind::kBadData, fmt::format("{} is not a font", font.string()));
    face_.reset(face);
    if (FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(size_px * kUnitsPerPixel)), 72, 72) != 0)
      refuse(base::ErrorKind::kBadData, fmt::format("the font {} has no scalable glyphs", font.string()));
  }

  bool has_glyph(std::string_view character) const { return FT_Get_Char_Index(face_.get(), code_of(character)) != 0; }

  std::string family() const { return face_->family_name != nullptr ? face_->family_name : ""; }

  /// Calls `draw(x, glyph)` for each glyph of a text, with the position of its pen.
  ///
  /// Result     the width of the text, px
  template <class F>
  double layout(const std::string& text, FT_Int32 flags, F draw) const {
    double x = 0;
    for (const std::string_view character : characters_of(text)) {
      if (FT_Load_Char(face_.get(), code_of(character), flags) != 0) continue;
      const FT_GlyphSlot glyph = face_->glyph;
      draw(x, *glyph);
      x += static_cast<double>(glyph->advance.x) / kUnitsPerPixel;
    }
    return x;
  }

 private:
  std::unique_ptr<std::remove_pointer_t<FT_Library>, FT_Error (*)(FT_Library)> library_{nullptr, &FT_Done_FreeType};
  std::unique_ptr<std::remove_pointer_t<FT_Face>, FT_Error (*)(FT_Face)> face_{nullptr, &FT_Done_Face};
};

double width_of(const Face& face, const std::string& text) {
  return face.layout(text, FT_LOAD_DEFAULT, [](double, const FT_GlyphSlotRec&) {});
}

}  // namespace

fs::path font_file(const std::string& font) {
  std::error_code error;
  if (font.find_first_of("./\\") != std::string::npos) {
    if (fs::is_regular_file(font, error)) return font;
    refuse(base::ErrorKind::kMissingInput, fmt::format("there is no font file {}", font));
  }
  // Fonts that came with the program are first, so that text has the same pixels on all systems.
  for (const fs::path& folder :
       {base::shared_folder() / "fonts", fs::path(kSystemFonts), fs::path("/usr/local/share/fonts")})
    for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error), end;
         at != end; at.increment(error))
      if (at->path().stem() == font && base::contains({".ttf", ".otf", ".ttc"}, at->path().extension().string()))
        return at->path();
  refuse(base::ErrorKind::kMissingInput,
         fmt::format("there is no font {}{}", font,
                     font.starts_with("DejaVu") ? "; install the package fonts-dejavu-core" : ""));
}

void draw_text(const TextLine& line, const fs::path& font, int width, int height, std::vector<float>& coverage) {
  const Face face(font, line.size_px);
  const double left = line.x - line.anchor * width_of(face, line.text);
  face.layout(line.text, FT_LOAD_RENDER, [&](double pen, const FT_GlyphSlotRec& glyph) {
    const int x = static_cast<int>(std::lround(left + pen)) + glyph.bitmap_left,
              y = static_cast<int>(std::lround(line.y)) - glyph.bitmap_top;
    const int rows = static_cast<int>(glyph.bitmap.rows), columns = static_cast<int>(glyph.bitmap.width);
    for (int row = std::max(0, -y); row < std::min(rows, height - y); ++row)
      for (int column = std::max(0, -x); column < std::min(columns, width - x); ++column) {
        const float ink = static_cast<float>(glyph.bitmap.buffer[row * glyph.bitmap.pitch + column]) / 255.0f;
        float& to = coverage[math::pixel_index(x + column, y + row, width)];
        to = std::max(to, ink);
      }
  });
}

std::string font_family(const fs::path& font) { return Face(font, 16).family(); }

std::vector<double> text_widths(const std::vector<std::string>& lines, double size_px, const fs::path& font) {
  const Face face(font, size_px);
  std::vector<double> out;
  for (const std::string& line : lines) out.push_back(width_of(face, line));
  return out;
}

std::string missing_glyphs(const std::string& text, const fs::path& font) {
  const Face face(font, 16);
  std::string out;
  for (const std::string_view character : characters_of(text))
    if (!face.has_glyph(character) && out.find(character) == std::string::npos) out += character;
  return out;
}

}  // namespace orrery::image
