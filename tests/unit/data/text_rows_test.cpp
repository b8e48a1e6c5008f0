// SPDX-License-Identifier: Apache-2.0
#include "data/text_rows.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include "base/error.h"
#include "data/byte_source.h"
#include "data/faults.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::data {
namespace {

constexpr ColumnType kNumber = ColumnType::kFloat64, kInteger = ColumnType::kInt64, kText = ColumnType::kText;

/// A text file, and the table in it.
class DataTextRows : public testing::Test {
 protected:
  TextTable read(const std::string& text, TextLayout layout) {
    support::write_bytes(folder_ / "a.txt", text);
    const auto bytes = ByteSource::open(folder_ / "a.txt", 1 << 24);
    Faults faults(bytes->file());
    return read_text_rows(*bytes, layout, faults);
  }

  /// The diagnostics, one per line; empty if there are none.
  std::string errors(const std::string& text, const TextLayout& layout) {
    try {
      read(text, layout);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      std::string all;
      for (const auto& d : error.diagnostics()) all += std::to_string(d.line) + ": " + d.text + "\n";
      return all;
    }
    return {};
  }

  /// All columns are wanted.
  static TextLayout layout(const std::vector<ColumnType>& types, std::uint64_t rows = kRowsToEnd) {
    TextLayout out;
    for (const ColumnType type : types) {
      out.wanted.push_back(std::to_string(out.columns.size()));
      out.columns.push_back({out.wanted.back(), type});
    }
    out.rows = rows;
    return out;
  }

  support::TempDir folder_;
};

const std::vector<double>& numbers(const TextTable& table, std::size_t column) {
  return std::get<std::vector<double>>(table.table.columns[column].values);
}
const std::vector<std::int64_t>& integers(const TextTable& table, std::size_t column) {
  return std::get<std::vector<std::int64_t>>(table.table.columns[column].values);
}

/// The strings of a column.
std::vector<std::string> words(const TextTable& table, std::size_t column) {
  const Words& all = std::get<Words>(table.table.columns[column].values);
  std::vector<std::string> out;
  for (const std::uint32_t index : all.index) out.push_back(all.words[index]);
  return out;
}

TEST_F(DataTextRows, ReadsTheColumnsThatAreWanted) {
  TextLayout rows = layout({kInteger, kText, kNumber, kNumber});
  rows.wanted = {"1", "2", "0"};
  const TextTable table = read("1 Na 2.5 x\n-7\tCl  1e3 y\r\n", rows);
  EXPECT_EQ(table.table.rows, 2u);
  EXPECT_EQ(words(table, 0), (std::vector<std::string>{"Na", "Cl"}));
  EXPECT_EQ(numbers(table, 1), (std::vector<double>{2.5, 1000}));
  EXPECT_EQ(integers(table, 2), (std::vector<std::int64_t>{1, -7}));
  EXPECT_EQ(table.table.columns.size(), 3u);
  EXPECT_EQ(table.table.columns[2].name, "0");
}

TEST_F(DataTextRows, StopsAfterTheLastRow) {
  TextLayout rows = layout({kNumber}, 2);
  rows.begin = 5;
  const TextTable table = read("head\n1\n2\n3\n", rows);
  EXPECT_EQ(numbers(table, 0), (std::vector<double>{1, 2}));
  EXPECT_EQ(table.end, 9u);
  rows.rows = 0;
  EXPECT_EQ(read("head\n1\n", rows).end, 5u);
  rows.rows = kRowsToEnd;
  EXPECT_EQ(read("head\n1\n2", rows).end, 8u);
}

TEST_F(DataTextRows, LastLineMayLackItsEnd) {
  EXPECT_EQ(numbers(read("1\n2", layout({kNumber}, 2)), 0), (std::vector<double>{1, 2}));
  EXPECT_EQ(numbers(read("1\n2\r", layout({kNumber})), 0), (std::vector<double>{1, 2}));
}

TEST_F(DataTextRows, SkipsBlankLinesOnlyIfTheNumberOfRowsIsNotKnown) {
  const std::string text = "\n1\n \t\r\n2\n\n";
  EXPECT_EQ(numbers(read(text, layout({kNumber})), 0), (std::vector<double>{1, 2}));
  EXPECT_TRUE(test::mentions(errors(text, layout({kNumber}, 3)), {"1", "0", "1", "0", "1"}));
}

TEST_F(DataTextRows, ErrorsHaveLines) {
  TextLayout rows = layout({kInteger, kNumber});
  rows.first_line = 10;
  EXPECT_TRUE(test::mentions(
      errors("1 2\n1\n1 2 3\nx 2\n1 2y\n1.5 2\n9223372036854775808 0\n-9223372036854775808 0\n", rows),
      {"11", "1", "2", "column", "1", "x", "integer", "column", "2", "2y", "number", "column", "1", "1.5"}));
  rows.rows = 3;
  EXPECT_TRUE(test::mentions(errors("1 2\n1 2", rows), {"12", "ends", "2", "3", "rows"}));
}

TEST_F(DataTextRows, RowsMayHaveMoreValuesIfAllowed) {
  TextLayout rows = layout({kNumber});
  rows.allows_more = true;
  EXPECT_EQ(numbers(read("1 x y\n2\n", rows), 0), (std::vector<double>{1, 2}));
  rows.separator = ',';
  EXPECT_EQ(numbers(read("1,x,y\n2\n", rows), 0), (std::vector<double>{1, 2}));
}

/// They end words, and messages print them as \x00.
TEST_F(DataTextRows, ControlCharactersAreInTheMessage) {
  const std::string nul(1, '\0');
  EXPECT_EQ(errors("1 " + nul + "2\n1 2" + nul + "\n", layout({kNumber, kNumber})),
            "1: column 2: '" + nul + "' is not a number\n2: column 2: '2" + nul + "' is not a number\n");
}

TEST_F(DataTextRows, CommentsMayFollowTheValues) {
  TextLayout rows = layout({kNumber, kNumber});
  rows.comment = '#';
  EXPECT_EQ(numbers(read("1 2 # x y\n6 7 #\n8 9\n", rows), 1), (std::vector<double>{2, 7, 9}));
  EXPECT_TRUE(test::mentions(errors("1 2 3 # x\n1 # x\n", rows), {"1", "2", "column", "2", "#", "number"}));
}

TEST_F(DataTextRows, MemoryIsNotReservedForRowsThatCannotBeThere) {
  EXPECT_TRUE(test::mentions(errors("1 2\n", layout({kNumber, kNumber}, kRowsToEnd - 1)),
                             {"2", "ends", "1", "18446744073709551614", "rows"}));
}

TEST_F(DataTextRows, SeparatedValuesMayBeQuotedAndMissing) {
  TextLayout rows = layout({kText, kNumber, kText});
  rows.separator = ',';
  rows.allows_missing = true;
  const TextTable table = read("\"a, \"\"b\"\"\" , 1.5 ,x y \n,\"2\",\r\nz,,\"\"\n", rows);
  EXPECT_EQ(words(table, 0), (std::vector<std::string>{"a, \"b\"", "", "z"}));
  EXPECT_EQ(words(table, 2), (std::vector<std::string>{"x y", "", ""}));
  EXPECT_EQ(numbers(table, 1)[0], 1.5);
  EXPECT_EQ(numbers(table, 1)[1], 2);
  EXPECT_TRUE(std::isnan(numbers(table, 1)[2]));
  rows.allows_missing = false;
  EXPECT_TRUE(test::mentions(
      errors("a,,b\na,1\n\"a,1,b\n\"a\"b,1,c\na,1,b,\n", rows),
      {"1", "column", "2", "number", "2", "3", "column", "1", "quoted", "end", "line", "column", "1", "string"}));
}

TEST_F(DataTextRows, TabsSeparateIfTheyAreTheSeparator) {
  TextLayout rows = layout({kText, kText});
  rows.separator = '\t';
  const TextTable table = read("a b\tc\n\td\n", rows);
  EXPECT_EQ(words(table, 0), (std::vector<std::string>{"a b", ""}));
  EXPECT_EQ(words(table, 1), (std::vector<std::string>{"c", "d"}));
}

TEST_F(DataTextRows, RefusesEndlessLines) {
  EXPECT_TRUE(test::mentions(errors(std::string(3 << 20, '1'), layout({kNumber})), {"0", "line", "1", "MiB"}));
}

/// A table with all types, both line ends, blank lines and lines of many lengths.
std::string mixed_table(std::mt19937& random, std::size_t rows) {
  std::string text;
  for (std::size_t row = 0; row < rows; ++row) {
    text += std::to_string(random()) + std::string(random() % 4 + 1, ' ');
    text += "w" + std::to_string(random() % 20) + " ";
    text += std::to_string(std::ldexp(static_cast<double>(random()), -static_cast<int>(random() % 40)));
    text += random() % 3 == 0 ? "\r\n" : "\n";
    if (random() % 5 == 0) text += " \n";
  }
  return text;
}

TEST_F(DataTextRows, ResultDoesNotDependOnChunksAndThreads) {
  std::mt19937 random(7);
  const std::string text = mixed_table(random, 100);
  TextLayout rows = layout({kInteger, kText, kNumber});
  const TextTable expected = read(text, rows);
  ASSERT_EQ(expected.table.rows, 100u);
  for (const int threads : {1, 2}) {
    tbb::task_arena arena(threads);
    for (std::uint64_t chunk = 1; chunk < 100; ++chunk) {
      rows.chunk_bytes = chunk;
      const TextTable table = arena.execute([&] { return read(text, rows); });
      ASSERT_EQ(table.table.rows, expected.table.rows);
      ASSERT_EQ(table.end, expected.end);
      ASSERT_EQ(integers(table, 0), integers(expected, 0));
      ASSERT_EQ(words(table, 1), words(expected, 1));
      ASSERT_EQ(std::get<Words>(table.table.columns[1].values).words,
                std::get<Words>(expected.table.columns[1].values).words);
      ASSERT_EQ(numbers(table, 2), numbers(expected, 2));
    }
  }
}

TEST_F(DataTextRows, ErrorsDoNotDependOnChunksAndThreads) {
  std::mt19937 random(8);
  std::string text;
  for (int row = 0; row < 200; ++row) text += random() % 4 == 0 ? "1 x\n" : random() % 4 == 0 ? "\n" : "1 2\n";
  TextLayout rows = layout({kInteger, kNumber});
  const std::string expected = errors(text, rows);
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 11);  // ten, and how many there are
  for (const std::uint64_t chunk : {1, 3, 10, 50, 333}) {
    rows.chunk_bytes = chunk;
    EXPECT_EQ(tbb::task_arena(2).execute([&] { return errors(text, rows); }), expected) << chunk;
  }
}

}  // namespace
}  // namespace orrery::data
