// SPDX-License-Identifier: Apache-2.0
#include "image/read.h"

#include <OpenImageIO/imageio.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>

#include "image/format.h"
#include "image/header.h"
#include "image/write.h"
#include "support/exr_file.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

using base::ErrorKind;

/// Writes an EXR that orrery itself would not write, with values 0, 1, 2, ... row by row.
void write_foreign(const std::filesystem::path& file, OIIO::ImageSpec spec) {
  const auto out = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(out->open(file.string(), spec)) << out->geterror();
  std::vector<std::uint32_t> whole(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
  for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = static_cast<std::uint32_t>(i);
  const std::vector<float> real(whole.begin(), whole.end());
  if (spec.format == OIIO::TypeDesc::UINT) {
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT, whole.data())) << out->geterror();
  } else {
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, real.data())) << out->geterror();
  }
  ASSERT_TRUE(out->close());
}

OIIO::ImageSpec grey(int width, int height, OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
  OIIO::ImageSpec spec(width, height, 1, type);
  spec.channelnames = {"Y"};
  return spec;
}

class ImageRead : public testing::Test {
 protected:
  support::TempDir folder_;
};

TEST_F(ImageRead, AMissingFileIsAMissingInput) {
  expect_error(ErrorKind::kMissingInput, {"none.exr", "No such file"}, [&] { read(folder_ / "none.exr"); });
  std::filesystem::create_directory(folder_ / "d.exr");
  expect_error(ErrorKind::kMissingInput, {"d.exr", "it is a directory"}, [&] { read(folder_ / "d.exr"); });
  ASSERT_EQ(::mkfifo((folder_ / "p.exr").c_str(), 0600), 0);
  expect_error(ErrorKind::kMissingInput, {"p.exr", "not a regular file"}, [&] { read(folder_ / "p.exr"); });
  expect_error(ErrorKind::kUsage, {"known formats are"}, [&] { read(folder_ / "none.txt"); });
}

TEST_F(ImageRead, ASmallerDataWindowIsPaddedWithZeros) {
  OIIO::ImageSpec spec = grey(2, 2);
  spec.x = 11, spec.y = 21;
  spec.full_x = 10, spec.full_y = 20, spec.full_width = 4, spec.full_height = 5;
  write_foreign(folder_ / "a.exr", spec);
  const film::Picture picture = read(folder_ / "a.exr");
  EXPECT_EQ(picture.width, 4);
  EXPECT_EQ(picture.height, 5);
  EXPECT_EQ(picture.planes[0].values, (std::vector<float>{0, 0, 0, 0,  //
                                                          0, 0, 1, 0,  //
                                                          0, 2, 3, 0,  //
                                                          0, 0, 0, 0,  //
                                                          0, 0, 0, 0}));
}

TEST_F(ImageRead, ALargerDataWindowIsCropped) {
  OIIO::ImageSpec spec = grey(4, 3);
  spec.x = -1, spec.y = -1;
  spec.full_x = 0, spec.full_y = 0, spec.full_width = 2, spec.full_height = 1;
  write_foreign(folder_ / "a.exr", spec);
  EXPECT_EQ(read(folder_ / "a.exr").planes[0].values, (std::vector<float>{5, 6}));
}

TEST_F(ImageRead, ADataWindowOutsideTheDisplayWindowGivesZeros) {
  for (const int y : {-50, 50}) {
    OIIO::ImageSpec spec = grey(4, 3);
    spec.y = y;
    spec.full_x = 0, spec.full_y = 0, spec.full_width = 2, spec.full_height = 2;
    write_foreign(folder_ / "a.exr", spec);
    EXPECT_EQ(read(folder_ / "a.exr").planes[0].values, (std::vector<float>{0, 0, 0, 0})) << y;
  }
}

TEST_F(ImageRead, ALargeDisplayWindowNeedsItsMemory) {
  OIIO::ImageSpec spec = grey(4, 3);
  spec.full_width = 60000, spec.full_height = 60000;
  write_foreign(folder_ / "a.exr", spec);
  expect_error(ErrorKind::kNoMemory, {"a.exr", "60000 x 60000", "13.4 GiB", "1.0 GiB is free"},
               [&] { read(folder_ / "a.exr", Parts::kFirst, std::uint64_t{1} << 30); });
}

TEST_F(ImageRead, TiledFilesReadLikeScanlines) {
  OIIO::ImageSpec spec = grey(75, 150);
  write_foreign(folder_ / "rows.exr", spec);
  spec.tile_width = 32, spec.tile_height = 16;
  write_foreign(folder_ / "tiles.exr", spec);
  const film::Picture rows = read(folder_ / "rows.exr");
  EXPECT_EQ(rows.planes[0].values.back(), 75 * 150 - 1);
  EXPECT_EQ(read(folder_ / "tiles.exr").planes[0].values, rows.planes[0].values);
}

TEST_F(ImageRead, IntegersKeepTheirValues) {
  write_foreign(folder_ / "a.exr", grey(150, 2, OIIO::TypeDesc::UINT));
  const film::Picture picture = read(folder_ / "a.exr");
  for (std::size_t i = 0; i < 300; ++i) ASSERT_EQ(picture.planes[0].values[i], static_cast<float>(i));
}

TEST_F(ImageRead, NonFiniteValuesAreReturned) {
  film::Picture picture = test_picture(3, 1, {"R"});
  ExrOptions options;
  options.as_float = true;
  options.compression = "none";
  write_exr(folder_ / "a.exr", picture, {}, options);
  std::string bytes = support::file_bytes(folder_ / "a.exr");
  bytes.replace(bytes.size() - 8, 8, std::string("\0\0\xc0\x7f\0\0\x80\x7f", 8));  // NaN, infinity
  support::write_bytes(folder_ / "a.exr", bytes);
  film::BadValues bad;
  for (const film::Plane& plane : read(folder_ / "a.exr").planes) bad += film::count_bad_values(plane);
  EXPECT_EQ(bad.nan, 1u);
  EXPECT_EQ(bad.infinite, 1u);
}

TEST_F(ImageRead, AFileOfAnotherFormatIsBadData) {
  for (const char* name : {"a.exr", "a.hdr", "a.png", "a.tif", "a.jpg", "a.ppm"}) {
    support::write_bytes(folder_ / name, "[image]\nwidth = 1200\n" + std::string(2000, '#'));
    expect_error(ErrorKind::kBadData, {name}, [&] { read(folder_ / name); });
  }
}

TEST_F(ImageRead, AHeaderWithAnExcessiveSizeIsBadData) {
  write_exr(folder_ / "a.exr", test_picture(4, 4), {}, {});
  std::string bytes = support::file_bytes(folder_ / "a.exr");
  for (const char* window : {"dataWindow", "displayWindow"}) {
    const std::size_t at = bytes.find(window) + std::string(window).size() + 1 + 6 + 4 + 8;
    bytes.replace(at, 8, std::string("\xff\xff\x01\0\xff\xff\x01\0", 8));  // 131072 x 131072
  }
  support::write_bytes(folder_ / "a.exr", bytes);
  expect_error(ErrorKind::kBadData, {"a.exr"}, [&] { read(folder_ / "a.exr"); });
  write_foreign(folder_ / "wide.exr", grey(65536, 1));
  EXPECT_EQ(read(folder_ / "wide.exr").width, 65536);
  write_foreign(folder_ / "wider.exr", grey(65537, 1));
  expect_error(ErrorKind::kBadData, {"65537 x 1", "1 to 65536"}, [&] { read(folder_ / "wider.exr"); });
  support::write_bytes(folder_ / "a.ppm", "P6\n1000000 1000000\n255\nabc");
  expect_error(ErrorKind::kBadData, {"a.ppm"}, [&] { read(folder_ / "a.ppm"); });
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Limits the address space, reads an image that does not fit, and exits with the kind of the error.
[[noreturn]] void read_without_memory(const std::filesystem::path& small, const std::filesystem::path& large) {
  read(small);  // loads what the library loads once
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit limit{pages * 4096 + (16 << 20), RLIM_INFINITY};
  ::setrlimit(RLIMIT_AS, &limit);
  try {
    read(large);
  } catch (const base::Error& error) {
    std::fputs(error.what(), stderr);
    std::_Exit(static_cast<int>(error.kind()));
  }
  std::_Exit(100);
}

TEST_F(ImageRead, TooLittleMemoryIsNotAnErrorOfTheFile) {
  write_foreign(folder_ / "small.exr", grey(4, 4));
  write_foreign(folder_ / "large.exr", grey(4096, 4096));
  EXPECT_EXIT(read_without_memory(folder_ / "small.exr", folder_ / "large.exr"),
              testing::ExitedWithCode(static_cast<int>(ErrorKind::kNoMemory)), "large.exr: there is not enough memory");
}

#endif

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
