// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "image/format.h"
#include "image/header.h"
#include "image/library.h"
#include "image/read.h"
#include "support/temp_dir.h"
#include "unit/image/exr_header.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

class ImageWrite : public testing::Test {
 protected:
  std::map<std::string, ExrAttribute> header_of(const Header& header, const ExrOptions& options = {}) const {
    write_exr(folder_ / "a.exr", test_picture(5, 3), header, options);
    return exr_header(support::file_bytes(folder_ / "a.exr"));
  }

  support::TempDir folder_;
};

std::string joined_names(const std::map<std::string, ExrAttribute>& header) {
  std::string out;
  for (const auto& [name, attribute] : header) out += name + " ";
  return out;
}

TEST_F(ImageWrite, ExrKeepsHalfValuesExactly) {
  const film::Picture picture = test_picture(37, 19);
  const WriteReport report = write_exr(folder_ / "a.exr", picture, {}, {});
  EXPECT_EQ(report.clamped + report.not_finite, 0u);
  const film::Picture back = read(folder_ / "a.exr");
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 19);
  ASSERT_EQ(back.planes.size(), 4u);
  for (const film::Plane& plane : picture.planes) {
    ASSERT_NE(back.find(plane.name), nullptr);
    EXPECT_EQ(back.find(plane.name)->values, plane.values) << plane.name;
  }
}

TEST_F(ImageWrite, ExrRoundsToTheNearestHalfAndKeepsFloats) {
  film::Picture picture{3, 1, {{"R", {1 + 0x1.1p-11f, 1 + 0x0.fp-11f, 0x1p-24f}}}};
  write_exr(folder_ / "a.exr", picture, {}, {});
  EXPECT_EQ(read(folder_ / "a.exr").planes[0].values, (std::vector<float>{1 + 0x1p-10f, 1, 0x1p-24f}));
  ExrOptions options;
  options.as_float = true;
  write_exr(folder_ / "a.exr", picture, {}, options);
  EXPECT_EQ(read(folder_ / "a.exr").planes[0].values, picture.planes[0].values);
}

TEST_F(ImageWrite, ExrStoresLayersByName) {
  const film::Picture picture = test_picture(4, 4, {"R", "G", "B", "A", "variance.R", "albedo.G", "Z"});
  write_exr(folder_ / "a.exr", picture, {}, {});
  const film::Picture back = read(folder_ / "a.exr");
  ASSERT_EQ(back.planes.size(), 7u);
  for (const film::Plane& plane : picture.planes) EXPECT_EQ(back.find(plane.name)->values, plane.values) << plane.name;
}

TEST_F(ImageWrite, ExrHasTheStandardAttributes) {
  Header header;
  header.software = "orrery 1.2";
  header.capture_date = "2020:01:02 03:04:05";
  header.utc_offset_s = -32400;
  header.frames_per_second = {24000, 1001};
  header.world_to_camera.emplace();
  header.world_to_ndc.emplace();
  for (std::size_t i = 0; i < 16; ++i) {
    (*header.world_to_camera)[i] = static_cast<float>(i);
    (*header.world_to_ndc)[i] = static_cast<float>(100 + i);
  }
  header.chromaticities = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  header.color_interop_id = "lin_rec709_scene";
  header.attributes = {
      {"orrery/seed", "18446744073709551615"}, {"orrery/samples", 500}, {"orrery/renderSeconds", 1.5f}};
  auto exr = header_of(header);

  const auto expect_text = [&](const char* name, const std::string& text) {
    EXPECT_EQ(exr[name].type, "string") << name << " among " << joined_names(exr);
    EXPECT_EQ(exr[name].bytes, text) << name;
  };
  expect_text("software", "orrery 1.2");
  expect_text("capDate", "2020:01:02 03:04:05");
  EXPECT_EQ(exr["utcOffset"].numbers<float>(), std::vector<float>{-32400});
  expect_text("colorInteropID", "lin_rec709_scene");
  expect_text("orrery/seed", "18446744073709551615");
  EXPECT_EQ(exr["framesPerSecond"].type, "rational");
  EXPECT_EQ(exr["framesPerSecond"].numbers<std::int32_t>(), (std::vector<std::int32_t>{24000, 1001}));
  EXPECT_EQ(exr["worldToCamera"].type, "m44f");
  EXPECT_EQ(exr["worldToCamera"].numbers<float>(),
            std::vector<float>(header.world_to_camera->begin(), header.world_to_camera->end()));
  EXPECT_EQ(exr["worldToNDC"].type, "m44f");
  EXPECT_EQ(exr["worldToNDC"].numbers<float>(),
            std::vector<float>(header.world_to_ndc->begin(), header.world_to_ndc->end()));
  EXPECT_EQ(exr["chromaticities"].type, "chromaticities");
  EXPECT_EQ(exr["chromaticities"].numbers<float>(),
            std::vector<float>(header.chromaticities->begin(), header.chromaticities->end()));
  EXPECT_EQ(exr["orrery/samples"].type, "int");
  EXPECT_EQ(exr["orrery/samples"].numbers<std::int32_t>(), std::vector<std::int32_t>{500});
  EXPECT_EQ(exr["orrery/renderSeconds"].type, "float");
  EXPECT_EQ(exr["orrery/renderSeconds"].numbers<float>(), std::vector<float>{1.5f});
}

TEST_F(ImageWrite, ExrIsScanlineAndCoversTheFrame) {
  auto exr = header_of({});
  const std::vector<std::int32_t> frame = {0, 0, 4, 2};
  EXPECT_EQ(exr["dataWindow"].numbers<std::int32_t>(), frame);
  EXPECT_EQ(exr["displayWindow"].numbers<std::int32_t>(), frame);
  EXPECT_EQ(exr.count("tiles"), 0u);
  EXPECT_EQ(exr["lineOrder"].bytes, std::string(1, '\0'));
  const std::string flags = support::file_bytes(folder_ / "a.exr").substr(4, 4);
  EXPECT_EQ(flags, std::string("\2\0\0\0", 4));  // version 2, not tiled, not deep, one part
}

TEST_F(ImageWrite, ExrHasNoUnrequestedAttributes) {
  EXPECT_EQ(joined_names(header_of({})),
            "channels compression dataWindow displayWindow lineOrder pixelAspectRatio screenWindowCenter "
            "screenWindowWidth ");
}

TEST_F(ImageWrite, ExrUsesTheRequestedCompression) {
  const std::vector<std::pair<std::string, char>> codes = {{"none", 0}, {"rle", 1},  {"zips", 2}, {"zip", 3},
                                                           {"piz", 4},  {"dwaa", 8}, {"dwab", 9}, {"dwaa:45", 8}};
  for (const auto& [name, code] : codes) {
    ExrOptions options;
    options.compression = name;
    auto exr = header_of({}, options);
    EXPECT_EQ(exr["compression"].bytes, std::string(1, code)) << name;
    if (name == "dwaa:45") {
      EXPECT_EQ(exr["dwaCompressionLevel"].numbers<float>(), std::vector<float>{45});
    }
  }
  EXPECT_EQ(header_of({})["compression"].bytes, std::string(1, '\2'));
}

TEST_F(ImageWrite, AnUnknownCompressionIsAUsageError) {
  for (const char* name : {"", "zipp", "zip:9", "dwaa:", "dwaa:x", "dwaa:-1", "dwaa:nan", "dwaa:45x", "ZIPS"}) {
    ExrOptions options;
    options.compression = name;
    expect_error(base::ErrorKind::kUsage, {"none, rle, zip, zips, piz, dwaa, dwab"},
                 [&] { write_exr(folder_ / "a.exr", test_picture(2, 2), {}, options); });
  }
  EXPECT_EQ(folder_.count(), 0u);
}

TEST_F(ImageWrite, TwoWritesGiveTheSameBytes) {
  const film::Picture picture = test_picture(40, 30);
  Header header;
  header.software = "orrery";
  header.attributes = {{"orrery/seed", 1}};
  write_exr(folder_ / "a.exr", picture, header, {});
  write_exr(folder_ / "b.exr", picture, header, {});
  EXPECT_TRUE(support::file_bytes(folder_ / "a.exr") == support::file_bytes(folder_ / "b.exr"));
}

TEST_F(ImageWrite, HdrKeepsEightBitsOfThePixelMaximum) {
  const film::Picture picture = test_picture(41, 17);
  EXPECT_EQ(write_hdr(folder_ / "a.hdr", picture).clamped, 0u);
  const film::Picture back = read(folder_ / "a.hdr");
  ASSERT_EQ(back.planes.size(), 3u);
  for (std::size_t i = 0; i < 41 * 17; ++i) {
    const float largest =
        std::max({picture.planes[0].values[i], picture.planes[1].values[i], picture.planes[2].values[i]});
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(back.planes[c].values[i], picture.planes[c].values[i], largest / 128);
  }
}

TEST_F(ImageWrite, HdrRequiresRgb) {
  expect_error(base::ErrorKind::kBadData, {"no channel B"}, [&] {
    write_hdr(folder_ / "a.hdr", test_picture(2, 2, {"R", "G"}));
  });
}

TEST_F(ImageWrite, OtherProgramsReadTheExr) {
  if (std::system("oiiotool --help > /dev/null 2>&1") != 0) GTEST_SKIP() << "needs oiiotool";
  film::Picture picture{8, 8, {}};
  for (const char* name : {"R", "G", "B", "A"}) picture.planes.push_back({name, std::vector<float>(64, 0.5f)});
  write_exr(folder_ / "a.exr", picture, {}, {});
  const std::string file = (folder_ / "a.exr").string(), text = (folder_ / "text").string();
  ASSERT_EQ(std::system(("oiiotool --info -v --stats " + file + " > " + text).c_str()), 0);
  const std::string info = support::file_bytes(text);
  EXPECT_NE(info.find("8 x    8, 4 channel, half openexr"), std::string::npos) << info;
  EXPECT_NE(info.find("channel list: R, G, B, A"), std::string::npos) << info;
  EXPECT_NE(info.find("Constant: Yes"), std::string::npos) << info;
}

/// An image with colour, vector and data layers.
film::Picture layered_picture() {
  film::Picture picture = test_picture(6, 4, {"R", "G", "B", "A", "Z", "N.X", "CryptoObject00.R", "CryptoObject01.R"});
  for (film::Plane& plane : picture.planes) {
    if (plane.name == "Z" || plane.name.starts_with("Crypto")) plane.kind = film::PlaneKind::kData;
    if (plane.name == "N.X") plane.kind = film::PlaneKind::kVector;
  }
  return picture;
}

TEST_F(ImageWrite, DataLayersAreLossless) {
  film::Picture picture = layered_picture();
  picture.planes[4].values[0] = 1e30f;
  picture.planes[6].values[1] = -0x1.234567p-100f;
  EXPECT_EQ(write_exr(folder_ / "a.exr", picture, {}, {}).clamped, 0u);
  const film::Picture back = read(folder_ / "a.exr");
  for (const film::Plane& plane : picture.planes) EXPECT_EQ(back.find(plane.name)->values, plane.values) << plane.name;
}

TEST_F(ImageWrite, LossyCompressionOfDataIsRefusedUnlessMultipart) {
  ExrOptions options;
  options.compression = "dwaa:45";
  expect_error(base::ErrorKind::kUsage, {"dwaa:45", "CryptoObject00", "--multipart"},
               [&] { write_exr(folder_ / "a.exr", layered_picture(), {}, options); });
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
  options.multipart = true;
  EXPECT_NO_THROW(write_exr(folder_ / "a.exr", layered_picture(), {}, options));
  options.multipart = false;
  EXPECT_NO_THROW(write_exr(folder_ / "a.exr", test_picture(4, 4), {}, options));
}

TEST_F(ImageWrite, PartsAreNamedAfterLayersAndAMatteIsOnePart) {
  ExrOptions options;
  options.multipart = true;
  Header header;
  header.attributes = {{"orrery/seed", std::string("1")}};
  header.matte_attributes = {{"cryptomatte/3ae39a5/name", std::string("CryptoObject")}};
  write_exr(folder_ / "a.exr", layered_picture(), header, options);
  const auto in = OIIO::ImageInput::open((folder_ / "a.exr").string());
  ASSERT_TRUE(in) << OIIO::geterror();
  std::string parts;
  for (int part = 0; in->seek_subimage(part, 0); ++part) {
    const OIIO::ImageSpec spec = in->spec();
    parts += std::string(spec.get_string_attribute("oiio:subimagename")) + ":" + std::to_string(spec.nchannels) +
             (spec.find_attribute("cryptomatte/3ae39a5/name") != nullptr ? "m " : " ");
    EXPECT_EQ(spec.get_string_attribute("orrery/seed"), "1") << part;
  }
  EXPECT_EQ(parts, "rgba:4m Z:1 N:1 CryptoObject:2m ");
}

TEST_F(ImageWrite, DeepPixelsRoundTrip) {
  film::DeepPicture deep{2, 1, {{{1, 2, {0.1f, 0.2f, 0.3f}, 0.5f}, {4, 6, {0.5f, 0, 0}, 1}}, {}}};
  film::Picture flat{2, 1, {}};
  write_deep(folder_ / "a.exr", deep, flat, {});
  const auto in = OIIO::ImageInput::open((folder_ / "a.exr").string());
  ASSERT_TRUE(in);
  OIIO::DeepData data;
  ASSERT_TRUE(in->read_native_deep_image(0, 0, data)) << in->geterror();
  EXPECT_EQ(data.samples(0), 2);
  EXPECT_EQ(data.samples(1), 0);
  const auto value = [&](const char* channel, int sample) {
    for (int c = 0; c < data.channels(); ++c)
      if (data.channelname(c) == channel) return data.deep_value(0, c, sample);
    return -1.0f;
  };
  EXPECT_EQ(value("Z", 0), 1);
  EXPECT_EQ(value("ZBack", 0), 2);
  EXPECT_EQ(value("B", 0), 0.3f);
  EXPECT_EQ(value("A", 1), 1);
}

}  // namespace
}  // namespace orrery::image
