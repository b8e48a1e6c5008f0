// SPDX-License-Identifier: Apache-2.0
#include "data/elements.h"

#include <gtest/gtest.h>

#include <gemmi/elem.hpp>
#include <set>
#include <string>

namespace orrery::data {
namespace {

TEST(DataElements, SymbolsAreThoseOfGemmi) {
  for (int number = 1; number <= 118; ++number) {
    const Element* element = find_element(number);
    ASSERT_NE(element, nullptr) << number;
    EXPECT_EQ(element->symbol, gemmi::element_name(static_cast<gemmi::El>(number)));
    EXPECT_EQ(find_element(element->symbol), element);
    EXPECT_EQ(find_element(std::to_string(number)), element);
  }
}

TEST(DataElements, LookUpIgnoresCaseAndBlanks) {
  const Element* iron = find_element(26);
  for (const char* text : {"Fe", "FE", "fe", " fe ", "FE ", "\tFe", "26"}) EXPECT_EQ(find_element(text), iron) << text;
  EXPECT_EQ(find_element("D"), find_element(1));
  EXPECT_EQ(find_element("c"), find_element(6));
  EXPECT_EQ(find_element("CA"), find_element(20)) << "not a C-alpha atom: the caller passes elements";
}

TEST(DataElements, UnknownIsNull) {
  for (const char* text : {"", " ", "X", "Xx", "Fe2", "Fe2+", "0", "119", "-1", "6.0", "99999999999999999999", "F e"})
    EXPECT_EQ(find_element(text), nullptr) << text;
  EXPECT_EQ(find_element(0), nullptr);
  EXPECT_EQ(find_element(119), nullptr);
  EXPECT_EQ(find_element(-1), nullptr);
}

/// Main group and noble gases.
bool is_main_group(int number) {
  return number <= 20 || (number >= 31 && number <= 38) || (number >= 49 && number <= 56) ||
         (number >= 81 && number <= 88);
}

TEST(DataElements, VanDerWaalsRadiiOfTheMainGroupAreThoseOfGemmi) {
  // gemmi cites Bondi and Mantina for the main group, and other sources for the metals.
  for (int number = 1; number <= 118; ++number) {
    if (!is_main_group(number)) continue;
    EXPECT_FLOAT_EQ(static_cast<float>(find_element(number)->van_der_waals),
                    gemmi::vdw_radius(static_cast<gemmi::El>(number)))
        << find_element(number)->symbol;
  }
}

TEST(DataElements, OtherVanDerWaalsRadiiAreThoseOfAlvarez) {
  EXPECT_EQ(find_element("Sc")->van_der_waals, 2.58);
  EXPECT_EQ(find_element("Fe")->van_der_waals, 2.44);
  EXPECT_EQ(find_element("Zn")->van_der_waals, 2.39);
  EXPECT_EQ(find_element("Pd")->van_der_waals, 2.15);
  EXPECT_EQ(find_element("Gd")->van_der_waals, 2.83);
  EXPECT_EQ(find_element("Au")->van_der_waals, 2.32);
  EXPECT_EQ(find_element("U")->van_der_waals, 2.71);
  EXPECT_EQ(find_element("Es")->van_der_waals, 2.70);
  EXPECT_EQ(find_element("Pm")->van_der_waals, 2.00);
  EXPECT_EQ(find_element("Og")->van_der_waals, 2.00);
}

TEST(DataElements, CovalentRadiiAreThoseOfGemmiExceptItsErrors) {
  // gemmi has the sp2 radius of carbon, has Lu and Hf interchanged, and rounds from Nh on.
  const std::set<std::string_view> others = {"C", "Lu", "Hf", "Nh", "Fl", "Mc", "Lv", "Ts", "Og"};
  for (int number = 1; number <= 118; ++number) {
    const Element& element = *find_element(number);
    if (others.count(element.symbol) > 0) continue;
    EXPECT_FLOAT_EQ(static_cast<float>(element.covalent), gemmi::covalent_radius(static_cast<gemmi::El>(number)))
        << element.symbol;
  }
  EXPECT_EQ(find_element("C")->covalent, 0.76);
  EXPECT_EQ(find_element("Lu")->covalent, 1.87);
  EXPECT_EQ(find_element("Hf")->covalent, 1.75);
  EXPECT_EQ(find_element("Og")->covalent, 1.57);
}

TEST(DataElements, Colors) {
  EXPECT_EQ(find_element("C")->color, 0x909090u);
  EXPECT_EQ(find_element("N")->color, 0x3050F8u);
  EXPECT_EQ(find_element("O")->color, 0xFF0D0Du);
  EXPECT_EQ(find_element("Mt")->color, 0xEB0026u);
  EXPECT_EQ(find_element("Og")->color, 0xEB0026u);
}

}  // namespace
}  // namespace orrery::data
