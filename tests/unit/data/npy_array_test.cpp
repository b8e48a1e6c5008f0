// SPDX-License-Identifier: Apache-2.0
#include "data/npy_array.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/npy_bytes.h"

namespace orrery::data {
namespace {

NpyHeader header_of(const std::string& description, const std::string& shape, bool is_fortran = false) {
  NpyHeader out;
  const std::string bytes = support::npy_bytes(description, is_fortran, shape, "");
  EXPECT_TRUE(has_npy_signature(bytes));
  EXPECT_EQ(npy_header_end(bytes), bytes.size());
  EXPECT_EQ(parse_npy_header(bytes, out), "");
  EXPECT_EQ(out.begin, bytes.size());
  return out;
}

TEST(DataNpyArray, HeadersHaveTypeShapeAndSize) {
  const NpyHeader header = header_of("'>f4'", "(2, 3)");
  EXPECT_FALSE(header.is_structured);
  EXPECT_EQ(header.shape, (std::vector<std::uint64_t>{2, 3}));
  EXPECT_EQ(header.rows(), 2u);
  EXPECT_EQ(header.item_size, 4u);
  ASSERT_EQ(header.fields.size(), 1u);
  EXPECT_TRUE(header.fields[0].is_big_endian);
  EXPECT_EQ(npy_data_bytes(header), 24u);
  EXPECT_EQ(shape_text(header), "(2, 3)");
  EXPECT_EQ(shape_text(header_of("'<i8'", "(5,)")), "(5,)");
}

TEST(DataNpyArray, SizesDoNotOverflow) {
  const NpyHeader header = header_of("'<f8'", "(4611686018427387904, 4611686018427387904)");
  EXPECT_EQ(npy_data_bytes(header), std::numeric_limits<std::uint64_t>::max());
}

TEST(DataNpyArray, ColumnsFollowTheOrderOfTheArray) {
  for (const bool is_fortran : {false, true}) {
    const NpyHeader header = header_of("'<f8'", "(10, 2)", is_fortran);
    std::vector<ColumnInfo> so_far;
    const std::vector<NpyColumn> columns = npy_columns(header, "v", so_far);
    ASSERT_EQ(columns.size(), 2u);
    EXPECT_EQ(so_far.size(), 2u);
    EXPECT_EQ(columns[0].name, "v[1]");
    EXPECT_EQ(columns[1].begin + columns[1].offset, header.begin + (is_fortran ? 80u : 8u));
    EXPECT_EQ(columns[1].stride, is_fortran ? 8u : 16u);
  }
}

TEST(DataNpyArray, NamesMayHaveQuotesBracketsAndOtherCharacters) {
  const NpyHeader header = header_of("[('it\\'s \"(1, True,)\"', '<f8'), ('d\xE9', '<f8')]", "(5,)");
  ASSERT_EQ(header.fields.size(), 2u);
  EXPECT_EQ(header.fields[0].name, "it's \"(1, True,)\"");
  EXPECT_EQ(header.fields[1].name, "d\u00e9") << "version 1 is encoded in Latin-1";
  const NpyHeader same = header_of("[(\"a\\\\'b\", '<f8')]", "(5,)");
  EXPECT_EQ(same.fields.at(0).name, "a\\'b");
}

TEST(DataNpyArray, ShortOrForeignHeadsAreRecognised) {
  EXPECT_FALSE(has_npy_signature("NUMPY"));
  EXPECT_EQ(npy_header_end("\x93NUMPY\x01"), 0u);
  NpyHeader header;
  EXPECT_NE(parse_npy_header(support::npy_bytes("'<f8'", false, "(2, 3)", "", 9), header), "");
}

}  // namespace
}  // namespace orrery::data
