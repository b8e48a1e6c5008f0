// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace orrery::data {

/// A chemical element.
struct Element {
  std::string_view symbol;  ///< "He"
  /// Van der Waals radius: Bondi's value if he gives one and the element is in the main group, else Mantina's in the
  /// main group, else Alvarez's. Bondi's radii of transition metals are not used: they are those of single crystals,
  /// and half as large as those of their neighbours in the table. 2.00 if there is no published value (Pm, and Fm and
  /// heavier elements).
  ///
  /// Units      angstrom
  /// Reference  bondi1964, mantina2009, alvarez2013
  double van_der_waals;
  /// Covalent radius of a single bond: carbon sp3; Mn, Fe and Co low spin. Pyykkö's values for Bk and heavier elements.
  ///
  /// Units      angstrom
  /// Reference  cordero2008, pyykko2009
  double covalent;
  /// The colour that viewers give it by default, 0xRRGGBB in display-referred sRGB.
  ///
  /// Reference  jmol-colors; from Ds on that of Mt. Hydrogen is PyMOL's light grey instead of white, because white
  /// atoms are invisible against the white background of a plot.
  std::uint32_t color;
};

/// Whether an element is a metal in its compounds with others; Ge, Sb and Po are.
bool is_metal(const Element& element);

/// Returns the element with an atomic number; null unless 1 <= number <= 118.
const Element* find_element(int number);

/// Returns the element with a symbol, ignoring case and surrounding spaces, or with an atomic number as text: "fe" and
/// "26" are iron. D is hydrogen.
///
/// Result     null if there is none
const Element* find_element(std::string_view word);

}  // namespace orrery::data
