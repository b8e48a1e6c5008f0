// SPDX-License-Identifier: Apache-2.0
#include "image/draw_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/module.h"

namespace orrery::image {
namespace {

constexpr int kTextWidth = 200, kTextHeight = 40;

/// The columns that a text covers: the first and the last.
std::pair<int, int> columns_of(const TextLine& line) {
  std::vector<float> coverage(std::size_t{kTextWidth} * kTextHeight);
  draw_text(line, font_file("DejaVuSans"), kTextWidth, kTextHeight, coverage);
  int first = kTextWidth, last = -1;
  for (int x = 0; x < kTextWidth; ++x)
    for (int y = 0; y < kTextHeight; ++y)
      if (coverage[static_cast<std::size_t>(y * kTextWidth + x)] > 0) {
        first = std::min(first, x);
        last = std::max(last, x);
      }
  return {first, last};
}

TEST(ImageDrawText, AnchorsAreAtTheStartTheMiddleAndTheEnd) {
  const double width = text_widths({"HHHH"}, 20, font_file("DejaVuSans"))[0];
  EXPECT_GT(width, 40);
  const auto [start, start_last] = columns_of({"HHHH", 100, 30, 20, 0});
  EXPECT_NEAR(start, 100, 3);
  EXPECT_NEAR(start_last, 100 + width, 4);
  EXPECT_NEAR(columns_of({"HHHH", 100, 30, 20, 0.5}).first, start - width / 2, 1.01);
  EXPECT_NEAR(columns_of({"HHHH", 100, 30, 20, 1}).first, start - width, 1.01);
}

TEST(ImageDrawText, CharactersOfOtherScriptsAreDistinct) {
  const auto pixels = [](const char* text) {
    std::vector<float> out(std::size_t{kTextWidth} * kTextHeight);
    draw_text({text, 10, 30, 20, 0}, font_file("DejaVuSans"), kTextWidth, kTextHeight, out);
    return out;
  };
  EXPECT_NE(pixels("ψ"), pixels("φ"));
  EXPECT_NE(pixels("≥"), pixels("e")) << "not by the low byte";
  EXPECT_EQ(pixels("\xff"), pixels("?")) << "not UTF-8";
}

TEST(ImageDrawText, TextBeyondTheImageIsCut) {
  EXPECT_EQ(columns_of({"HHHH", -5, 30, 20, 0}).first, 0);
  EXPECT_EQ(columns_of({"HHHH", kTextWidth - 10, 30, 20, 0}).second, kTextWidth - 1);
  EXPECT_EQ(columns_of({"HHHH", 0, 500, 20, 0}).second, -1);
  EXPECT_EQ(columns_of({"", 0, 20, 20, 0}).second, -1);
}

TEST(ImageDrawText, AFontInstalledWithTheProgramPrecedesThoseOfTheSystem) {
  const std::filesystem::path prefix = std::filesystem::path(::testing::TempDir()) / "orrery-draw-text-test";
  std::filesystem::create_directories(prefix / "share/orrery/fonts");
  std::filesystem::copy_file(font_file("DejaVuSans"), prefix / "share/orrery/fonts/DejaVuSans.ttf",
                             std::filesystem::copy_options::overwrite_existing);
  base::set_module_folder(prefix / "libexec/orrery");
  std::filesystem::create_directories(prefix / "libexec/orrery");
  const std::filesystem::path found = font_file("DejaVuSans");
  base::set_module_folder({});
  EXPECT_EQ(std::filesystem::weakly_canonical(found),
            std::filesystem::weakly_canonical(prefix / "share/orrery/fonts/DejaVuSans.ttf"));
  std::filesystem::remove_all(prefix);
}

TEST(ImageDrawText, FilesThatAreNoFontsAreRefused) {
  const auto error = [](auto use) {
    try {
      use();
    } catch (const base::Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  const std::string remedy =
      "; set --font (annotation.font) to a .ttf or .otf file, or to the name of a font in /usr/share/fonts, e.g. "
      "DejaVuSans";
  EXPECT_EQ(error([] { font_file("NoSuchFont"); }), "there is no font NoSuchFont" + remedy);
  EXPECT_EQ(error([] { font_file("DejaVuNone"); }),
            "there is no font DejaVuNone; install the package fonts-dejavu-core" + remedy);
  EXPECT_EQ(error([] { font_file("no/such.ttf"); }), "there is no font file no/such.ttf" + remedy);
  EXPECT_EQ(error([] { text_widths({"a"}, 10, "/dev/null"); }), "/dev/null is not a font" + remedy);
}

}  // namespace
}  // namespace orrery::image
