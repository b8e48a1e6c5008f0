// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"

namespace orrery::data {

namespace {

using support::number_bytes;
using support::numbers;

/// Files that `gmx` has written, both from one simulation of ten molecules of water, and MDAnalysis. The Python tests
/// compare more of them with MDAnalysis.
std::filesystem::path corpus(const std::string& name) {
  return std::filesystem::path(ORRERY_ROOT) / "tests/fuzz/corpus/data" / name;
}

std::string bytes_of(const std::string& name) {
  std::ostringstream out;
  out << std::ifstream(corpus(name), std::ios::binary).rdbuf();
  return out.str();
}

/// Compares the compressed positions of a file with those of another one, which are not.
void expect_rounded(const std::string& compressed, const std::string& full, double precision) {
  const auto xtc = data::open(corpus(compressed)), trr = data::open(corpus(full));
  ASSERT_EQ(xtc->frame_count(), trr->frame_count());
  for (int frame = 0; frame < xtc->frame_count(); ++frame) {
    const Table a = xtc->read(frame, {"x", "y", "z"}), b = trr->read(frame, {"x", "y", "z"});
    for (const char* const axis : {"x", "y", "z"}) {
      const std::vector<double> rounded = numbers(a, axis), exact = numbers(b, axis);
      ASSERT_EQ(rounded.size(), exact.size());
      for (std::size_t i = 0; i < exact.size(); ++i) {
        const double error = precision / 2 + std::abs(exact[i]) * 1e-6;  // of single precision
        EXPECT_NEAR(rounded[i], exact[i], error) << axis << " of " << i << " in frame " << frame;
      }
    }
  }
}

class DataXtc : public support::DataFileTest {
 protected:
  DataXtc() : DataFileTest("a.xtc") {}
};

TEST_F(DataXtc, PositionsAreRoundedToThePrecision) {
  expect_rounded("xtc/water.xtc", "trr/water.trr", 0.01);
  expect_rounded("xtc/wide.xtc", "trr/wide.trr", 0.01);  // each coordinate takes more than 24 bits
}

TEST_F(DataXtc, FramesHaveTimeStepAndBox) {
  const auto file = data::open(corpus("xtc/water.xtc"));
  EXPECT_STREQ(file->format, "XTC");
  ASSERT_EQ(file->frame_count(), 3);
  const FrameInfo info = file->describe(2);
  EXPECT_EQ(info.rows, 30u);
  EXPECT_EQ(info.step, 200);
  ASSERT_EQ(info.header.size(), 1u);
  EXPECT_EQ(info.header[0].first, "time");
  EXPECT_NEAR(info.header[0].second, 0.4, 1e-6);
  EXPECT_NEAR(info.box->edges[0].x, 22, 1e-5);
  EXPECT_EQ(support::columns_text(info), "x:float32 y:float32 z:float32");
  EXPECT_EQ(file->read(2, {"z"}).columns.size(), 1u);
}

TEST_F(DataXtc, FewAtomsAreNotCompressed) {
  const auto file = data::open(corpus("xtc/few.xtc"));
  const Table table = support::read_table(*file);
  ASSERT_EQ(table.rows, 5u);
  for (const double x : numbers(table, "y")) EXPECT_TRUE(std::abs(x) > 0 && std::abs(x) < 20) << x;
}

TEST_F(DataXtc, DamageIsNamedWithTheFrame) {
  const std::string good = bytes_of("xtc/water.xtc");
  const std::string first = good.substr(0, good.size() / 3 / 4 * 4);
  const auto file = open(good.substr(0, good.size() - 8));
  ASSERT_EQ(file->frame_count(), 3);
  EXPECT_EQ(file->read(1, {"x"}).rows, 30u) << "frames before the damaged one are usable";
  try {
    file->read(2, {"x"});
    ADD_FAILURE();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_NE(error.diagnostics().at(0).text.find("frame 3: truncated"), std::string::npos);
    EXPECT_NE(error.diagnostics().at(0).remedy.find("1-2"), std::string::npos);
  }
  const auto changed = [&](std::size_t at, const std::string& bytes) {
    std::string out = good;
    return error_of(out.replace(at, bytes.size(), bytes)).text;
  };
  EXPECT_NE(error_of(good.substr(0, 40)).text.find("header"), std::string::npos);
  EXPECT_NE(changed(52, number_bytes(29, true)).find("numbers of atoms differ"), std::string::npos);
  EXPECT_NE(changed(56, number_bytes(-1.0F, true)).find("precision"), std::string::npos);
  EXPECT_NE(changed(56, number_bytes(NAN, true)).find("precision"), std::string::npos);
  EXPECT_NE(changed(16, number_bytes(NAN, true)).find("not finite"), std::string::npos) << "the box";
  EXPECT_NE(changed(60, number_bytes(1 << 30, true)).find("empty"), std::string::npos) << "the range";
  EXPECT_NE(changed(84, number_bytes(3, true)).find("damaged"), std::string::npos) << "bits of a difference";
  EXPECT_NE(changed(88, number_bytes(4, true)).find("30 atoms in 4 bytes"), std::string::npos);
  EXPECT_NE(changed(92, std::string(40, '\xff')).find("damaged"), std::string::npos);
}

TEST_F(DataXtc, TheFullPrecisionFormatHasVelocities) {
  const auto file = data::open(corpus("trr/water.trr"));
  EXPECT_STREQ(file->format, "TRR");
  ASSERT_EQ(file->frame_count(), 3);
  EXPECT_EQ(file->describe(1).step, 100);
  EXPECT_EQ(support::columns_text(file->describe(0)),
            "x:float32 y:float32 z:float32 velocity[1]:float32 velocity[2]:float32 velocity[3]:float32");
  // As written by gmx, in nm / ps.
  const auto text = data::open(corpus("gro/water.gro"));
  const std::vector<double> last = numbers(file->read(2, {"velocity[2]"}), "velocity[2]");
  const std::vector<double> rounded = numbers(text->read(0, {"velocity[2]"}), "velocity[2]");
  for (std::size_t i = 0; i < last.size(); ++i) EXPECT_NEAR(last[i], rounded[i], 0.0006);
}

TEST_F(DataXtc, ArraysOfTheFullPrecisionFormatFitTheNumberOfAtoms) {
  const std::string good = bytes_of("trr/water.trr");
  const auto changed = [&](std::size_t at, std::int32_t number) {
    return error_of(std::string(good).replace(at, 4, number_bytes(number, true))).text;
  };
  constexpr std::size_t kPositionBytes = 24 + 4 * 7, kAtoms = 24 + 4 * 10;
  EXPECT_NE(changed(kPositionBytes, 0).find("no positions"), std::string::npos);
  EXPECT_NE(changed(kPositionBytes, 356).find("356 bytes"), std::string::npos);
  EXPECT_NE(changed(kAtoms, 31).find("31 atoms"), std::string::npos);
  EXPECT_NE(error_of(good.substr(0, 60)).text.find("header"), std::string::npos);
  EXPECT_NE(error_of(good.substr(0, 300)).text.find("truncated"), std::string::npos);
}

}  // namespace

}  // namespace orrery::data
