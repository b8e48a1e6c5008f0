// SPDX-License-Identifier: Apache-2.0
#include "format/read_ply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "base/diagnostic.h"
#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::format {
namespace {

using scene::Vec3d;

constexpr const char* kXyzr = "property float x\nproperty float y\nproperty float z\nproperty float radius\n";

std::string header(const std::string& encoding, const std::string& elements) {
  return "ply\nformat " + encoding + " 1.0\n" + elements + "end_header\n";
}

template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string out(sizeof(T), '\0');
  std::memcpy(out.data(), &value, sizeof(T));
  if (big_endian) std::reverse(out.begin(), out.end());  // tests run on little-endian machines
  return out;
}

class FormatReadPly : public testing::Test {
 protected:
  scene::Points read(const std::string& bytes, std::size_t materials = 3, std::optional<double> radius = {}) {
    support::write_bytes(folder_ / "a.ply", bytes);
    scene::Points points;
    points.radius = radius;
    read_ply(folder_ / "a.ply", materials, points);
    return points;
  }
  /// Diagnostics without the name of the file.
  std::string faults(const std::string& bytes, std::optional<double> radius = {}) {
    std::string out;
    try {
      read(bytes, 3, radius);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      for (const base::Diagnostic& f : error.diagnostics())
        out += (f.line > 0 ? std::to_string(f.line) + ": " : "") + f.text + "\n";
    }
    return out;
  }
  support::TempDir folder_;
};

TEST_F(FormatReadPly, ReadsAscii) {
  const auto points = read(header("ascii", std::string("element vertex 2\n") + kXyzr) + "1 2 3 0.5\r\n-4e2 +5 .25 -1");
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1, 2, 3}, {-400, 5, 0.25}}));
  EXPECT_EQ(points.radii, (std::vector<double>{0.5, -1}));
  EXPECT_TRUE(points.materials.empty());
}

TEST_F(FormatReadPly, BinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string data;
    for (const float x : {1.5f, -2.f, 3.f, 0.25f}) data += bytes_of(x, big);
    const auto points = read(
        header(big ? "binary_big_endian" : "binary_little_endian", std::string("element vertex 1\n") + kXyzr) + data);
    EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1.5, -2, 3}}));
    EXPECT_EQ(points.radii, std::vector<double>{0.25});
  }
}

TEST_F(FormatReadPly, EveryNumberTypeInBothByteOrders) {
  for (const bool big : {false, true}) {
    const std::string data = bytes_of<std::int8_t>(-7, big) + bytes_of<std::uint8_t>(200, big) +
                             bytes_of<std::int16_t>(-3000, big) + bytes_of<std::uint16_t>(60000, big) +
                             bytes_of<std::int32_t>(-100000, big) + bytes_of<std::uint32_t>(4000000000u, big) +
                             bytes_of<double>(0.1, big) + bytes_of<float>(2.5f, big);
    // Two vertices with values of eight types: x, y, z, radius of the first and of the second.
    const char* const encoding = big ? "binary_big_endian" : "binary_little_endian";
    const auto first = read(header(encoding,
                                   "element vertex 1\nproperty char x\nproperty uchar y\nproperty short z\n"
                                   "property ushort radius\n") +
                            data.substr(0, 6));
    EXPECT_EQ(first.centers[0], (Vec3d{-7, 200, -3000}));
    EXPECT_EQ(first.radii[0], 60000);
    const auto second = read(header(encoding,
                                    "element vertex 1\nproperty int x\nproperty uint y\nproperty double z\n"
                                    "property float radius\n") +
                             data.substr(6));
    EXPECT_EQ(second.centers[0], (Vec3d{-100000, 4000000000.0, 0.1}));
    EXPECT_EQ(second.radii[0], 2.5);
  }
}

TEST_F(FormatReadPly, SkipsOtherElementsPropertiesAndLists) {
  const std::string elements =
      "element face 2\nproperty list uchar int corners\nproperty uchar flag\nelement vertex 2\nproperty float nx\n"
      "property float x\nproperty list ushort float weights\nproperty float y\nproperty float z\nproperty float "
      "radius\n"
      "element edge 9\nproperty int a\n";
  std::string data = bytes_of<std::uint8_t>(2) + bytes_of(1) + bytes_of(2) + bytes_of<std::uint8_t>(9) +
                     bytes_of<std::uint8_t>(0) + bytes_of<std::uint8_t>(9);
  for (const float x : {1.f, 5.f}) {
    data += bytes_of(99.f) + bytes_of(x) + bytes_of<std::uint16_t>(1) + bytes_of(77.f);
    for (const float v : {x + 1, x + 2, x + 3}) data += bytes_of(v);
  }
  for (int i = 0; i < 9; ++i) data += bytes_of(i);
  const auto points = read(header("binary_little_endian", elements) + data);
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1, 2, 3}, {5, 6, 7}}));
  EXPECT_EQ(points.radii, (std::vector<double>{4, 8}));
  const auto ascii =
      read(header("ascii", elements) + "2 1 2 9\n0 9\n99 1 1 77 2 3 4\n\n99 5 1 77 6 7 8\n1\n2\n3\n4\n5\n6\n7\n8\n9\n");
  EXPECT_EQ(ascii.centers, points.centers);
  EXPECT_EQ(ascii.radii, points.radii);
}

TEST_F(FormatReadPly, RadiusHasThreeNamesAndTheLongestWins) {
  const std::string xyz = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(read(header("ascii", xyz + "property float r\n") + "1 2 3 4").radii[0], 4);
  EXPECT_EQ(read(header("ascii", xyz + "property float scalar_radius\n") + "1 2 3 4").radii[0], 4);
  EXPECT_EQ(read(header("ascii", xyz + "property float r\nproperty float radius\n") + "1 2 3 9 4").radii[0], 4);
  EXPECT_EQ(read(header("ascii", xyz + "property float radius\nproperty float r\n") + "1 2 3 4 9").radii[0], 4);
}

TEST_F(FormatReadPly, TheRadiusOfTheSceneAppliesToEveryPoint) {
  const auto points = read(
      header("ascii", "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n") + "1 2 3", 3, 0.125);
  EXPECT_EQ(points.radii, std::vector<double>{0.125});
  EXPECT_EQ(read(header("ascii", std::string("element vertex 1\n") + kXyzr) + "1 2 3 4", 3, 0.125).radii[0], 0.125);
}

TEST_F(FormatReadPly, MaterialsAreIndices) {
  const std::string elements = std::string("element vertex 3\n") + kXyzr + "property uchar material\n";
  EXPECT_EQ(read(header("ascii", elements) + "0 0 0 1 2\n1 0 0 1 0\n2 0 0 1 1").materials,
            (std::vector<std::uint32_t>{2, 0, 1}));
  EXPECT_EQ(faults(header("ascii", elements) + "0 0 0 1 3\n1 0 0 1 -1\n2 0 0 1 0.5"),
            "10: vertex 0 has material 3; the scene has 3, counted from 0\n"
            "11: vertex 1 has material -1; the scene has 3, counted from 0\n"
            "12: vertex 2 has material 0.5; the scene has 3, counted from 0\n");
}

TEST_F(FormatReadPly, AcceptsZeroVertices) {
  EXPECT_TRUE(read(header("ascii", std::string("element vertex 0\n") + kXyzr)).centers.empty());
}

TEST_F(FormatReadPly, MissingElementsAndPropertiesAreNamed) {
  EXPECT_EQ(faults(header("ascii", "element face 0\n")), "there is no element `vertex`\n");
  EXPECT_EQ(faults(header("ascii", "element vertex 0\nproperty float x\nproperty float y\n")),
            "`vertex` needs x, y and z\n");
  EXPECT_EQ(faults(header("ascii", "element vertex 0\nproperty float x\nproperty float y\nproperty float z\n")),
            "`vertex` has no `radius`; add one, or set `radius` in [[points]]\n");
  EXPECT_EQ(
      faults(header("ascii", "element vertex 1\nproperty float x\nproperty float y\nproperty list uchar float z\n") +
                 "1 1 1 1",
             1.0),
      "`vertex` needs x, y and z\n");
}

TEST_F(FormatReadPly, HeaderFaultsHaveALine) {
  EXPECT_EQ(faults("ply\nformat ascii 1.0\nelement vertex many\n"),
            "3: the count of an element must be a non-negative integer\n");
}

TEST_F(FormatReadPly, AnExcessiveCountIsRefusedBeforeAllocation) {
  // 2^60 rows of sixteen bytes exceed the memory of any machine.
  const std::string data(31, '\0');
  EXPECT_EQ(
      faults(header("binary_little_endian", std::string("element vertex 1152921504606846976\n") + kXyzr) + data),
      "the header declares 1152921504606846976 rows of `vertex`, but only 31 bytes follow; the file is truncated, or "
      "the count is wrong\n");
  EXPECT_EQ(faults(header("binary_little_endian", std::string("element vertex 18446744073709551615\n") + kXyzr) + data)
                .rfind("the header declares 18446744073709551615", 0),
            0u);
  EXPECT_EQ(faults(header("binary_little_endian", std::string("element vertex 2\n") + kXyzr) + data)
                .rfind("the header declares 2 rows of `vertex`, but only 31 bytes follow", 0),
            0u);
  EXPECT_EQ(faults(header("binary_little_endian", std::string("element vertex 1\n") + kXyzr) + data.substr(0, 16)), "");
  EXPECT_NE(faults(header("ascii", std::string("element vertex 3\n") + kXyzr) + "1 2 3 4 1 2 3 4"), "");
}

TEST_F(FormatReadPly, InvalidListLengths) {
  const std::string elements = "element face 1\nproperty list double float corners\nelement vertex 0\n";
  EXPECT_EQ(faults(header("binary_little_endian", elements + kXyzr) + bytes_of(1e300) + bytes_of(1.f)),
            "row 0 of `face`, `corners`: unexpected end of file\n");
  EXPECT_EQ(faults(header("binary_little_endian", elements + kXyzr) + bytes_of(-1.0) + bytes_of(1.f)),
            "row 0 of `face`, `corners`: the length of the list is not a non-negative integer\n");
}

// The sixth line is blank, the rows are on lines 9 and 11.
constexpr const char* kTwo =
    "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\n";

TEST_F(FormatReadPly, AnAsciiRowIsOneLine) {
  EXPECT_EQ(faults(header("ascii", kTwo) + "1 2 3 4\n\n1 2 3\n4\n"),
            "11: vertex 1 of 2, `radius`: unexpected end of line; a row must be one line\n");
  EXPECT_EQ(faults(header("ascii", kTwo) + "1 2 3 4 1\n2 3 4\n"),
            "9: vertex 0 of 2: unexpected `1` after the last value that the header declares\n");
  EXPECT_EQ(faults(header("ascii", kTwo) + "1 2 3 4\n1 2 3 4x\n"),
            "10: vertex 1 of 2, `radius`: `4x` is not a number\n");
  EXPECT_EQ(faults(header("ascii", kTwo) + "1 2 3 4 \r\n \t\n1 2 3 4\n"), "");
  EXPECT_EQ(faults(header("ascii", std::string("element face 1\nproperty list uchar int v\n") + kTwo) +
                   "3 1 2\n7\n1 2 3 4\n1 2 3 4\n"),
            "11: row 0 of `face`, `v`: unexpected end of line; a row must be one line\n");
}

TEST_F(FormatReadPly, AMissingAsciiRowIsAnUnexpectedEndOfFile) {
  const std::string elements = "element face 3\nproperty list uchar int v\nelement vertex 0\n";
  EXPECT_EQ(faults(header("ascii", elements + kXyzr) + "1 7\n1 7\n"),
            "13: row 2 of `face`, `v`: unexpected end of file\n");
}

TEST_F(FormatReadPly, ExcessDataIsRefused) {
  EXPECT_EQ(faults(header("ascii", kTwo) + "1 2 3 4\n1 2 3 4\n5 6 7 8\n"),
            "11: 8 bytes follow the last row that the header declares; the counts are wrong, or the file is damaged\n");
  EXPECT_EQ(faults(header("ascii", kTwo) + "1 2 3 4\n1 2 3 4\n \n\r\n"), "") << "blank lines are not rows";
  EXPECT_EQ(faults(header("binary_little_endian", kTwo) + std::string(2 * 16 + 3, '\0')),
            "3 bytes follow the last row that the header declares; the counts are wrong, or the file is damaged\n");
}

TEST_F(FormatReadPly, ElementsAfterTheVerticesMustBeComplete) {
  const std::string elements = std::string(kTwo) + "element face 1\nproperty list uchar int v\n";
  EXPECT_EQ(faults(header("ascii", elements) + "1 2 3 4\n1 2 3 4\n3 1 2 3\n"), "");
  EXPECT_NE(faults(header("ascii", elements) + "1 2 3 4\n1 2 3 4\n"), "");
  EXPECT_EQ(faults(header("binary_little_endian", elements) + std::string(2 * 16, '\0') + "\2abcd"),
            "row 0 of `face`, `v`: unexpected end of file\n");
}

TEST_F(FormatReadPly, RWithGAndBIsAColour) {
  const std::string xyz = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string rgb = "property uchar r\nproperty uchar g\nproperty uchar b\n";
  EXPECT_EQ(faults(header("ascii", xyz + rgb) + "1 2 3 255 0 0"),
            "`vertex` has no `radius`, and `r` is a colour because of `g` and `b`; add one, or set `radius` in "
            "[[points]]\n");
  const scene::Points points = read(header("ascii", xyz + rgb) + "1 2 3 255 0 0", 3, 0.5);
  EXPECT_EQ(points.radii[0], 0.5);
  EXPECT_EQ(points.unused, (std::vector<std::string>{"r", "g", "b"}));
  EXPECT_TRUE(read(header("ascii", xyz + "property float r\n") + "1 2 3 4").unused.empty());
}

TEST_F(FormatReadPly, TruncationInsideAVertex) {
  // With lists the length of a row is unknown, so the count alone does not reveal the truncation.
  const std::string elements = std::string("element vertex 2\nproperty list uchar float weights\n") + kXyzr;
  const std::string row = bytes_of<std::uint8_t>(2) + std::string(8, '\0') + std::string(16, '\0');
  EXPECT_EQ(faults(header("binary_little_endian", elements) + row + row.substr(0, 20)),
            "vertex 1 of 2, `z`: unexpected end of file\n");
}

TEST_F(FormatReadPly, AWordThatIsNotANumber) {
  EXPECT_EQ(faults(header("ascii", std::string("element vertex 2\n") + kXyzr) + "1 2 3 4\n1 2 three 4"),
            "10: vertex 1 of 2, `z`: `three` is not a number\n");
}

TEST_F(FormatReadPly, NonFiniteValuesAreCountedAndTenReported) {
  std::string data;
  for (int i = 0; i < 25; ++i)
    data += i == 3 ? "1 2 3 4\n" : i == 4 ? "1 inf 3 4\n" : i == 5 ? "1 2 3 1e999\n" : "nan 2 3 4\n";
  const std::string told = faults(header("ascii", std::string("element vertex 25\n") + kXyzr) + data);
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 11);
  EXPECT_NE(told.find("11: vertex 2 has a non-finite value\n13: vertex 4 has"), std::string::npos) << told;
  EXPECT_NE(told.find("and 14 more (24 in all)\n"), std::string::npos) << told;
}

TEST_F(FormatReadPly, AnErrorLeavesThePointsUnchanged) {
  support::write_bytes(folder_ / "a.ply",
                       header("ascii", std::string("element vertex 2\n") + kXyzr) + "1 2 3 4\n1 2 nan 4");
  scene::Points points;
  EXPECT_THROW(read_ply(folder_ / "a.ply", 1, points), base::Error);
  EXPECT_TRUE(points.centers.empty() && points.radii.empty());
}

TEST_F(FormatReadPly, MissingFileIsMissingInput) {
  scene::Points points;
  try {
    read_ply(folder_ / "none.ply", 1, points);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kMissingInput);
  }
}

}  // namespace
}  // namespace orrery::format
