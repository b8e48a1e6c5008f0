// SPDX-License-Identifier: Apache-2.0
#include "image/read_map.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "image/write.h"
#include "support/exr_file.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

using base::ErrorKind;
using support::ExrFile;

/// All values of a map, rows from the top.
std::vector<float> values_of(const std::filesystem::path& file) {
  const MapHeader header = read_map_header(file);
  std::vector<float> out;
  read_map(file, [&](int row, float* rgb) {
    EXPECT_EQ(static_cast<std::size_t>(row) * 3 * static_cast<std::size_t>(header.width), out.size());
    out.insert(out.end(), rgb, rgb + 3 * header.width);
  });
  EXPECT_EQ(out.size(), 3 * static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height));
  return out;
}

class ImageReadMap : public testing::Test {
 protected:
  void write_foreign(const std::string& name, const OIIO::ImageSpec& spec) {
    const auto out = OIIO::ImageOutput::create("openexr");
    std::vector<float> values(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    ASSERT_TRUE(out->open((folder_ / name).string(), spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, values.data())) << out->geterror();
    ASSERT_TRUE(out->close());
  }

  support::TempDir folder_;
};

TEST_F(ImageReadMap, RowsHoldRedGreenBlueFromTheTop) {
  ExrFile exr{2, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
  support::write_bytes(folder_ / "a.exr", exr.bytes());
  EXPECT_EQ(values_of(folder_ / "a.exr"), exr.rgb);
}

TEST_F(ImageReadMap, OtherChannelsAreIgnored) {
  OIIO::ImageSpec spec(2, 1, 5, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z"};
  write_foreign("a.exr", spec);
  EXPECT_EQ(values_of(folder_ / "a.exr"), (std::vector<float>{0, 1, 2, 5, 6, 7}));
}

TEST_F(ImageReadMap, ASingleChannelIsGrey) {
  OIIO::ImageSpec spec(2, 1, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Y"};
  write_foreign("a.exr", spec);
  EXPECT_EQ(values_of(folder_ / "a.exr"), (std::vector<float>{0, 0, 0, 1, 1, 1}));
}

TEST_F(ImageReadMap, GreyWithAlphaIsGrey) {
  OIIO::ImageSpec spec(2, 1, 2, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Y", "A"};
  write_foreign("a.exr", spec);
  EXPECT_EQ(values_of(folder_ / "a.exr"), (std::vector<float>{0, 0, 0, 2, 2, 2}));
}

TEST_F(ImageReadMap, ChannelsOfOtherNamesAreBadData) {
  OIIO::ImageSpec spec(2, 1, 2, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"N.X", "N.Y"};
  write_foreign("a.exr", spec);
  expect_error(ErrorKind::kBadData, {"no channels R, G and B", "N.X, N.Y"},
               [&] { read_map_header(folder_ / "a.exr"); });
}

TEST_F(ImageReadMap, CoversTheDisplayWindow) {
  for (const bool tiled : {false, true}) {
    OIIO::ImageSpec spec(3, 3, 3, OIIO::TypeDesc::FLOAT);
    spec.x = -1, spec.y = 1;
    spec.full_x = 0, spec.full_y = 0, spec.full_width = 4, spec.full_height = 3;
    if (tiled) spec.tile_width = spec.tile_height = 2;
    write_foreign("a.exr", spec);
    EXPECT_TRUE(read_map_header(folder_ / "a.exr").is_padded);
    EXPECT_EQ(values_of(folder_ / "a.exr"), (std::vector<float>{0,  0,  0,  0,  0,  0,  0, 0, 0, 0, 0, 0,  //
                                                                3,  4,  5,  6,  7,  8,  0, 0, 0, 0, 0, 0,  //
                                                                12, 13, 14, 15, 16, 17, 0, 0, 0, 0, 0, 0}));
  }
}

TEST_F(ImageReadMap, ReadsRadianceFiles) {
  film::Picture picture{4, 2, {}};
  for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, std::vector<float>(8, 0.5F)});
  write_hdr(folder_ / "a.hdr", picture);
  EXPECT_EQ(values_of(folder_ / "a.hdr"), std::vector<float>(24, 0.5F));
  EXPECT_EQ(read_map_header(folder_ / "a.hdr").color_space, "") << "assumed, not declared";
  EXPECT_FALSE(read_map_header(folder_ / "a.hdr").is_padded);
}

TEST_F(ImageReadMap, ReportsTheDeclaredColourSpace) {
  ExrFile exr = ExrFile::constant(2, 1, {1, 1, 1});
  support::write_bytes(folder_ / "a.exr", exr.bytes());
  EXPECT_EQ(read_map_header(folder_ / "a.exr").color_interop_id, "");
  EXPECT_EQ(read_map_header(folder_ / "a.exr").color_space, "") << "assumed, not declared";
  EXPECT_FALSE(read_map_header(folder_ / "a.exr").chromaticities);
  exr.color_interop_id = "lin_ap1_scene";
  exr.chromaticities = {0.713F, 0.293F, 0.165F, 0.83F, 0.128F, 0.044F, 0.32168F, 0.33767F};
  support::write_bytes(folder_ / "a.exr", exr.bytes());
  const MapHeader header = read_map_header(folder_ / "a.exr");
  EXPECT_EQ(header.color_interop_id, "lin_ap1_scene");
  ASSERT_TRUE(header.chromaticities);
  EXPECT_EQ((*header.chromaticities)[3], 0.83F);
}

TEST_F(ImageReadMap, OnlyRegularExrAndHdrFilesAreAccepted) {
  expect_error(ErrorKind::kMissingInput, {"none.exr", "No such file"}, [&] { read_map_header(folder_ / "none.exr"); });
  expect_error(ErrorKind::kMissingInput, {"directory"}, [&] { read_map_header(folder_.path()); });
  for (const char* name : {"a.png", "a.toml", "a"}) {
    support::write_bytes(folder_ / name, "x");
    expect_error(ErrorKind::kBadData, {"exr or hdr"}, [&] { read_map_header(folder_ / name); });
  }
}

TEST_F(ImageReadMap, AHugeHeaderIsReadWithoutPixels) {
  support::write_bytes(folder_ / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32768 +X 65536\n");
  EXPECT_EQ(read_map_header(folder_ / "a.hdr").width, 65536);
  support::write_bytes(folder_ / "b.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 65536\n");
  expect_error(ErrorKind::kBadData, {"b.hdr"}, [&] { read_map_header(folder_ / "b.hdr"); });
  support::write_bytes(folder_ / "c.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 65537\n");
  expect_error(ErrorKind::kBadData, {"c.hdr"}, [&] { read_map_header(folder_ / "c.hdr"); });
}

TEST_F(ImageReadMap, DamagedBytesAreBadDataOrReadable) {
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  write_hdr(folder_ / "a.hdr", test_picture(24, 12));
  support::write_bytes(folder_ / "a.exr", ExrFile::constant(24, 12, {1, 2, 3}).bytes());
  for (const char* name : {"a.hdr", "a.exr"}) {
    const std::string bytes = support::file_bytes(folder_ / name);
    for (int round = 0; round < 300; ++round) {
      std::string damaged = bytes.substr(0, round % 3 == 0 ? below(bytes.size()) + 1 : bytes.size());
      const std::size_t first = round % 2 == 0 ? std::min<std::size_t>(damaged.size(), 400) : damaged.size();
      for (std::size_t n = 1 + below(4); n > 0; --n) damaged[below(first)] = static_cast<char>(below(256));
      support::write_bytes(folder_ / name, damaged);
      try {
        const MapHeader header = read_map_header(folder_ / name);
        int rows = 0;
        read_map(folder_ / name, [&](int row, float* rgb) {
          ASSERT_EQ(row, rows++);
          rgb[3 * header.width - 1] = 0;  // under the address sanitizer, a short row fails
        });
        EXPECT_EQ(rows, header.height);
      } catch (const base::Error& error) {
        EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(ErrorKind::kBadData)) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace orrery::image
