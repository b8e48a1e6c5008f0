// SPDX-License-Identifier: Apache-2.0
#include "data/text_rows.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::data {
namespace {

constexpr TextColumn kNumber{ColumnType::kFloat64, true};
constexpr TextColumn kInteger{ColumnType::kInt64, true};
constexpr TextColumn kText{ColumnType::kText, true};

/// A text file, and the table in it.
class DataTextRows : public testing::Test {
 protected:
  TextTable read(const std::string& text, TextLayout layout) {
    support::write_bytes(folder_ / "a.txt", text);
    const auto bytes = ByteSource::open(folder_ / "a.txt", 1 << 20);
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

  static TextLayout layout(std::vector<TextColumn> columns, std::uint64_t rows = kRowsToEnd) {
    TextLayout out;
    out.columns = std::move(columns);
    out.rows = rows;
    return out;
  }

  support::TempDir folder_;
};

const std::vector<double>& numbers(const TextTable& table, std::size_t column) {
  return std::get<std::vector<double>>(table.values[column]);
}
const std::vector<std::int64_t>& integers(const TextTable& table, std::size_t column) {
  return std::get<std::vector<std::int64_t>>(table.values[column]);
}

TEST_F(DataTextRows, ReadsTheColumnsThatAreWanted) {
  const TextTable table =
      read("1 Na 2.5 x\n-7\tCl  1e3 y\r\n", layout({kInteger, kText, kNumber, {ColumnType::kFloat64, false}}));
  EXPECT_EQ(table.rows, 2u);
  EXPECT_EQ(integers(table, 0), (std::vector<std::int64_t>{1, -7}));
  EXPECT_EQ(std::get<Words>(table.values[1]).words, (std::vector<std::string>{"Na", "Cl"}));
  EXPECT_EQ(numbers(table, 2), (std::vector<double>{2.5, 1000}));
  EXPECT_TRUE(numbers(table, 3).empty());
}

}  // namespace
}  // namespace orrery::data
