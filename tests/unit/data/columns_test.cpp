// SPDX-License-Identifier: Apache-2.0
#include "data/columns.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace orrery::data {
namespace {

using Strings = std::vector<std::string>;

std::vector<ColumnInfo> columns(const Strings& names, ColumnType type = ColumnType::kFloat64) {
  std::vector<ColumnInfo> out;
  for (const std::string& name : names) out.push_back({name, type});
  return out;
}

TEST(DataColumns, CustomaryNamesHaveRoles) {
  const Roles roles = customary_roles(columns({"ID", "X", "Y", "Z", "Diameter", "Type"}));
  EXPECT_EQ(roles.position, (std::array<std::string, 3>{"X", "Y", "Z"}));
  EXPECT_EQ(roles.radius, "Diameter");
  EXPECT_EQ(roles.radius_scale, 0.5);
  EXPECT_EQ(roles.id, "ID");
  EXPECT_EQ(roles.type, "Type");
  EXPECT_EQ(roles.element, "");
}

TEST(DataColumns, RIsARadiusUnlessItIsRed) {
  EXPECT_EQ(customary_roles(columns({"x", "y", "z", "r"})).radius, "r");
  const Roles roles = customary_roles(columns({"x", "y", "z", "r", "g", "b"}));
  EXPECT_EQ(roles.radius, "");
  EXPECT_EQ(roles.rgb, (std::array<std::string, 3>{"r", "g", "b"}));
}

TEST(DataColumns, FullIntensityFollowsTheType) {
  const Strings names = {"red", "green", "blue"};
  EXPECT_EQ(customary_roles(columns(names, ColumnType::kUint8)).rgb_maximum, 255);
  EXPECT_EQ(customary_roles(columns(names, ColumnType::kUint16)).rgb_maximum, 65535);
  EXPECT_EQ(customary_roles(columns(names, ColumnType::kFloat32)).rgb_maximum, 1);
}

TEST(DataColumns, AMissingPositionListsTheColumns) {
  Faults faults("a.csv");
  try {
    required_roles(columns({"u", "v"}), faults);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_NE(error.diagnostics().at(0).text.find("u, v"), std::string::npos);
  }
}

TEST(DataColumns, ComponentsOfAnArrayAreNumberedOrCoordinates) {
  EXPECT_EQ(component_names("mass", 1, {}), Strings{"mass"});
  EXPECT_EQ(component_names("Positions", 3, {}), (Strings{"x", "y", "z"}));
  EXPECT_EQ(component_names("positions", 3, columns({"x"})), (Strings{"positions[1]", "positions[2]", "positions[3]"}));
  EXPECT_EQ(component_names("v", 2, {}), (Strings{"v[1]", "v[2]"}));
}

TEST(DataColumns, TakenNamesGetTheNextFreeNumber) {
  UniqueNames names(columns({"a", "a_2"}));
  EXPECT_EQ(names.add("b"), "b");
  EXPECT_EQ(names.add("a"), "a_3");
  EXPECT_EQ(names.add("a"), "a_4");
}

TEST(DataColumns, ComputedColumnsAreReplacedByTheirSources) {
  const std::array<std::string, 3> computed = {"x", "y", "z"}, sources = {"xs", "ys", "zs"};
  EXPECT_EQ(with_sources({"id"}, computed, sources), Strings{"id"});
  EXPECT_EQ(with_sources({"y", "id", "xs"}, computed, sources), (Strings{"id", "xs", "ys", "zs"}));
}

TEST(DataColumns, TablesAreReordered) {
  Table table;
  table.rows = 1;
  table.columns = {{"a", std::vector<double>{1}}, {"b", std::vector<double>{2}}};
  const Table out = in_order(table, {"b", "a"});
  EXPECT_EQ(out.rows, 1u);
  EXPECT_EQ(out.columns.at(0).name, "b");
  EXPECT_EQ(std::get<std::vector<double>>(out.columns.at(1).values), std::vector<double>{1});
}

TEST(DataColumns, ManyColumnsAreListedShortened) {
  EXPECT_EQ(listed(columns({"a", "b"})), "a, b");
  const std::string text = listed(columns(Strings(31, "c")));
  EXPECT_NE(text.find("31 in all"), std::string::npos);
}

}  // namespace
}  // namespace orrery::data
