// SPDX-License-Identifier: Apache-2.0
#include "data/write_table.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "support/data_tables.h"

namespace orrery::data {

namespace {

template <class T>
constexpr auto kMin = std::numeric_limits<T>::lowest();
template <class T>
constexpr auto kMax = std::numeric_limits<T>::max();

Words words(const std::vector<std::string>& texts) {
  Words out;
  for (const std::string& text : texts) {
    out.index.push_back(static_cast<std::uint32_t>(out.words.size()));
    out.words.push_back(text);
  }
  return out;
}

/// Four rows of extreme values of every type.
Table extremes() {
  constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
  Table table;
  table.rows = 4;
  table.columns = {
      {"x", std::vector<double>{kMin<double>, kMax<double>, std::numeric_limits<double>::denorm_min(), -0.0}},
      {"y", std::vector<double>{0.1, 1.0 / 3, kNan, 1e22}},
      {"z", std::vector<float>{0.1f, kMax<float>, std::numeric_limits<float>::denorm_min(), -0.f}},
      {"radius", std::vector<double>{kInf, -kInf, 5e-324, 1}},
      {"element", words({"C", "Ar", "He_1", "Na+"})},
      {"i32", std::vector<std::int32_t>{kMin<std::int32_t>, kMax<std::int32_t>, 0, -1}},
      {"u16", std::vector<std::uint16_t>{0, 65535, 1, 2}},
      {"u8", std::vector<std::uint8_t>{0, 255, 1, 2}},
      {"vel[1]", std::vector<float>{1, 2, 3, 4}},
      {"vel[2]", std::vector<float>{-1, -2, -3, -4}},
      {"small", std::vector<std::int64_t>{kMin<std::int32_t>, kMax<std::int32_t>, 0, 1}},
  };
  return table;
}

Column large_integers() {
  return {"id", std::vector<std::int64_t>{kMin<std::int64_t>, kMax<std::int64_t>, 9007199254740993, 0}};
}

/// Expects the same value in each row, also the sign of zero. Types may differ.
void expect_equal(const Table& written, const Table& read, const std::string& name, const std::string& read_name) {
  const Column& a = *written.find(name);
  ASSERT_NE(read.find(read_name), nullptr) << read_name;
  const Column& b = *read.find(read_name);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t row = 0; row < a.size(); ++row) {
    if (a.type() == ColumnType::kText) {
      EXPECT_EQ(support::texts(written, name)[row], support::texts(read, read_name)[row]) << name;
    } else if (a.type() == ColumnType::kInt64 && b.type() == ColumnType::kInt64) {
      EXPECT_EQ(std::get<std::vector<std::int64_t>>(a.values)[row], std::get<std::vector<std::int64_t>>(b.values)[row]);
    } else if (std::isnan(a.number(row))) {
      EXPECT_TRUE(std::isnan(b.number(row))) << name << " " << row;
    } else {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a.number(row)), std::bit_cast<std::uint64_t>(b.number(row)))
          << name << " " << row << ": " << a.number(row) << " " << b.number(row);
    }
  }
}

class DataWriteTable : public testing::Test {
 protected:
  Table round_trip(const Table& table, const std::string& name) {
    left_out_ = write_table(folder_ / name, table);
    return support::read_table(folder_ / name);
  }
  /// The message of an error.
  std::string refusal(const Table& table, const std::string& name, base::ErrorKind kind = base::ErrorKind::kUsage) {
    try {
      (void)write_table(folder_ / name, table);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), kind);
      EXPECT_EQ(folder_.count(), 0u) << "nothing is left behind";
      const std::string text = error.what();
      return text.substr(text.find("a."));
    }
    return "no error";
  }
  support::TempDir folder_;
  std::vector<std::string> left_out_;
};

TEST_F(DataWriteTable, NpyKeepsValuesTypesAndStrings) {
  Table table = extremes();
  table.columns.push_back(large_integers());
  table.columns.push_back({"it's a \\", words({"", "a, \"b\"", "\xC3\x85", " x\ny "})});
  const Table read = round_trip(table, "a.npy");
  ASSERT_EQ(read.columns.size(), table.columns.size());
  for (const Column& column : table.columns) {
    expect_equal(table, read, column.name, column.name);
    EXPECT_EQ(read.find(column.name)->type(), column.type()) << column.name;
  }
  EXPECT_TRUE(left_out_.empty());
}

TEST_F(DataWriteTable, PlyKeepsValuesAndTypesButNoStringsAndNoLargeIntegers) {
  Table table = extremes();
  table.columns.push_back(large_integers());
  table.columns.push_back({"unsigned", std::vector<std::int64_t>{0, 4294967295, 1, 2}});
  table.columns.push_back({"beyond", std::vector<std::int64_t>{0, 2147483648, 1, 2}});
  table.columns.push_back({"below", std::vector<std::int64_t>{-2147483649, 4294967296, 1, 2}});
  table.columns.push_back({"exact", std::vector<std::int64_t>{-9007199254740992, 9007199254740992, 1, 2}});
  const Table read = round_trip(table, "a.ply");
  EXPECT_EQ(left_out_, (std::vector<std::string>{"element", "id"}));
  ASSERT_EQ(read.columns.size(), table.columns.size() - 2);
  for (const Column& column : table.columns) {
    if (base::contains(left_out_, column.name)) continue;
    expect_equal(table, read, column.name, column.name);
    const ColumnType type = read.find(column.name)->type();
    EXPECT_TRUE(type == column.type() || column.type() == ColumnType::kInt64) << column.name;
  }
}

TEST_F(DataWriteTable, CsvKeepsValues) {
  Table table = extremes();
  table.columns.push_back(large_integers());
  table.columns.push_back({"a \"b\", c", words({"", "a, \"b\"", " x ", "1"})});
  table.columns.push_back({"digits", words({"1", "2", "3", "4"})});
  const Table read = round_trip(table, "a.csv");
  ASSERT_EQ(read.columns.size(), table.columns.size());
  for (const Column& column : table.columns) expect_equal(table, read, column.name, column.name);
}

TEST_F(DataWriteTable, XyzKeepsValues) {
  Table table = extremes();
  table.columns.push_back(large_integers());
  table.columns.push_back({"a b", std::vector<double>{1, 2, 3, 4}});
  table.columns.push_back({"a:b", std::vector<double>{5, 6, 7, 8}});
  (void)write_table(folder_ / "a.xyz", table);
  const std::string text = support::file_bytes(folder_ / "a.xyz");
  EXPECT_EQ(
      text.substr(0, text.find('\n', 3)),
      "4\nProperties=species:S:1:pos:R:3:radius:R:1:i32:I:1:u16:I:1:u8:I:1:vel:R:2:small:I:1:id:I:1:a_b:R:1:a_b_:R:1");
  const Table read = support::read_table(folder_ / "a.xyz");
  ASSERT_EQ(read.columns.size(), table.columns.size());
  for (const Column& column : table.columns) {
    const std::string& name = column.name;
    expect_equal(table, read, name,
                 name == "element" ? "species"
                 : name == "a b"   ? "a_b"
                 : name == "a:b"   ? "a_b_"
                                   : name);
  }
}

TEST_F(DataWriteTable, XyzHasBoxAndStep) {
  Table table;
  table.rows = 1;
  for (const char* name : {"x", "y", "z"}) table.columns.push_back({name, std::vector<double>{0.1}});
  FrameHeader header;
  header.box = Box{{-1, 0.1, 2}, {Vec3d{4, 0, 0}, Vec3d{1, 5, 0}, Vec3d{0.3, 0, 6}}, {true, false, true}};
  header.step = 250;
  (void)write_table(folder_ / "a.xyz", table, header);
  const FrameInfo info = open(folder_ / "a.xyz")->describe(0);
  ASSERT_TRUE(info.box);
  EXPECT_EQ(info.box->origin, header.box->origin);
  EXPECT_EQ(info.box->edges, header.box->edges);
  EXPECT_EQ(info.box->periodic, header.box->periodic);
  EXPECT_EQ(info.step, 250);
}

TEST_F(DataWriteTable, ANameThatIsPossibleStaysThoughAnotherBecomesLikeIt) {
  Table table{1, {}};
  for (const char* name : {"x", "y", "z"}) table.columns.push_back({name, std::vector<double>{0}});
  table.columns.push_back({"q q", std::vector<double>{1}});
  table.columns.push_back({"q_q", std::vector<double>{2}});
  for (const char* file : {"a.xyz", "a.ply"}) {
    const Table read = round_trip(table, file);
    EXPECT_EQ(read.find("q_q")->number(0), 2) << file;
    EXPECT_EQ(read.find("q_q_")->number(0), 1) << file;
  }
}

/// As other programs write them.
TEST_F(DataWriteTable, XyzHasColorsOfOneProperty) {
  Table table{2, {}};
  for (const char* name : {"x", "y", "z"}) table.columns.push_back({name, std::vector<double>{1, 2}});
  const std::vector<std::uint8_t> bytes[] = {{255, 0}, {0, 51}, {102, 1}};
  for (std::size_t i = 0; i < 3; ++i) table.columns.push_back({std::array{"red", "green", "blue"}[i], bytes[i]});
  (void)write_table(folder_ / "a.xyz", table);
  EXPECT_EQ(support::file_bytes(folder_ / "a.xyz").substr(0, 61),
            "2\nProperties=pos:R:3:color:R:3\n1 1 1 1 0 0.4\n2 2 2 0 0.2 0.00");
  const std::unique_ptr<DataFile> file = open(folder_ / "a.xyz");
  const Roles roles = file->describe(0).roles;
  EXPECT_EQ(roles.rgb_maximum, 1);
  const Table read = file->read(0, {roles.rgb[0], roles.rgb[2]});
  EXPECT_EQ(read.columns[0].number(0), 1);
  EXPECT_EQ(std::lround(255 * read.columns[1].number(1)), 1);
}

TEST_F(DataWriteTable, XyzOmitsStringsWithSpacesAndEmptyStrings) {
  const Table table = extremes();
  for (const char* text : {"a b", "", "a\n", "\""}) {
    Table with_text = table;
    with_text.columns.push_back({"t[1]", words({"a", "b", "c", "d"})});
    with_text.columns.push_back({"t[2]", words({"a", text, "b", "c"})});
    EXPECT_EQ(write_table(folder_ / "a.xyz", with_text), std::vector<std::string>{"t[2]"}) << text;
    const Table read = support::read_table(folder_ / "a.xyz");
    EXPECT_EQ(read.columns.size(), table.columns.size() + 1);
    EXPECT_EQ(support::texts(read, "t_1_"), (std::vector<std::string>{"a", "b", "c", "d"}));
    with_text = table;
    with_text.columns[4] = {"element", words({"a", text, "b", "c"})};
    EXPECT_EQ(write_table(folder_ / "a.xyz", with_text), std::vector<std::string>{"element"}) << text;
  }
}

TEST_F(DataWriteTable, ManyRows) {
  Table table;
  table.rows = 100000;  // several buffers
  for (const char* name : {"x", "y", "z"}) {
    std::vector<double> values;
    for (std::size_t i = 0; i < table.rows; ++i) values.push_back(static_cast<double>(i) / 7 + (name[0] - 'x'));
    table.columns.push_back({name, std::move(values)});
  }
  for (const char* file : {"a.ply", "a.npy", "a.csv", "a.xyz"}) {
    const Table read = round_trip(table, file);
    for (const char* name : {"x", "y", "z"})
      EXPECT_EQ(support::numbers(read, name), support::numbers(table, name)) << file;
  }
}

TEST_F(DataWriteTable, NoRows) {
  Table table;
  for (const char* name : {"x", "y", "z"}) table.columns.push_back({name, std::vector<double>()});
  table.columns.push_back({"element", Words()});
  table.columns.push_back({"id", std::vector<std::int64_t>()});
  for (const char* file : {"a.ply", "a.npy", "a.csv", "a.xyz"}) EXPECT_EQ(round_trip(table, file).rows, 0u) << file;
}

TEST_F(DataWriteTable, ValuesThatAFormatCannotStoreAreRefused) {
  Table table = extremes();
  EXPECT_EQ(refusal(table, "a.vtp"), "a.vtp: unknown extension `.vtp`; use .ply, .xyz, .npy or .csv");
  table.columns.push_back(large_integers());
  table.columns.push_back({"t", words({"a b", "", "\n", "c"})});
  EXPECT_EQ(refusal(table, "a.csv"),
            "a.csv: CSV cannot store the text `\n` of column `t`; write .npy, or leave the column out");
  table.columns.back() = {"t", words({"a", std::string("b\0", 2), "c", "d"})};
  EXPECT_NE(refusal(table, "a.npy").find("zero byte"), std::string::npos);
  EXPECT_NE(refusal(extremes(), "none/a.npy", base::ErrorKind::kCannotCreate), "no error");
}

}  // namespace
}  // namespace orrery::data
