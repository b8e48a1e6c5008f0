// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "display/develop.h"
#include "film/picture.h"
#include "film/rendered_pixels.h"
#include "preview/file_sink.h"
#include "support/temp_dir.h"
#include "unit/preview/pictures.h"
#include "unit/preview/png_bytes.h"

namespace orrery::preview {
namespace {

display::Settings settings() {
  display::Settings out;
  out.display = "sRGB";
  out.view = "Un-tone-mapped";
  out.exposure = -2;
  return out;
}

/// What the display transform makes of a whole image.
std::vector<std::uint8_t> developed(const film::Partial& state) {
  const std::vector<std::uint16_t> codes = display::develop(state.film.picture(), settings(), 8).values;
  return {codes.begin(), codes.end()};
}

display::PictureInfo info(int width, int height) { return {"scene.toml", width, height, 1, settings()}; }

OnNote into(std::string& notes) {
  return [&notes](const std::string& text) { notes += text; };
}

TEST(PreviewPreview, TheFileHoldsTheDevelopedImageInTheEnd) {
  const support::TempDir folder;
  std::string notes;
  Preview preview(std::make_unique<FileSink>(folder / "p.png"), into(notes));
  for (const double offset : {0.0, 1.5}) {
    const film::Partial state = partial(70, 40, offset);
    preview.begin(info(70, 40));
    write_all(state, preview);
    preview.end();
    EXPECT_TRUE(decoded_png(support::file_bytes(folder / "p.png")).codes == developed(state));
  }
  EXPECT_EQ(folder.count(), 1u) << "a temporary file is left";
  EXPECT_EQ(notes, "");
}

TEST(PreviewPreview, AFileThatCannotBeWrittenIsOneWarning) {
  const support::TempDir folder;
  std::string notes;
  {
    Preview preview(std::make_unique<FileSink>(folder / "gone/p.png"), into(notes));
    for (int i = 0; i < 3; ++i) {
      preview.begin(info(10, 10));
      write_all(partial(10, 10), preview);
    }
  }
  EXPECT_EQ(notes.find("warning: the preview ended: cannot create "), 0u) << notes;
  EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 1);
}

TEST(PreviewPreview, EndsWithoutAnImage) {
  const support::TempDir folder;
  std::string notes;
  {
    Preview preview(std::make_unique<FileSink>(folder / "p.png"), into(notes));
    preview.end();
    preview.begin(info(10, 10));  // nothing is rendered
  }
  EXPECT_EQ(folder.count(), 0u);
}

}  // namespace
}  // namespace orrery::preview
