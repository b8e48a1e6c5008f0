// SPDX-License-Identifier: Apache-2.0
#include "image/format.h"

#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

TEST(ImageFormat, IsWhatTheExtensionSays) {
  EXPECT_EQ(format_of("a/b.c/d.exr"), Format::kExr);
  EXPECT_EQ(format_of("d.HDR"), Format::kHdr);
  EXPECT_EQ(format_of("d.0001.Png"), Format::kPng);
  EXPECT_EQ(format_of("d.tif"), Format::kTiff);
  EXPECT_EQ(format_of("d.tiff"), Format::kTiff);
  EXPECT_EQ(format_of("d.jpg"), Format::kJpeg);
  EXPECT_EQ(format_of("d.jpeg"), Format::kJpeg);
  EXPECT_EQ(format_of("d.ppm"), Format::kPpm);
}

TEST(ImageFormat, NamesTheKnownExtensionsWhereOneIsNot) {
  for (const char* file : {"d.bmp", "d", "d.", ".exr", "exr", "a.exr/d"})
    expect_error(base::ErrorKind::kUsage, {"exr, hdr, png, tif, tiff, jpg, jpeg, ppm"}, [&] { format_of(file); });
  expect_error(base::ErrorKind::kUsage, {"did you mean `png`?"}, [] { format_of("d.pgn"); });
}

TEST(ImageFormat, OnlyLightWithoutADisplayIsSceneLinear) {
  EXPECT_FALSE(is_display_format(Format::kExr));
  EXPECT_FALSE(is_display_format(Format::kHdr));
  for (const Format format : {Format::kPng, Format::kTiff, Format::kJpeg, Format::kPpm})
    EXPECT_TRUE(is_display_format(format));
}

TEST(ImageFormat, SixteenBitsFitIntoPngAndTiff) {
  EXPECT_EQ(most_bits(Format::kPng), 16);
  EXPECT_EQ(most_bits(Format::kTiff), 16);
  EXPECT_EQ(most_bits(Format::kJpeg), 8);
  EXPECT_EQ(most_bits(Format::kPpm), 8);
}

}  // namespace
}  // namespace orrery::image
