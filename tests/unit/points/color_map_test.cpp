// SPDX-License-Identifier: Apache-2.0
#include "points/color_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "base/error.h"
#include "color_difference.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::points {
namespace {

TEST(PointsColorMap, NamesAreFound) {
  EXPECT_EQ(color_map_names(), (std::vector<std::string>{"fast", "coolwarm", "viridis", "magma", "inferno", "plasma",
                                                         "cividis", "batlow", "turbo", "tab10", "okabe-ito", "set2"}));
  for (const std::string& name : color_map_names()) {
    const ColorMap* map = find_color_map(name);
    ASSERT_NE(map, nullptr) << name;
    EXPECT_EQ(map->name, name);
    EXPECT_LE(map->knots.size(), 48u) << name;
  }
  EXPECT_EQ(find_color_map("jet"), nullptr);
  EXPECT_EQ(find_color_map("Viridis"), nullptr);
}

TEST(PointsColorMap, SharesOfAScale) {
  EXPECT_EQ(ValueScale(2, 6).share_of(3), 0.25);
  EXPECT_EQ(ValueScale(6, 2).share_of(3), 0.75);
  EXPECT_EQ(ValueScale(2, 6).share_of(7), 1);
  EXPECT_EQ(ValueScale(2, 2).share_of(2), 0.5);
  EXPECT_EQ(ValueScale(-1e308, 1e308).share_of(0), 0.5) << "the difference of the ends is not finite";
  EXPECT_NEAR(ValueScale(1e-3, 1e3, true).share_of(1), 0.5, 1e-12);
}

TEST(PointsColorMap, MapsAreFoundInReverse) {
  for (const std::string& name : color_map_names()) {
    const ColorMap &map = *find_color_map(name), *reversed = find_color_map(name + "_r");
    ASSERT_NE(reversed, nullptr) << name;
    EXPECT_EQ(reversed->name, name + "_r");
    EXPECT_EQ(srgb_at(*reversed, 0), srgb_at(map, 1)) << name;
    EXPECT_EQ(srgb_at(*reversed, 1), srgb_at(map, 0)) << name;
    if (!map.is_categorical) {
      EXPECT_LT(difference(srgb_at(*reversed, 0.3), srgb_at(map, 0.7)), 1e-9) << name;
    }
  }
  EXPECT_EQ(find_color_map("jet_r"), nullptr);
}

TEST(PointsColorMap, TheDocumentsListAllMaps) {
  const std::filesystem::path docs = std::filesystem::path(ORRERY_ROOT) / "docs";
  const std::string data = support::file_bytes(docs / "data.md");
  const std::string sources = support::file_bytes(docs / "references.md");
  for (const std::string& name : color_map_names()) {
    EXPECT_NE(data.find("`" + name + "`"), std::string::npos) << name;
    EXPECT_NE(sources.find(name), std::string::npos) << name;
  }
}

TEST(PointsColorMap, ColorsAreContinuousAndClamped) {
  for (const std::string& name : color_map_names()) {
    const ColorMap& map = *find_color_map(name);
    EXPECT_EQ(srgb_at(map, -1), map.knots.front().srgb) << name;
    EXPECT_EQ(srgb_at(map, 0), map.knots.front().srgb) << name;
    EXPECT_EQ(srgb_at(map, 1), map.knots.back().srgb) << name;
    EXPECT_EQ(srgb_at(map, 2), map.knots.back().srgb) << name;
    EXPECT_EQ(srgb_at(map, std::numeric_limits<double>::infinity()), map.knots.back().srgb) << name;
    EXPECT_EQ(srgb_at(map, -std::numeric_limits<double>::infinity()), map.knots.front().srgb) << name;
    if (map.is_categorical) continue;
    for (int i = 0; i < 4096; ++i)
      EXPECT_LT(difference(srgb_at(map, i / 4096.0), srgb_at(map, (i + 1) / 4096.0)), 1) << name << ' ' << i;
  }
}

TEST(PointsColorMap, SrgbIsDecodedExactly) {
  EXPECT_EQ(linear_from_srgb({0, 1, 0.04045}), (Vec3d{0, 1, 0.04045 / 12.92}));
  EXPECT_NEAR(linear_from_srgb({0.5, 0.5, 0.5}).x, 0.21404114048223255, 1e-15);
  EXPECT_NEAR(linear_from_srgb({0.2, 0.2, 0.2}).y, 0.033104766570885055, 1e-15);
}

TEST(PointsColorMap, PaletteIsLight) {
  // Codes that are passed on as if they were light render as pastels: the first colour of viridis, a dark violet, would
  // have a luminance of 0.08, five times too much.
  const std::vector<Vec3d> viridis = palette(*find_color_map("viridis"), 256);
  ASSERT_EQ(viridis.size(), 256u);
  EXPECT_NEAR(viridis[0].x, 0.05780, 0.0005);
  EXPECT_NEAR(viridis[0].y, 0.00038, 0.0001);
  EXPECT_NEAR(viridis[0].z, 0.08881, 0.0005);
  EXPECT_NEAR(viridis[128].y, 0.28121, 0.003);
  EXPECT_NEAR(viridis[255].z, 0.01837, 0.0005);
  const auto luminance = [](Vec3d c) { return dot(c, {0.2126, 0.7152, 0.0722}); };
  EXPECT_LT(luminance(viridis[0]), 0.02);
}

TEST(PointsColorMap, PaletteEndsAreTheEndsOfTheMap) {
  const ColorMap& fast = *find_color_map("fast");
  const std::vector<Vec3d> colors = palette(fast, 5);
  EXPECT_EQ(colors[0], linear_from_srgb(fast.knots.front().srgb));
  EXPECT_EQ(colors[2], linear_from_srgb(srgb_at(fast, 0.5)));
  EXPECT_EQ(colors[4], linear_from_srgb(fast.knots.back().srgb));
  EXPECT_EQ(palette(fast, 1), std::vector<Vec3d>{linear_from_srgb(fast.knots.front().srgb)});
}

class PointsColorMapFile : public testing::Test {
 protected:
  ColorMap read(const std::string& text) {
    std::ofstream(dir_ / "map.txt", std::ios::binary) << text;
    return read_color_map(dir_ / "map.txt");
  }
  /// "LINE text" of each diagnostic.
  std::string fault(const std::string& text) {
    try {
      read(text);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      std::string out;
      for (const base::Diagnostic& d : error.diagnostics()) out += std::to_string(d.line) + ' ' + d.text + '\n';
      return out;
    }
    return "no error";
  }
  support::TempDir dir_;
};

TEST_F(PointsColorMapFile, ReadsAllForms) {
  const ColorMap unit = read("# a comment\n0 0 0\n\n0.5 0.25 1\n1 1 1\n");
  EXPECT_EQ(unit.name, "map.txt");
  EXPECT_FALSE(unit.is_categorical);
  ASSERT_EQ(unit.knots.size(), 3u);
  EXPECT_EQ(unit.knots[1].t, 0.5);
  EXPECT_EQ(unit.knots[1].srgb, (Vec3d{0.5, 0.25, 1}));

  const ColorMap bytes = read(
      "\xEF\xBB\xBF"
      "0,0,0\r\n51,\t255,0\r\n0,0,255");
  ASSERT_EQ(bytes.knots.size(), 3u);
  EXPECT_EQ(bytes.knots[1].srgb, (Vec3d{0.2, 1, 0}));

  const ColorMap hex = read("#000000\n#ff8000\n# ffffff is white\n#FFFFFF\n");
  ASSERT_EQ(hex.knots.size(), 3u);
  EXPECT_EQ(hex.knots[1].srgb, (Vec3d{1, 128 / 255.0, 0}));
  EXPECT_EQ(read("#000000\n#010101\n").knots[1].srgb, (Vec3d{1, 1, 1} / 255)) << "always 0 to 255";

  const ColorMap placed = read("-10 0 0 0\n-5 1 0 0\n 30 1 1 1\n");
  ASSERT_EQ(placed.knots.size(), 3u);
  EXPECT_EQ(placed.knots[0].t, 0);
  EXPECT_EQ(placed.knots[1].t, 0.125);
  EXPECT_EQ(placed.knots[2].t, 1);
}

TEST_F(PointsColorMapFile, ErrorsHaveLines) {
  const std::string forms = "a line is `r g b`, `t r g b` or `#rrggbb`\n";
  EXPECT_EQ(fault("0 0 0\n1 1\n1 1 1"), "2 2 numbers; " + forms);
  EXPECT_EQ(fault("0 0 0\n1 1 x\n1 1 1"), "2 not a colour: " + forms);
  EXPECT_EQ(fault("0 0 0\n1 nan 1\n1 1 1"), "2 not a colour: " + forms);
  EXPECT_EQ(fault("r,g,b\n0 0 0\n1 1 1"), "1 not a colour: " + forms);
  EXPECT_TRUE(test::mentions(fault("0 0 0\n1 -0.1 1\n1 1 256"), {"2", "0", "1", "0"}));
  EXPECT_TRUE(test::mentions(fault("0 0 0\n1 1 1 1\n"), {"2", "first"}));
  EXPECT_TRUE(test::mentions(fault("0 0 0\n#ffffff\n"), {"2", "first"}));
  EXPECT_EQ(fault("0 0 0 0\n1 0 0 0\n1 1 1 1\n"), "3 t does not ascend\n");
  EXPECT_EQ(fault(""), "0 fewer than 2 colours\n");
  EXPECT_EQ(fault("1 1 1\n"), "0 fewer than 2 colours\n");
  EXPECT_TRUE(test::mentions(fault("-1e308 0 0 0\n1e308 1 1 1\n"), {"0", "range", "large"}));
  std::string many;
  for (int i = 0; i < 65'537; ++i) many += "0 0 0\n";
  EXPECT_EQ(fault(many), "65537 more than 65536 colours\n");
  EXPECT_TRUE(test::mentions(fault(std::string(9 << 20, ' ')), {"0", "larger", "8.0"}));
  try {
    read_color_map(dir_ / "missing");
    ADD_FAILURE();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kMissingInput);
  }
}

TEST_F(PointsColorMapFile, KnotsStayDistinctAfterScaling) {
  const ColorMap map = read("0 0 0 0\n1e-320 1 0 0\n1 0 1 0\n1e300 1 1 1\n");
  for (std::size_t i = 1; i < map.knots.size(); ++i) EXPECT_GT(map.knots[i].t, map.knots[i - 1].t);
  EXPECT_EQ(map.knots.back().t, 1);
  EXPECT_TRUE(math::is_finite(srgb_at(map, 0)));
}

TEST(PointsColorMap, EncodingAndDecodingOfSrgbAreInverse) {
  for (int byte = 0; byte <= 255; ++byte) {
    const double code = byte / 255.0;
    const Vec3d back = srgb_from_linear(linear_from_srgb({code, code / 2, 0}));
    EXPECT_NEAR(back.x, code, 1e-4) << byte;  // the two segments of the curve meet within 1e-4
    EXPECT_NEAR(back.y, code / 2, 1e-4) << byte;
    EXPECT_EQ(back.z, 0);
  }
  EXPECT_NEAR(srgb_from_linear({0.5, 0.18, 0.001}).x, 0.7353569, 1e-7);
  EXPECT_NEAR(srgb_from_linear({0.5, 0.18, 0.001}).z, 0.01292, 1e-7);
}

}  // namespace
}  // namespace orrery::points
