// SPDX-License-Identifier: Apache-2.0
#include "data/cif_rows.h"

#include <gtest/gtest.h>

#include <utility>

#include "base/error.h"
#include "data/faults.h"

namespace orrery::data {
namespace {

using Strings = std::vector<std::string>;

/// The rows of the items `id` and `name` of the category `_a.`, with their lines; and the number of blocks.
struct Found {
  std::vector<std::pair<Strings, std::uint64_t>> rows;
  int blocks = 0;
};

Found read(const std::string& text) {
  Found out;
  Faults faults("a.cif");
  const auto take = [&](const Strings& values, std::uint64_t line) { out.rows.emplace_back(values, line); };
  read_cif(text, {{"_a.", {"id", "name"}, take}}, faults, [&] { ++out.blocks; });
  return out;
}

TEST(DataCifRows, LoopsAndSingleItemsAreRows) {
  const Found loop = read("data_x\nloop_\n_b.c\n1 2\nloop_\n_a.NAME\n_a.other\n_a.id\n'a b' 3 1\n? 4 .\n");
  ASSERT_EQ(loop.rows.size(), 2u);
  EXPECT_EQ(loop.rows[0].first, (Strings{"1", "a b"}));
  EXPECT_EQ(loop.rows[0].second, 9u);
  EXPECT_EQ(loop.rows[1].first, (Strings{"", ""}));
  EXPECT_EQ(loop.blocks, 1);
  const Found single = read("data_x\n_a.id 7\n_b.c 8\ndata_y\n_a.name z\n");
  ASSERT_EQ(single.rows.size(), 2u);
  EXPECT_EQ(single.rows[0].first, (Strings{"7", ""}));
  EXPECT_EQ(single.rows[1].first, (Strings{"", "z"}));
  EXPECT_EQ(single.blocks, 2);
}

TEST(DataCifRows, IncompleteRowsAndSyntaxErrorsAreBadData) {
  for (const char* const text : {"data_x\nloop_\n_a.id\n_a.name\n1 2 3\n", "data_x\n_a.id 'b\n"}) {
    try {
      read(text);
      ADD_FAILURE() << text;
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData) << text;
    }
  }
}

}  // namespace
}  // namespace orrery::data
