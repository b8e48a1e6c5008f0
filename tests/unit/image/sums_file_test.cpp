// SPDX-License-Identifier: Apache-2.0
#include "image/sums_file.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "film/sums.h"
#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "support/picture_of.h"
#include "support/temp_dir.h"

namespace orrery::image {
namespace {

constexpr int kWidth = 23, kHeight = 11;

film::Sums some_partial() {
  film::LayerRequest request;
  request.deep = true;
  film::Sums p(kWidth, kHeight, request);
  std::mt19937_64 random(1);
  for (kernel::PixelSum& s : p.light[0])
    s = {{static_cast<std::int64_t>(random() >> 4), static_cast<std::int64_t>(random() >> 4), 5}, 3};
  for (std::uint32_t& n : p.counts) n = 3;
  for (auto& shares : p.layers.shares) shares.resize(1);
  p.work.seconds = 1.5;
  return p;
}

class ImageSumsFile : public testing::Test {
 protected:
  void SetUp() override { write(file_); }
  void write(const std::filesystem::path& file) const {
    film::Picture preview = test::picture_of(sums_);
    preview.frame_width = 40;
    preview.frame_height = 20;
    preview.x = 3;
    preview.y = 2;
    write_sums(file, preview, {}, {{"samples", "0:3"}, {"host", "b\nc"}}, sums_);
  }
  void expect_refused(const std::string& what) const {
    try {
      read_sums(file_, kWidth, kHeight);
      ADD_FAILURE() << what << " was not noticed";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData) << what << ": " << error.what();
      EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos);
    }
  }

  support::TempDir folder_;
  const std::filesystem::path file_ = folder_ / "a.exr";
  const film::Sums sums_ = some_partial();
};

TEST_F(ImageSumsFile, RoundTrips) {
  const SumsFile read = read_sums(file_, kWidth, kHeight);
  EXPECT_EQ(film::to_words(read.sums), film::to_words(sums_));
  EXPECT_EQ(read.provenance, (Provenance{{"samples", "0:3"}, {"host", "b\nc"}}));
  EXPECT_EQ(read_provenance(file_), read.provenance);
}

TEST_F(ImageSumsFile, AFileThatIsNotWantedIsRefusedBeforeItsSumsAreRead) {
  const auto refuse = [](const Provenance& found) {
    EXPECT_EQ(found.at("samples"), "0:3");
    base::refuse("another scene");
  };
  try {
    read_sums(file_, kWidth + 1, kHeight, refuse);
    ADD_FAILURE();
  } catch (const base::Error& error) {
    EXPECT_STREQ(error.what(), "another scene");
  }
}

/// Whoever reads the sums afterwards checks the digest.
TEST_F(ImageSumsFile, TheProvenanceIsReadWithoutTheDigest) {
  std::string bytes = support::file_bytes(file_);
  bytes.back() = ' ';
  support::write_bytes(file_, bytes);
  EXPECT_EQ(read_provenance(file_).at("samples"), "0:3");
  expect_refused("a wrong digest");
}

TEST_F(ImageSumsFile, ThePreviewIsAnOrdinaryExr) {
  const film::Picture seen = image::read(file_);
  ASSERT_NE(seen.find("R"), nullptr);
  EXPECT_EQ(seen.planes.size(), 4u);
  EXPECT_EQ(seen.width, 40);
  const film::Picture shown = test::picture_of(sums_);
  const float there = shown.find("R")->values[5 * kWidth + 4];
  EXPECT_NEAR(seen.find("R")->values[(5 + 2) * 40 + 4 + 3], there, there / 1024);
}

TEST_F(ImageSumsFile, TheSamePartialGivesTheSameBytes) {
  write(folder_ / "b.exr");
  const std::string bytes = support::file_bytes(file_);
  EXPECT_EQ(bytes, support::file_bytes(folder_ / "b.exr"));
  EXPECT_EQ(bytes.find("capDate"), std::string::npos) << "a part has the time of writing";
}

TEST_F(ImageSumsFile, AFlippedBitIsRefused) {
  const std::string bytes = support::file_bytes(file_);
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t at = i < 70 ? bytes.size() - 1 - i : (i * 2654435761u) % bytes.size();
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << i % 8));
    support::write_bytes(file_, damaged);
    expect_refused("bit " + std::to_string(i % 8) + " of byte " + std::to_string(at));
    try {
      read_provenance(file_);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    }
  }
}

TEST_F(ImageSumsFile, TruncatedAndExtendedFilesAreRefused) {
  const std::string bytes = support::file_bytes(file_);
  for (std::size_t i = 0; i < 50; ++i) {
    support::write_bytes(file_, bytes.substr(0, bytes.size() * i / 50));
    expect_refused("a truncated file");
  }
  support::write_bytes(file_, bytes.substr(0, bytes.size() - 1));
  expect_refused("a missing byte");
  support::write_bytes(file_, bytes + " ");
  expect_refused("an extra byte");
}

TEST_F(ImageSumsFile, OrdinaryAndMissingFilesAreRefused) {
  film::Picture picture = test::picture_of(sums_);
  write_exr(file_, picture, {}, {});
  expect_refused("an ordinary image");
  std::filesystem::remove(file_);
  try {
    read_sums(file_, kWidth, kHeight);
    ADD_FAILURE();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kMissingInput);
  }
}

}  // namespace
}  // namespace orrery::image
