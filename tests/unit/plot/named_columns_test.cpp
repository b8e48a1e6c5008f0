// SPDX-License-Identifier: Apache-2.0
#include "plot/named_columns.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "plot/plot.h"

namespace orrery::plot {
namespace {

using Names = std::vector<std::string>;

/// Atoms of chains, with velocities.
data::FrameInfo atoms_of_chains() {
  data::FrameInfo out;
  for (const char* name : {"id", "name", "chain", "residue_number", "x", "y", "z", "vx", "vy", "vz", "mass"})
    out.columns.push_back(
        {name, name[0] == 'n' || name[0] == 'c' ? data::ColumnType::kText : data::ColumnType::kFloat64});
  out.roles.position = {"x", "y", "z"};
  out.roles.id = "id";
  out.roles.chain = "chain";
  return out;
}

TEST(PlotNamedColumns, AnIllustrationDividesOutlinesByChain) {
  PlotOptions options;
  EXPECT_EQ(outline_column(options, atoms_of_chains()), "");
  options.style = Style::kIllustration;
  EXPECT_EQ(outline_column(options, atoms_of_chains()), "chain");
  EXPECT_EQ(outline_column(options, {}), "") << "there are no chains";
  options.outline_by = "mass";
  EXPECT_EQ(outline_column(options, atoms_of_chains()), "mass");
}

TEST(PlotNamedColumns, ColumnsWithARoleAndThoseOfOptionsAreRead) {
  PlotOptions options;
  EXPECT_EQ(expected_columns(options, atoms_of_chains()), (Names{"id", "chain", "x", "y", "z"}));
  for (int option = 0; option < 3; ++option) {
    PlotOptions named;
    (option == 0 ? named.color_by : option == 1 ? named.center : named.fit) = "mass * 2 > 1";
    EXPECT_EQ(expected_columns(named, atoms_of_chains()).back(), "mass");
  }
  options.points.opacity.where = {"resid 3: 0.5"};
  EXPECT_EQ(expected_columns(options, atoms_of_chains()),
            (Names{"id", "name", "chain", "residue_number", "x", "y", "z"}));
}

TEST(PlotNamedColumns, ADerivedColumnNeedsItsSources) {
  PlotOptions options;
  options.color_by = "speed";
  EXPECT_EQ(expected_columns(options, atoms_of_chains()), (Names{"id", "chain", "x", "y", "z", "vx", "vy", "vz"}));
}

TEST(PlotNamedColumns, NamesAreUtf8) {
  EXPECT_NO_THROW(require_utf8("Größe 漢"));
  for (const char* const text : {"\xff", "a\xc3", "\xc3\x28"}) EXPECT_THROW(require_utf8(text), base::Error);
}

}  // namespace
}  // namespace orrery::plot
