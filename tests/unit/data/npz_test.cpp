// SPDX-License-Identifier: Apache-2.0
#include <archive.h>
#include <archive_entry.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/npy_bytes.h"

namespace orrery::data {

namespace {

using support::npy_bytes;
using support::number_bytes;
using support::numbers;
using support::sequence;

using Members = std::vector<std::pair<std::string, std::string>>;

/// A ZIP archive of members, each a name and its contents.
std::string zip(const Members& members, const char* compression) {
  std::string out(std::size_t{64} << 20, '\0');
  std::size_t used = 0;
  const std::unique_ptr<archive, decltype(&archive_write_free)> writer(archive_write_new(), &archive_write_free);
  archive_write_set_format_zip(writer.get());
  archive_write_set_options(writer.get(), (std::string("zip:compression=") + compression).c_str());
  archive_write_open_memory(writer.get(), out.data(), out.size(), &used);
  for (const auto& [name, bytes] : members) {
    const std::unique_ptr<archive_entry, decltype(&archive_entry_free)> entry(archive_entry_new(), &archive_entry_free);
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes.size()));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    EXPECT_EQ(archive_write_header(writer.get(), entry.get()), ARCHIVE_OK);
    EXPECT_EQ(archive_write_data(writer.get(), bytes.data(), bytes.size()), static_cast<la_ssize_t>(bytes.size()));
  }
  archive_write_close(writer.get());
  out.resize(used);
  return out;
}

const std::string kPositions = npy_bytes("'<f8'", false, "(2, 3)", sequence<double>({1, 2, 3, 4, 5, 6}));

class DataNpz : public testing::Test {
 protected:
  std::unique_ptr<DataFile> open(const Members& members, const char* compression = "deflate") {
    support::write_bytes(folder_ / "a.npz", zip(members, compression));
    return data::open(folder_ / "a.npz");
  }
  std::string faults(const Members& members) {
    support::write_bytes(folder_ / "a.npz", zip(members, "deflate"));
    return support::read_faults(folder_ / "a.npz");
  }
  support::TempDir folder_;
};

TEST_F(DataNpz, MembersAreColumns) {
  const Members members = {{"time.npy", npy_bytes("'<f8'", false, "()", number_bytes(0.5))},
                           {"type.npy", npy_bytes("'<i4'", false, "(2,)", sequence({3, 4}))},
                           {"positions.npy", kPositions},
                           {"box.npy", npy_bytes("'<f8'", false, "(3, 3)", std::string(72, '\0'))},
                           {"radius.npy", npy_bytes("'<f4'", false, "(2,)", sequence({0.5f, 0.25f}))},
                           {"v.npy", npy_bytes("'<f4'", true, "(2, 2)", sequence({1.f, 2.f, 3.f, 4.f}))},
                           {"meta.npy", npy_bytes("'|O'", false, "(2,)", "pickle")},
                           {"notes.txt", "hello"}};
  for (const char* compression : {"store", "deflate"}) {
    const auto file = open(members, compression);
    EXPECT_STREQ(file->format, "NPZ");
    const FrameInfo info = file->describe(0);
    EXPECT_EQ(info.rows, 2u);
    EXPECT_EQ(support::columns_text(info),
              "type:int32 x:float64 y:float64 z:float64 radius:float32 v[1]:float32 v[2]:float32");
    EXPECT_EQ(info.roles.radius, "radius");
    EXPECT_EQ(info.roles.type, "type");
    const Table table = support::read_table(*file);
    EXPECT_EQ(numbers(table, "y"), (std::vector<double>{2, 5}));
    EXPECT_EQ(numbers(table, "type"), (std::vector<double>{3, 4}));
    EXPECT_EQ(numbers(table, "v[2]"), (std::vector<double>{3, 4}));
    const Table some = file->read(0, {"radius", "z", "type"});
    ASSERT_EQ(some.columns.size(), 3u);
    EXPECT_EQ(some.columns[0].name, "radius");
    EXPECT_EQ(numbers(some, "z"), (std::vector<double>{3, 6}));
  }
}

TEST_F(DataNpz, CoordinatesInSeparateArraysOrInAStructuredArray) {
  const std::string one = npy_bytes("'<f8'", false, "(1,)", number_bytes(7.0));
  EXPECT_EQ(numbers(support::read_table(*open({{"x.npy", one}, {"y.npy", one}, {"z.npy", one}})), "z"),
            std::vector<double>{7});
  const Table table =
      support::read_table(*open({{"atoms.npy", npy_bytes("[('pos', '<f4', (3,)), ('id', '<i4')]", false, "(1,)",
                                                         sequence({1.f, 2.f, 3.f}) + number_bytes(9))}}));
  EXPECT_EQ(numbers(table, "id"), std::vector<double>{9});
  EXPECT_EQ(numbers(table, "y"), std::vector<double>{2});
}

TEST_F(DataNpz, AnArchiveIsRecognisedWithoutItsExtension) {
  support::write_bytes(folder_ / "snapshot.dat", zip({{"pos.npy", kPositions}}, "deflate"));
  EXPECT_STREQ(data::open(folder_ / "snapshot.dat")->format, "NPZ");
}

TEST_F(DataNpz, ASecondArrayOfPositionsHasNumberedColumns) {
  EXPECT_EQ(support::columns_text(open({{"pos.npy", kPositions}, {"xyz.npy", kPositions}})->describe(0)),
            "x:float64 y:float64 z:float64 xyz[1]:float64 xyz[2]:float64 xyz[3]:float64");
}

TEST_F(DataNpz, WithoutPositionsTheArraysAreListed) {
  EXPECT_TRUE(test::mentions(
      faults({{"a.npy", npy_bytes("'<f8'", false, "(1,)", number_bytes(7.0))},
              {"pos.npy", npy_bytes("'|O'", false, "(2, 3)", "pickle")},
              {"b.npy", npy_bytes("'<f4'", false, "(1, 2, 3)", "")},
              {"readme", "text"}}),
      {"1", "e.g", "astype('f8')", "1", "2", "3", "columns", "format", "`pos`", "3", "`x`", "`y`", "`z`"}));
  EXPECT_NE(faults({}), "");
  EXPECT_EQ(faults({{"pos.npy", kPositions}, {"pos.npy", kPositions}, {"pos.npy", kPositions}}),
            "duplicate column `pos[1]`\n");
}

TEST_F(DataNpz, ShapesBeyondTheDataAreRefused) {
  EXPECT_TRUE(test::mentions(faults({{"pos.npy", npy_bytes("'<f8'", false, "(2, 3)", std::string(40, '\0'))}}),
                             {"`pos`", "2", "3", "48", "bytes", "40", "header"}));
  EXPECT_TRUE(test::mentions(faults({{"pos.npy", npy_bytes("'<f8'", false, "(2, 3)", std::string(49, '\0'))}}),
                             {"`pos`", "2", "3", "48", "bytes", "header"}));
  EXPECT_TRUE(
      test::mentions(faults({{"pos.npy", npy_bytes("'<f8'", false, "(999999999999999999, 3)", std::string(40, '\0'))}}),
                     {"`pos`", "999999999999999999", "3", "16.0", "GiB"}));
  EXPECT_NE(faults({{"pos.npy", npy_bytes("'<f8'", false, "(400000000, 3)", std::string(40, '\0'))}}), "")
      << "below the limit: only what exists is read";
  EXPECT_EQ(support::columns_text(open({{"pos.npy", npy_bytes("'<f8'", false, "(0, 3)", "")},
                                        {"a.npy", npy_bytes("'<f8'", false, "(0, 1099511627776)", "")}})
                                      ->describe(0)),
            "x:float64 y:float64 z:float64")
      << "a declared width makes no columns";
}

TEST_F(DataNpz, ItemsWithoutBytesAreRefused) {
  const auto file = open({{"pos.npy", npy_bytes("'<f8'", false, "(1000000000000, 3)", "")},
                          {"name.npy", npy_bytes("'|S0'", false, "(1000000000000,)", "")}});
  EXPECT_THROW(file->read(0, {"name"}), base::Error);
}

TEST_F(DataNpz, AFileThatBecomesShorterIsAnIoError) {
  const auto file =
      open({{"pos.npy", kPositions}, {"a.npy", npy_bytes("'|u1'", false, "(3000000,)", std::string(3000000, 'a'))}},
           "store");
  std::filesystem::resize_file(folder_ / "a.npz", 100);
  try {
    file->read(0, {"x"});
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kIo);
  }
}

TEST_F(DataNpz, DecompressedDataAreLimited) {
  const std::string zeros = npy_bytes("'<f8'", false, "(100000, 3)", std::string(2400000, '\0'));
  support::write_bytes(folder_ / "a.npz", zip({{"pos.npy", zeros}, {"v.npy", zeros}}, "deflate"));
  OpenOptions options;
  options.decompressed_limit = 5000000;
  EXPECT_EQ(support::read_faults(folder_ / "a.npz", options), "");
  options.decompressed_limit = 2400000;
  EXPECT_NE(support::read_faults(folder_ / "a.npz", options).find("array `pos` with shape (100000, 3) exceeds"),
            std::string::npos)
      << "with its header";
  options.decompressed_limit = 4800000;
  EXPECT_NE(support::read_faults(folder_ / "a.npz", options).find("array `v` with shape (100000, 3) exceeds"),
            std::string::npos);
}

TEST_F(DataNpz, DamagedArchivesAreRefused) {
  std::string noise;
  std::uint32_t state = 1;
  for (int i = 0; i < 4800; ++i) noise += static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
  const std::string bytes = zip({{"pos.npy", npy_bytes("'<f8'", false, "(200, 3)", noise)}}, "deflate");
  for (const std::size_t size :
       {std::size_t{4}, std::size_t{20}, std::size_t{40}, std::size_t{200}, bytes.size() / 2}) {
    support::write_bytes(folder_ / "a.npz", bytes.substr(0, size));
    EXPECT_NE(support::read_faults(folder_ / "a.npz"), "") << size;
  }
  std::string flipped = bytes;
  flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 0x55);
  support::write_bytes(folder_ / "a.npz", flipped);
  EXPECT_NE(support::read_faults(folder_ / "a.npz").find("damaged ZIP archive"), std::string::npos) << "checksum";
}

}  // namespace
}  // namespace orrery::data
