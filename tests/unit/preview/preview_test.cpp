// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "display/develop.h"
#include "film/picture.h"
#include "film/sums.h"
#include "image/read.h"
#include "support/picture_of.h"
#include "support/temp_dir.h"
#include "unit/preview/pictures.h"

namespace orrery::preview {

namespace {

/// Runs a render of 100 s in steps of 50 ms; returns the number of updates and their total cost.
std::pair<int, double> simulated(int threads, double cost_s) {
  int updates = 0;
  double last = 0, last_cost = 0;
  for (int step = 1; step <= 2000; ++step) {
    const double now = 0.05 * step;
    if (!is_due(now - last, threads * (now - last), last_cost)) continue;
    last = now;
    last_cost = cost_s;
    ++updates;
  }
  return {updates, updates * cost_s};
}

TEST(PreviewIsDue, OncePerInterval) { EXPECT_NEAR(simulated(2, 1e-4).first, 100 / kInterval_s, 5); }

TEST(PreviewIsDue, LessOftenIfUpdatesAreExpensive) {
  for (const int threads : {1, 2, 64})
    for (const double cost : {0.01, 0.1, 0.4}) {
      const double limit = kShareOfTime * threads * 100;
      EXPECT_LE(simulated(threads, cost).second, limit + cost) << threads << " " << cost;
      EXPECT_GE(simulated(threads, cost).first, 1);
    }
  EXPECT_NEAR(simulated(1, 0.1).second, kShareOfTime * 100, 0.101);
}

}  // namespace

namespace {

TEST(PreviewFile, IsAPng) {
  EXPECT_EQ(preview_file("out/p.PNG"), "out/p.PNG");
  EXPECT_EQ(preview_file("tev.png"), "tev.png");
  EXPECT_EQ(preview_file(""), "");
}

TEST(PreviewFile, RejectsEverythingElse) {
  for (const auto& [text, part] :
       std::vector<std::pair<std::string, std::string>>{{"terminal", "not a .png file"},
                                                        {"p.exr", "not a .png file"},
                                                        {"p.##.png", "frame pattern"},
                                                        {"tev", "use orrery view"},
                                                        {"tev:desk:9000", "use orrery view"}}) {
    try {
      preview_file(text);
      ADD_FAILURE() << text;
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kUsage) << text;
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

}  // namespace

namespace {

display::Settings settings() {
  display::Settings out;
  out.display = "sRGB";
  out.view = "Un-tone-mapped";
  out.exposure = -2;
  return out;
}

/// What the display transform makes of a whole image.
std::vector<std::uint8_t> developed(const film::Sums& state) {
  const std::vector<std::uint16_t> codes = display::develop(test::picture_of(state), settings(), 8).values;
  return {codes.begin(), codes.end()};
}

/// The codes of an image file, R, G, B of all pixels.
std::vector<std::uint8_t> codes_of(const std::filesystem::path& file) {
  const film::Picture picture = image::read(file);
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < picture.at("R").values.size(); ++i)
    for (const char* channel : {"R", "G", "B"})
      out.push_back(static_cast<std::uint8_t>(std::lround(picture.at(channel).values[i] * 255)));
  return out;
}

display::PictureInfo info(int width, int height) { return {width, height, settings()}; }

OnNote into(std::string& notes) {
  return [&notes](const std::string& text) { notes += text; };
}

TEST(PreviewPreview, TheFileHoldsTheDevelopedImageInTheEnd) {
  const support::TempDir folder;
  std::string notes;
  Preview preview(folder / "p.png", into(notes));
  for (const double offset : {0.0, 1.5}) {
    const film::Sums state = sums(70, 40, offset);
    preview.begin(info(70, 40));
    write_all(state, preview);
    preview.end();
    EXPECT_TRUE(codes_of(folder / "p.png") == developed(state));
  }
  EXPECT_EQ(folder.count(), 1u) << "a temporary file is left";
  EXPECT_EQ(notes, "");
}

TEST(PreviewPreview, AFileThatCannotBeWrittenIsOneWarning) {
  const support::TempDir folder;
  std::string notes;
  {
    Preview preview(folder / "gone/p.png", into(notes));
    for (int i = 0; i < 3; ++i) {
      preview.begin(info(10, 10));
      write_all(sums(10, 10), preview);
    }
  }
  EXPECT_EQ(notes.find("warning: the preview ended: cannot create "), 0u) << notes;
  EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 1);
}

TEST(PreviewPreview, EndsWithoutAnImage) {
  const support::TempDir folder;
  std::string notes;
  {
    Preview preview(folder / "p.png", into(notes));
    preview.end();
    preview.begin(info(10, 10));  // nothing is rendered
  }
  EXPECT_EQ(folder.count(), 0u);
}

}  // namespace

}  // namespace orrery::preview
