// SPDX-License-Identifier: Apache-2.0
#include "data/atom_elements.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace orrery::data {
namespace {

TEST(DataAtomElements, StandardResiduesAreThoseOfAllPrograms) {
  for (const char* const name :
       {"ALA", "HOH", "DA", "U", "HIE", "HSD", "CYX", "TIP3", "SOL", "NALA", "CVAL", "DA5", "ASPP"})
    EXPECT_TRUE(is_standard_residue(name)) << name;
  for (const char* const name : {"", "LIG", "HEM", "CA", "POPC", "NLIG", "ala"})
    EXPECT_FALSE(is_standard_residue(name)) << name;
}

TEST(DataAtomElements, IonsAreThoseOfTheirResidue) {
  AtomElements elements(true);
  const std::pair<const char*, const char*> ions[] = {
      {"CA  CA", "Ca"},  {"Na+ Na+", "Na"}, {"CL- CL-", "Cl"}, {"SOD SOD", "Na"}, {"CLA CLA", "Cl"},
      {"CAL CAL", "Ca"}, {"POT POT", "K"},  {"ZN  ZN2", "Zn"}, {"K   K", "K"},    {"CES CES", "Cs"}};
  for (const auto& [text, element] : ions)
    EXPECT_EQ(elements.element_of(std::string(text).substr(0, 4), std::string(text).substr(4)), element) << text;
  EXPECT_EQ(elements.warning(), "");
}

TEST(DataAtomElements, AlignedNamesOfOtherResiduesAreThoseOfTheFormat) {
  AtomElements elements(false);
  EXPECT_EQ(elements.element_of(" CA ", "LIG"), "C");
  EXPECT_EQ(elements.element_of("1HG2", "LIG"), "H");
  EXPECT_EQ(elements.element_of("HG21", "LIG"), "H");
  EXPECT_EQ(elements.element_of("C12 ", "LIG"), "C");
  EXPECT_EQ(elements.warning(), "") << "these are sure";
  EXPECT_EQ(elements.element_of("CA  ", "LIG"), "Ca");
  EXPECT_NE(elements.warning().find("those of 1 atom were guessed from names: CA of LIG is Ca"), std::string::npos)
      << elements.warning();
}

TEST(DataAtomElements, BeadsOfCoarseGrainedModelsAreUnknown) {
  AtomElements elements(true);
  for (const char* const name : {"BB  ", "SC1 ", "MW  ", "EPW "})
    EXPECT_EQ(elements.element_of(name, "SER"), "X") << name;
  for (int i = 0; i < 10; ++i) elements.element_of("BB  ", "ALA");
  EXPECT_NE(elements.warning().find("those of 14 atoms are unknown: BB of SER, SC1 of SER, MW of SER"),
            std::string::npos)
      << elements.warning();
}

}  // namespace
}  // namespace orrery::data
