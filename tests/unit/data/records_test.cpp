// SPDX-License-Identifier: Apache-2.0
#include "data/records.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/temp_dir.h"

namespace orrery::data {
namespace {

template <class T>
std::string bytes_of(T value, bool is_big_endian) {
  std::string out;
  append_little_endian(out, value);
  if (is_big_endian) std::reverse(out.begin(), out.end());
  return out;
}

class DataRecords : public testing::Test {
 protected:
  std::vector<Column> read(const std::string& bytes, const RecordLayout& layout,
                           const std::vector<RecordField>& fields) {
    support::write_bytes(folder_ / "a", bytes);
    const auto source = ByteSource::open(folder_ / "a", 1 << 24);
    EXPECT_TRUE(contains(source->size(), layout));
    return read_records(*source, layout, fields, faults_);
  }
  support::TempDir folder_;
  Faults faults_{"a"};
};

TEST_F(DataRecords, FieldsHaveTheirOffsetAndByteOrder) {
  constexpr std::uint64_t kRows = 300'000;  // several parts
  std::string bytes = "head";
  for (std::uint64_t i = 0; i < kRows; ++i)
    bytes += bytes_of(static_cast<std::int16_t>(i), true) + "-" + bytes_of(static_cast<float>(i), false);
  const auto columns = read(bytes, {4, 7, kRows}, {{"f", NumberType::kFloat32, 3}, {"i", NumberType::kInt16, 0, true}});
  ASSERT_EQ(columns.size(), 2u);
  const auto& floats = std::get<std::vector<float>>(columns[0].values);
  const auto& integers = std::get<std::vector<std::int32_t>>(columns[1].values);
  ASSERT_EQ(floats.size(), kRows);
  for (std::uint64_t i = 0; i < kRows; ++i) {
    ASSERT_EQ(floats[i], static_cast<float>(i));
    ASSERT_EQ(integers[i], static_cast<std::int16_t>(i));
  }
}

TEST_F(DataRecords, LargeUnsignedIntegersAreFaults) {
  const std::uint64_t largest = std::numeric_limits<std::int64_t>::max();
  read(bytes_of(largest, false), {0, 8, 1}, {{"u", NumberType::kUint64, 0}});
  EXPECT_FALSE(faults_.has_any());
  read(bytes_of(largest + 1, false), {0, 8, 1}, {{"u", NumberType::kUint64, 0}});
  EXPECT_TRUE(faults_.has_any());
}

TEST_F(DataRecords, RecordsBeyondTheFileAreNotContained) {
  EXPECT_TRUE(contains(100, {10, 30, 3}));
  EXPECT_FALSE(contains(99, {10, 30, 3}));
  EXPECT_FALSE(contains(100, {10, 30, std::uint64_t{1} << 63}));
  EXPECT_FALSE(contains(100, {101, 30, 0}));
}

TEST_F(DataRecords, ColumnTypesHoldAllNumbers) {
  EXPECT_EQ(column_type(NumberType::kInt8), ColumnType::kInt32);
  EXPECT_EQ(column_type(NumberType::kUint32), ColumnType::kInt64);
  EXPECT_EQ(size_of(NumberType::kUint16), 2u);
}

}  // namespace
}  // namespace orrery::data
