// SPDX-License-Identifier: Apache-2.0
#include "image/format.h"

#include "base/image_limits.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

TEST(ImageFormat, FollowsTheExtension) {
  EXPECT_EQ(format_of("a/b.c/d.exr"), Format::kExr);
  EXPECT_EQ(format_of("d.HDR"), Format::kHdr);
  EXPECT_EQ(format_of("d.0001.Png"), Format::kPng);
  EXPECT_EQ(format_of("d.tif"), Format::kTiff);
  EXPECT_EQ(format_of("d.tiff"), Format::kTiff);
  EXPECT_EQ(format_of("d.jpg"), Format::kJpeg);
  EXPECT_EQ(format_of("d.jpeg"), Format::kJpeg);
  EXPECT_EQ(format_of("d.ppm"), Format::kPpm);
  EXPECT_EQ(format_of("d.svg"), Format::kSvg);
}

TEST(ImageFormat, ListsTheKnownExtensionsForAnUnknownOne) {
  for (const char* file : {"d.bmp", "d", "d.", ".exr", "exr", "a.exr/d"})
    expect_error(base::ErrorKind::kUsage, {"exr, hdr, png, tif, tiff, jpg, jpeg, ppm, svg"}, [&] { format_of(file); });
  expect_error(base::ErrorKind::kUsage, {"did you mean `png`?"}, [] { format_of("d.pgn"); });
}

TEST(ImageFormat, OnlyExrAndHdrAreSceneLinear) {
  EXPECT_FALSE(is_display_format(Format::kExr));
  EXPECT_FALSE(is_display_format(Format::kHdr));
  for (const Format format : {Format::kPng, Format::kTiff, Format::kJpeg, Format::kPpm, Format::kSvg})
    EXPECT_TRUE(is_display_format(format));
}

TEST(ImageFormat, OnlyPngAndTiffHoldSixteenBits) {
  EXPECT_EQ(max_bits(Format::kPng), 16);
  EXPECT_EQ(max_bits(Format::kTiff), 16);
  EXPECT_EQ(max_bits(Format::kJpeg), 8);
  EXPECT_EQ(max_bits(Format::kPpm), 8);
  EXPECT_EQ(max_bits(Format::kSvg), 8);
}

TEST(ImageFormat, ASideIsLimitedByTheEncoder) {
  constexpr int kLargest = base::kLargestSide;
  for (const char* file : {"a.exr", "a.tif", "a.tiff"}) EXPECT_NO_THROW(check_size(file, kLargest, kLargest)) << file;
  for (const char* file : {"a.hdr", "a.png", "a.ppm"}) {
    EXPECT_NO_THROW(check_size(file, kLargest - 1, kLargest - 1)) << file;
    expect_error(base::ErrorKind::kUsage, {file, "65535"}, [=] { check_size(file, 1, kLargest); });
  }
  EXPECT_NO_THROW(check_size("a.jpg", 65500, 65500));
  expect_error(base::ErrorKind::kUsage, {"a.jpg", "65501 x 1", "65500"}, [] { check_size("a.jpg", 65501, 1); });
  expect_error(base::ErrorKind::kUsage, {"1 x 65501"}, [] { check_size("a.jpeg", 1, 65501); });
}

}  // namespace
}  // namespace orrery::image
