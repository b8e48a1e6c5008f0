// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::texts;
using support::values;
// Codes of value types.
constexpr int kUint8 = 1, kUint32 = 3, kUint64 = 4, kInt8 = 5, kInt32 = 7, kFloat = 9;

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Writes GSD files.
class GsdWriter {
 public:
  template <typename T>
  void add(std::uint64_t frame, const std::string& name, int type, std::uint64_t rows, const std::vector<T>& values) {
    add_entry(frame, name, type, rows, static_cast<std::uint32_t>(values.size() / rows), bytes_of(values));
  }
  void add_entry(std::uint64_t frame, const std::string& name, int type, std::uint64_t rows, std::uint32_t components,
                 const std::string& bytes) {
    const auto id = static_cast<std::uint16_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
    if (id == names_.size()) names_.push_back(name);
    put<std::uint64_t>(index_, frame);
    put<std::uint64_t>(index_, rows);
    put<std::uint64_t>(index_, 256 + data_.size());
    put<std::uint32_t>(index_, components);
    put<std::uint16_t>(index_, id);
    put<std::uint8_t>(index_, static_cast<std::uint8_t>(type));
    put<std::uint8_t>(index_, 0);
    data_ += bytes;
  }

  /// The file: header, data, names, index with an unused entry.
  std::string file(unsigned version, const std::string& schema = "hoomd") const {
    std::string names;
    for (const std::string& name : names_) {
      names += name + '\0';
      if (version == 1) names.resize((names.size() + 63) / 64 * 64);
    }
    names.resize((names.size() + 64) / 64 * 64);
    std::string out;
    put<std::uint64_t>(out, 0x65DF65DF65DF65DFULL);
    put<std::uint64_t>(out, 256 + data_.size() + names.size());
    put<std::uint64_t>(out, index_.size() / 32 + 1);
    put<std::uint64_t>(out, 256 + data_.size());
    put<std::uint64_t>(out, names.size() / 64);
    put<std::uint32_t>(out, 1U << 16 | 4);
    put<std::uint32_t>(out, version << 16);
    out.resize(48 + 64);
    out += schema;
    out.resize(256);
    return out + data_ + names + index_ + std::string(32, '\0');
  }

 private:
  template <typename T>
  static void put(std::string& out, T value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  std::string data_, index_;
  std::vector<std::string> names_;
};

/// Two particles in frame 0; frame 1 has other positions only; three particles in frame 2.
GsdWriter three_frames() {
  GsdWriter gsd;
  gsd.add<std::uint64_t>(0, "configuration/step", kUint64, 1, {100});
  gsd.add<float>(0, "configuration/box", kFloat, 6, {4, 6, 8, 0.5F, 0, 0.25F});
  gsd.add<std::uint32_t>(0, "particles/N", kUint32, 1, {2});
  gsd.add<char>(0, "particles/types", kInt8, 2, {'A', '\0', '\0', '\0', 'B', 'i', 'g', '\0'});
  gsd.add<std::uint32_t>(0, "particles/typeid", kUint32, 2, {1, 0});
  gsd.add<float>(0, "particles/diameter", kFloat, 2, {3, 0.5F});
  gsd.add<float>(0, "particles/position", kFloat, 2, {1, 2, 3, -1, -2, -3});
  gsd.add<std::int32_t>(0, "particles/image", kInt32, 2, {0, 1, -1, 2, 0, 0});
  gsd.add<std::uint64_t>(1, "configuration/step", kUint64, 1, {200});
  gsd.add<float>(1, "particles/position", kFloat, 2, {5, 6, 7, 8, 9, 10});
  gsd.add<std::uint32_t>(2, "particles/N", kUint32, 1, {3});
  gsd.add<float>(2, "particles/position", kFloat, 3, {0, 0, 1, 0, 0, 2, 0, 0, 3});
  gsd.add<float>(2, "particles/velocity", kFloat, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  return gsd;
}

class DataGsd : public testing::Test {
 protected:
  std::unique_ptr<DataFile> opened(const std::string& bytes) {
    support::write_bytes(folder_ / "a.gsd", bytes);
    return data::open(folder_ / "a.gsd");
  }
  /// The text of the first error on reading frame 0, or nothing.
  std::string error_of(const std::string& bytes) {
    try {
      const auto file = opened(bytes);
      file->describe(0);
      file->read(0, {"x", "type"});
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      return error.diagnostics().at(0).text;
    }
    return {};
  }

  support::TempDir folder_;
};

TEST_F(DataGsd, FrameHasItsOwnChunks) {
  for (const unsigned version : {1U, 2U}) {
    const auto file = opened(three_frames().file(version));
    EXPECT_STREQ(file->format, "GSD");
    EXPECT_EQ(file->frame_count(), 3);
    const Table table = file->read(0, {"x", "z", "diameter", "type", "image[2]"});
    EXPECT_EQ(table.rows, 2U);
    EXPECT_EQ(values<float>(table, "x"), (std::vector<float>{1, -1}));
    EXPECT_EQ(values<float>(table, "z"), (std::vector<float>{3, -3}));
    EXPECT_EQ(values<float>(table, "diameter"), (std::vector<float>{3, 0.5F}));
    EXPECT_EQ(values<std::int32_t>(table, "image[2]"), (std::vector<std::int32_t>{1, 0}));
    EXPECT_EQ(texts(table, "type"), (std::vector<std::string>{"Big", "A"}));
    EXPECT_EQ(std::get<Words>(table.find("type")->values).words, (std::vector<std::string>{"Big", "A"}));
  }
}

TEST_F(DataGsd, AbsentChunksAreThoseOfFrameZeroIfItHasAsManyParticles) {
  const auto file = opened(three_frames().file(2));
  const Table same = file->read(1, {"y", "diameter", "type"});
  EXPECT_EQ(values<float>(same, "y"), (std::vector<float>{6, 9}));
  EXPECT_EQ(values<float>(same, "diameter"), (std::vector<float>{3, 0.5F}));
  EXPECT_EQ(texts(same, "type"), (std::vector<std::string>{"Big", "A"}));
  const Table other = file->read(2, {"diameter", "type", "velocity[3]"});
  EXPECT_EQ(values<float>(other, "diameter"), (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(texts(other, "type"), (std::vector<std::string>{"A", "A", "A"}));
  EXPECT_EQ(values<float>(other, "velocity[3]"), (std::vector<float>{3, 6, 9}));
}

TEST_F(DataGsd, DescribesColumnsRolesAndBox) {
  const auto file = opened(three_frames().file(2));
  const FrameInfo first = file->describe(0);
  std::vector<std::string> names;
  for (const ColumnInfo& column : first.columns) names.push_back(column.name);
  EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "diameter", "type", "image[1]", "image[2]", "image[3]"}));
  EXPECT_EQ(first.roles.radius, "diameter");
  EXPECT_EQ(first.roles.radius_scale, 0.5);
  EXPECT_EQ(first.roles.image[2], "image[3]");
  EXPECT_EQ(first.step, 100);
  EXPECT_EQ(file->describe(1).step, 200);
  EXPECT_EQ(file->describe(2).step, 100);
  ASSERT_TRUE(first.box);
  EXPECT_EQ(first.box->edges[1], (Vec3d{3, 6, 0}));
  EXPECT_EQ(first.box->edges[2], (Vec3d{0, 2, 8}));
  EXPECT_EQ(first.box->origin, (Vec3d{-3.5, -4, -4}));
  EXPECT_EQ(file->describe(2).rows, 3U);
  EXPECT_EQ(file->describe(2).roles.image[0], "");
}

TEST_F(DataGsd, FlatBoxIsNotPeriodicInZ) {
  GsdWriter gsd;
  gsd.add<float>(0, "configuration/box", kFloat, 6, {4, 6, 0, 0, 0, 0});
  gsd.add<std::uint8_t>(0, "configuration/dimensions", kUint8, 1, {2});
  const auto box = opened(gsd.file(2))->describe(0).box;
  ASSERT_TRUE(box);
  EXPECT_EQ(box->periodic, (std::array<bool, 3>{true, true, false}));
  EXPECT_EQ(box->edges[2], (Vec3d{0, 0, 1}));
}

TEST_F(DataGsd, FrameWithoutParticlesHasNoRows) {
  GsdWriter gsd;
  gsd.add<std::uint64_t>(0, "configuration/step", kUint64, 1, {1});
  const Table table = opened(gsd.file(2))->read(0, {"x", "y", "z", "diameter", "type"});
  EXPECT_EQ(table.rows, 0U);
  ASSERT_EQ(table.columns.size(), 5U);
  for (const Column& column : table.columns) EXPECT_EQ(column.size(), 0U) << column.name;
}

TEST_F(DataGsd, DamagedFilesAreRefused) {
  const std::string good = three_frames().file(2);
  EXPECT_EQ(error_of(good), "");
  EXPECT_NE(error_of(good.substr(0, 200)).find("header"), std::string::npos);
  EXPECT_NE(error_of(good.substr(0, good.size() - 1)).find("index"), std::string::npos);
  EXPECT_NE(error_of(three_frames().file(3)).find("version 3"), std::string::npos);
  EXPECT_NE(error_of(three_frames().file(2, "mine")).find("`mine`"), std::string::npos);
  // Numbers of the header: list of names, index.
  for (const std::size_t at : {8U, 16U, 24U, 32U}) {
    std::string bad = good;
    bad.replace(at, 8, 8, '\xff');
    EXPECT_NE(error_of(bad).find("truncated"), std::string::npos) << at;
  }
}

TEST_F(DataGsd, IndexEntriesBeyondTheFileAreRefused) {
  const auto one = [this](const char* name, int type, std::uint64_t rows, std::uint32_t components, std::size_t size) {
    GsdWriter gsd;
    gsd.add<std::uint32_t>(0, "particles/N", kUint32, 1, {2});
    if (name != std::string("particles/position"))
      gsd.add<float>(0, "particles/position", kFloat, 2, {1, 2, 3, 4, 5, 6});
    gsd.add_entry(0, name, type, rows, components, std::string(size, '\1'));
    return error_of(gsd.file(2));
  };
  EXPECT_NE(one("particles/position", kFloat, 1000, 3, 12).find("beyond the end"), std::string::npos);
  EXPECT_NE(one("particles/position", kFloat, 1ULL << 61, 4, 12).find("beyond the end"), std::string::npos);
  EXPECT_NE(one("particles/position", kFloat, 1, 3, 12).find("2 particles, but 1 positions"), std::string::npos);
  EXPECT_NE(one("particles/position", kFloat, 2, 2, 16).find("instead of 2 rows of 3"), std::string::npos);
  EXPECT_NE(one("particles/diameter", 77, 2, 1, 8).find("value type 77"), std::string::npos);
  EXPECT_NE(one("particles/diameter", kFloat, 2, 0, 8).find("no components"), std::string::npos);
  EXPECT_NE(one("particles/types", kFloat, 1, 1, 4).find("not text"), std::string::npos);
  EXPECT_NE(one("particles/typeid", kUint8, 2, 1, 2).find("type without a name"), std::string::npos);
  EXPECT_NE(one("configuration/box", kFloat, 5, 1, 20).find("5 values instead of 6"), std::string::npos);
}

TEST_F(DataGsd, FramesOutOfOrderAreRefused) {
  GsdWriter gsd;
  gsd.add<std::uint64_t>(1, "configuration/step", kUint64, 1, {1});
  gsd.add<std::uint64_t>(0, "configuration/step", kUint64, 1, {1});
  EXPECT_NE(error_of(gsd.file(2)).find("out of order"), std::string::npos);
  GsdWriter far;
  far.add<std::uint64_t>(1ULL << 40, "configuration/step", kUint64, 1, {1});
  EXPECT_NE(error_of(far.file(2)).find("out of range"), std::string::npos);
}

TEST_F(DataGsd, PositionsMustBackTheNumberOfParticles) {
  GsdWriter gsd;
  gsd.add<std::uint32_t>(0, "particles/N", kUint32, 1, {4000000000U});
  EXPECT_NE(error_of(gsd.file(2)).find("4000000000 particles, but 0 positions"), std::string::npos);
}

GsdWriter with_bonds(const std::vector<std::uint32_t>& ends, std::uint32_t count) {
  GsdWriter gsd;
  gsd.add<std::uint32_t>(0, "particles/N", kUint32, 1, {2});
  gsd.add<float>(0, "particles/position", kFloat, 2, {1, 2, 3, -1, -2, -3});
  gsd.add<std::uint32_t>(0, "bonds/N", kUint32, 1, {count});
  gsd.add<std::uint32_t>(0, "bonds/group", kUint32, ends.size() / 2, ends);
  return gsd;
}

TEST_F(DataGsd, BondsOfFrameZeroHoldForLaterFrames) {
  GsdWriter gsd;
  gsd.add<std::uint32_t>(0, "particles/N", kUint32, 1, {3});
  gsd.add<float>(0, "particles/position", kFloat, 3, {0, 0, 1, 0, 0, 2, 0, 0, 3});
  gsd.add<std::uint32_t>(0, "bonds/N", kUint32, 1, {2});
  gsd.add<std::uint32_t>(0, "bonds/group", kUint32, 2, {2, 1, 1, 2});
  gsd.add<float>(1, "particles/position", kFloat, 3, {0, 0, 1, 0, 0, 2, 0, 0, 4});
  gsd.add<std::uint32_t>(2, "bonds/N", kUint32, 1, {1});
  gsd.add<std::uint32_t>(2, "bonds/group", kUint32, 1, {0, 1});
  gsd.add<std::uint32_t>(3, "bonds/N", kUint32, 1, {0});
  const auto file = opened(gsd.file(2));
  EXPECT_EQ(file->describe(0).bonds, 2u);
  EXPECT_EQ(support::bonds_text(*file, 0), "1-2");
  EXPECT_EQ(support::bonds_text(*file, 1), "1-2");
  EXPECT_EQ(support::bonds_text(*file, 2), "0-1");
  EXPECT_EQ(file->describe(3).bonds, 0u);
  EXPECT_TRUE(file->describe(3).has_bonds) << "all have broken";
  EXPECT_EQ(support::bonds_text(*file, 3), "");
}

TEST_F(DataGsd, BadBondsAreRefusedWithTheirIndex) {
  EXPECT_EQ(
      support::bond_faults(*opened(with_bonds({0, 1, 0, 2, 1, 1}, 3).file(2))),
      "0: frame 1: bond 1 has the particle 2; there are 2, counted from 0\n0: frame 1: bond 2 joins particle 1 to "
      "itself\n0: the bonds of this file are damaged\n");
  EXPECT_TRUE(test::mentions(error_of(with_bonds({0, 1}, 2).file(2)),
                             {"frame", "1", "`bonds/N`", "2", "`bonds/group`", "1", "rows", "2"}));
}

}  // namespace
}  // namespace orrery::data
