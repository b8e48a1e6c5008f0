// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "data/write_table.h"
#include "support/temp_dir.h"

namespace orrery::data {
namespace {

/// Rows of x, y, z as floats, and the views of their columns.
std::shared_ptr<const Table> views_of(const std::vector<float>& xyz) {
  const std::size_t rows = xyz.size() / 3;
  Table table{rows, {}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    table.columns.push_back({std::string(1, "xyz"[axis]), ArrayView<float>(&xyz[axis], 3 * sizeof(float), rows)});
  table.columns.push_back({"radius", std::vector<double>(rows, 0.5)});
  return std::make_shared<const Table>(std::move(table));
}

TEST(DataTableFile, ViewsHaveAnyStride) {
  const std::vector<double> values = {1, 2, 3, 4};
  const ArrayView<double> backwards(&values[3], -2 * static_cast<std::ptrdiff_t>(sizeof(double)), 2);
  EXPECT_EQ(backwards[0], 4);
  EXPECT_EQ(backwards[1], 2);
  const ArrayView<double> same(&values[1], 0, 5);
  EXPECT_EQ(same[4], 2);
  char bytes[1 + sizeof(double)];
  std::memcpy(bytes + 1, &values[2], sizeof(double));
  EXPECT_EQ(ArrayView<double>(bytes + 1, 1, 1)[0], 3) << "not aligned";
}

TEST(DataTableFile, DescribesAndReadsLikeThePlyFileOfTheTable) {
  const std::vector<float> xyz = {1, 2, 3, 4, 5, 6};
  const std::shared_ptr<const Table> table = views_of(xyz);
  support::TempDir folder;
  EXPECT_TRUE(data::write_table(folder / "a.ply", *table).empty());
  const std::unique_ptr<DataFile> memory = open_table("a", table), file = data::open(folder / "a.ply");
  EXPECT_STREQ(memory->format, "arrays");
  EXPECT_EQ(memory->frame_count(), 1);
  const FrameInfo a = memory->describe(0), b = file->describe(0);
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.roles.position, b.roles.position);
  EXPECT_EQ(a.roles.radius, b.roles.radius);
  ASSERT_EQ(a.columns.size(), b.columns.size());
  const std::vector<std::string> names = {"z", "radius"};
  const Table from_memory = memory->read(0, names), from_file = file->read(0, names);
  for (std::size_t c = 0; c < names.size(); ++c) {
    EXPECT_EQ(from_memory.columns[c].name, names[c]);
    EXPECT_EQ(from_memory.columns[c].type(), from_file.columns[c].type());
    for (std::size_t row = 0; row < 2; ++row)
      EXPECT_EQ(from_memory.columns[c].number(row), from_file.columns[c].number(row));
  }
  EXPECT_TRUE(std::holds_alternative<ArrayView<float>>(from_memory.columns[0].values)) << "not copied";
}

TEST(DataTableFile, NamesAreElementsIfAllAre) {
  const auto roles = [](const Words& species) {
    auto table = std::make_shared<Table>();
    table->rows = species.index.size();
    for (const char* name : {"x", "y", "z"}) table->columns.push_back({name, std::vector<double>(table->rows)});
    table->columns.push_back({"species", species});
    return settled(open_table("a", table))->describe(0).roles;
  };
  EXPECT_EQ(roles({{"Fe", "O"}, {0, 1}}).element, "species");
  EXPECT_EQ(roles({{"Fe", "O"}, {0, 1}}).type, "");
  EXPECT_EQ(roles({{"A", "B"}, {0, 1}}).element, "") << "as in an NPY file";
  EXPECT_EQ(roles({{"A", "B"}, {0, 1}}).type, "species");
  EXPECT_EQ(roles({{"Fe", "X"}, {0, 1}}).type, "species") << "a ghost atom of ASE";
}

TEST(DataTableFile, HasTheRolesOfTheFilesThatColumnsComeFrom) {
  auto table = std::make_shared<Table>();
  for (const char* name : {"xu", "yu", "zu"}) table->columns.push_back({name, std::vector<double>()});
  for (const char* name : {"chain", "subchain"}) table->columns.push_back({name, Words()});
  const Roles roles = open_table("a", table)->describe(0).roles;
  EXPECT_EQ(roles.position, (std::array<std::string, 3>{"xu", "yu", "zu"}));
  EXPECT_EQ(roles.chain, "subchain");
}

TEST(DataTableFile, NeedsPositions) {
  auto table = std::make_shared<Table>();
  table->columns.push_back({"x", std::vector<double>()});
  EXPECT_THROW(open_table("a", table), base::Error);
}

}  // namespace
}  // namespace orrery::data
