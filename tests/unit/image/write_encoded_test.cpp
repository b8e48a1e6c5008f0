// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "image/checked_file.h"
#include "image/read.h"
#include "image/whole_file.h"
#include "image/write.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

class ImageWriteEncoded : public testing::Test {
 protected:
  /// Maximum difference in levels after writing and reading back.
  double round_trip(const std::string& name, const film::EncodedPicture& picture) const {
    write_encoded(folder_ / name, picture, "orrery");
    const film::Picture back = read(folder_ / name);
    EXPECT_EQ(back.width, picture.width);
    EXPECT_EQ(back.height, picture.height);
    EXPECT_EQ(back.planes.size(), 3u);
    const double levels = picture.bits == 8 ? 255 : 65535;
    double worst = 0;
    for (std::size_t i = 0; i < picture.values.size(); ++i)
      worst = std::max(worst, std::abs(back.planes[i % 3].values[i / 3] * levels - picture.values[i]));
    return worst;
  }

  std::string bytes(const std::string& name, const film::EncodedPicture& picture) const {
    write_encoded(folder_ / name, picture, "orrery");
    return support::file_bytes(folder_ / name);
  }

  support::TempDir folder_;
};

TEST_F(ImageWriteEncoded, LosslessFormatsKeepEveryLevel) {
  for (const char* name : {"a.png", "a.tif", "a.tiff", "a.ppm"})
    EXPECT_LT(round_trip(name, test_encoded(61, 43, 8)), 0.01) << name;
  for (const char* name : {"a.png", "a.tif"}) EXPECT_LT(round_trip(name, test_encoded(61, 43, 16)), 0.01) << name;
}

TEST_F(ImageWriteEncoded, FilesCarryTheResolutionInPrint) {
  film::EncodedPicture picture = test_encoded(61, 43, 8);
  picture.dpi = 300;
  for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
    write_encoded(folder_ / name, picture, "orrery");
    const auto file = OIIO::ImageInput::open((folder_ / name).string());
    ASSERT_TRUE(file) << name;
    const float scale = file->spec().get_string_attribute("ResolutionUnit") == "cm" ? 2.54F : 1;
    EXPECT_NEAR(file->spec().get_float_attribute("XResolution") * scale, 300, 0.1) << name;
    EXPECT_NEAR(file->spec().get_float_attribute("YResolution") * scale, 300, 0.1) << name;
  }
}

TEST_F(ImageWriteEncoded, LargeImagesRoundTrip) {
  // Larger than all buffers. Regression test: a TIFF lost its directory at this size.
  film::EncodedPicture picture = test_encoded(700, 500, 8);
  for (const bool srgb : {false, true}) {
    picture.is_srgb = srgb;
    for (const char* name : {"a.png", "a.tif", "a.ppm"}) EXPECT_LT(round_trip(name, picture), 0.01) << name;
  }
}

TEST_F(ImageWriteEncoded, OnePixelImagesRoundTrip) {
  for (const char* name : {"a.png", "a.tif", "a.ppm"}) EXPECT_LT(round_trip(name, test_encoded(1, 1, 8)), 0.01) << name;
}

TEST_F(ImageWriteEncoded, JpegErrorIsSmallWithoutChromaSubsampling) {
  EXPECT_LE(round_trip("a.jpg", test_encoded(64, 48, 8, true)), 6);
  // Columns of red and green: chroma subsampling would mix neighbours into brown.
  film::EncodedPicture columns{64, 64, 8, true, {}};
  for (int i = 0; i < 64 * 64; ++i) {
    const bool red = i % 2 == 0;
    columns.values.insert(columns.values.end(), {std::uint16_t(red ? 200 : 40), std::uint16_t(red ? 40 : 200), 40});
  }
  EXPECT_LE(round_trip("b.jpeg", columns), 16);
}

TEST_F(ImageWriteEncoded, SixteenBitsAreRefusedByEightBitFormats) {
  for (const char* name : {"a.jpg", "a.ppm"})
    expect_error(base::ErrorKind::kUsage, {name, "PNG and TIFF"}, [&] { bytes(name, test_encoded(2, 2, 16)); });
  EXPECT_EQ(folder_.count(), 0u);
}

TEST_F(ImageWriteEncoded, SceneLinearAndUnknownFormatsAreRefused) {
  expect_error(base::ErrorKind::kInternal, {"scene-linear"}, [&] { bytes("a.exr", test_encoded(2, 2, 8)); });
  expect_error(base::ErrorKind::kUsage, {"known formats are"}, [&] { bytes("a.gif", test_encoded(2, 2, 8)); });
}

TEST_F(ImageWriteEncoded, PngIsTaggedSrgbOnlyIfItIs) {
  film::EncodedPicture picture = test_encoded(8, 8, 8);
  picture.is_srgb = true;
  EXPECT_NE(bytes("a.png", picture).find("sRGB"), std::string::npos);
  picture.is_srgb = false;
  const std::string plain = bytes("b.png", picture);
  for (const char* chunk : {"sRGB", "gAMA", "cHRM", "iCCP"}) EXPECT_EQ(plain.find(chunk), std::string::npos) << chunk;
}

TEST_F(ImageWriteEncoded, FilesHoldNoDate) {
  const film::EncodedPicture picture = test_encoded(16, 16, 8);
  // A date in any format would contain the century.
  for (const char* name : {"a.png", "a.tif", "a.jpg", "a.ppm"}) {
    const std::string file = bytes(name, picture);
    for (const char* mark : {"20", "tIME"}) {
      for (std::size_t at = file.find(mark); at != std::string::npos; at = file.find(mark, at + 1))
        EXPECT_FALSE(at + 4 < file.size() && file[at + 4] == ':') << name << " has a date: " << file.substr(at, 19);
    }
    EXPECT_TRUE(file == bytes(std::string("b") + name, picture)) << name;
  }
}

TEST_F(ImageWriteEncoded, PngAndTiffHoldStraightAlpha) {
  for (const int bits : {8, 16}) {
    film::EncodedPicture picture = test_encoded(5, 4, bits);
    const auto largest = static_cast<std::uint16_t>((1 << bits) - 1);
    std::vector<std::uint16_t> values;
    for (std::size_t i = 0; i < 20; ++i)
      values.insert(values.end(), {picture.values[3 * i], picture.values[3 * i + 1], picture.values[3 * i + 2],
                                   static_cast<std::uint16_t>(i * largest / 19)});
    picture.values = values;
    picture.channels = 4;
    for (const char* name : {"a.png", "a.tif"}) {
      write_encoded(folder_ / name, picture, "");
      OIIO::ImageSpec as_it_is;
      as_it_is.attribute("oiio:UnassociatedAlpha", 1);
      const auto in = OIIO::ImageInput::open((folder_ / name).string(), &as_it_is);
      ASSERT_TRUE(in);
      EXPECT_EQ(in->spec().nchannels, 4);
      EXPECT_EQ(in->spec().alpha_channel, 3);
      std::vector<std::uint16_t> read(80);
      ASSERT_TRUE(in->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT16, read.data()));
      if (bits == 8)
        for (std::uint16_t& v : read) v = static_cast<std::uint16_t>(v / 257);
      EXPECT_EQ(read, values) << name << ", " << bits;
    }
    if (bits == 8)
      expect_error(base::ErrorKind::kInternal, {"alpha"}, [&] { write_encoded(folder_ / "a.ppm", picture, ""); });
  }
}

TEST_F(ImageWriteEncoded, PpmIsBinary) {
  const film::EncodedPicture picture{2, 1, 8, false, {1, 2, 3, 4, 5, 255}};
  const std::string file = bytes("a.ppm", picture);
  EXPECT_EQ(file.substr(0, 2), "P6");
  EXPECT_EQ(file.substr(file.size() - 6), "\1\2\3\4\5\xff");
}

TEST_F(ImageWriteEncoded, NamesTheSoftware) {
  for (const char* name : {"a.png", "a.tif", "a.jpg"})
    EXPECT_NE(bytes(name, test_encoded(8, 8, 8)).find("orrery"), std::string::npos) << name;
}

}  // namespace
}  // namespace orrery::image
