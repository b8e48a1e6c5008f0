// SPDX-License-Identifier: Apache-2.0
#include "data/atom_table.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "data/faults.h"
#include "support/data_tables.h"

namespace orrery::data {
namespace {

Atom atom(const char* name, double x, const char* altloc = "", double occupancy = 1) {
  Atom out;
  out.name = name;
  out.element = "C";
  out.chain = "A";
  out.residue = "ALA";
  out.position = {x, 0, 0};
  out.altloc = altloc;
  out.occupancy = occupancy;
  return out;
}

TEST(DataAtomTable, OfAlternateLocationsTheMostOccupiedIsKept) {
  AtomTable table;
  EXPECT_EQ(table.add(atom("CA", 1, "A", 0.3)), 0u);
  EXPECT_EQ(table.add(atom("CB", 2)), 1u);
  EXPECT_EQ(table.add(atom("CA", 3, "B", 0.6)), 0u);
  EXPECT_EQ(table.add(atom("CA", 4, "C", 0.6)), 0u);
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(support::numbers(table.table({"x"}), "x"), (std::vector<double>{3, 2}));
}

TEST(DataAtomTable, EqualAtomsWithoutAlternatesAreRows) {
  AtomTable table;
  table.add(atom("CA", 1));
  table.add(atom("CA", 2));
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.memory(), 2 * AtomTable::kBytesPerRow);
}

TEST(DataAtomTable, SubchainsAreListedIfAnAtomHasOne) {
  AtomTable table;
  table.add(atom("CA", 1));
  EXPECT_EQ(table.info().roles.chain, "chain");
  Atom other = atom("CB", 2);
  other.subchain = "AA";
  table.add(other);
  EXPECT_EQ(table.info().roles.chain, "subchain");
  EXPECT_EQ(table.info().rows, 2u);
}

TEST(DataAtomTable, ParsingMustFitIntoMemory) {
  require_parse_memory("a.pdb", 1000, 2, 500, 0);
  require_parse_memory("a.pdb", 1000, 2, 500, 2500);
  try {
    require_parse_memory("a.pdb", 1000, 2, 500, 2499);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
  }
}

TEST(DataAtomTable, ControlCharactersAreRefusedWithTheirLine) {
  Faults faults("a.pdb");
  std::uint64_t line = 1;
  require_text("a\tb\r\nc\n", line, faults);
  EXPECT_EQ(line, 3u);
  try {
    require_text(std::string_view("d\n\0", 3), line, faults);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.diagnostics().at(0).line, 4);
  }
}

}  // namespace
}  // namespace orrery::data
