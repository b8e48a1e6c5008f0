// SPDX-License-Identifier: Apache-2.0
#include "data/table.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace orrery::data {
namespace {

TEST(DataTable, FoundColumnsCanBeModified) {
  Table table{2, {{"a", std::vector<double>{1, 2}}, {"b", std::vector<double>{3, 4}}}};
  EXPECT_EQ(std::as_const(table).find("b"), &table.columns[1]);
  table.find("b")->values = std::vector<double>{5, 6};
  EXPECT_EQ(table.columns[1].number(0), 5);
  EXPECT_EQ(table.find("c"), nullptr);
}

}  // namespace
}  // namespace orrery::data
