// SPDX-License-Identifier: Apache-2.0
#include "data/bonds.h"

#include <gtest/gtest.h>

#include <utility>

#include "base/error.h"
#include "data/faults.h"

namespace orrery::data {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs pairs(const std::vector<Bond>& bonds) {
  Pairs out;
  for (const Bond& bond : bonds) out.emplace_back(bond.a, bond.b);
  return out;
}

TEST(DataBonds, IdsAreReplacedByRowsAndEqualBondsMerged) {
  Faults faults("a.data");
  for (const std::vector<std::int64_t>& ids : {std::vector<std::int64_t>{7, 5, 6}, {70, 5, 600}}) {
    BondsById bonds(ids, faults);
    bonds.add(ids[2], ids[0], 1);
    bonds.add(ids[0], ids[1], 2);
    bonds.add(ids[0], ids[2], 3);
    EXPECT_EQ(pairs(bonds.take()), (Pairs{{0, 1}, {0, 2}}));
  }
  EXPECT_FALSE(faults.has_any());
}

TEST(DataBonds, SeveralIdsMayBelongToOneRow) {
  Faults faults("a.pdb");
  BondsById bonds(std::vector<std::pair<std::int64_t, std::uint32_t>>{{1, 0}, {2, 0}, {3, 1}}, faults);
  bonds.add(1, 2, 1);  // alternate locations of one atom
  bonds.add(2, 3, 2);
  EXPECT_EQ(pairs(bonds.take()), (Pairs{{0, 1}}));
}

TEST(DataBonds, FaultyBondsAreReportedWithTheirLine) {
  const std::vector<std::int64_t> ids = {1, 2, 2, 9};
  for (const auto& [a, b] : {std::pair<int, int>{1, 5}, {1, 2}, {9, 9}}) {
    Faults faults("a.data");
    BondsById bonds(ids, faults);
    bonds.add(a, b, 12);
    EXPECT_TRUE(faults.take_text().starts_with("line 12: ")) << a << " " << b;
  }
}

TEST(DataBonds, MissingAtomsAreAWarningWhereTheFormatAllowsIt) {
  Faults faults("a.pdb");
  std::vector<std::string> warnings;
  warn_of_missing(faults, warnings);
  EXPECT_TRUE(warnings.empty());
  BondsById(std::vector<std::int64_t>{1}, faults).add(1, 8, 3);
  warn_of_missing(faults, warnings);
  EXPECT_EQ(warnings.size(), 1u);
  EXPECT_FALSE(faults.has_any());
}

TEST(DataBonds, TooManyBondsOfOneRowAreRefused) {
  std::vector<Bond> bonds;
  for (std::uint32_t i = 1; i <= kMaxBondsInFile; ++i) bonds.push_back(ordered_bond(i, 0));
  Faults faults("a.data");
  finish_bonds(bonds, faults);
  EXPECT_EQ(bonds.size(), kMaxBondsInFile);
  bonds.push_back(ordered_bond(0, kMaxBondsInFile + 1));
  EXPECT_THROW(finish_bonds(bonds, faults), base::Error);
}

}  // namespace
}  // namespace orrery::data
