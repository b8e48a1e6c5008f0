// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace orrery::points {

/// A colour in display-referred sRGB, 8 bits per channel.
using Srgb8 = std::array<std::uint8_t, 3>;

/// Ratio of the radii of ElementRadius::kBall to van der Waals radii. Viewers draw balls and sticks with 0.2 to 0.3.
inline constexpr double kBallScale = 0.25;

enum class ElementRadius {
  kVanDerWaals,
  kCovalent,
  kBall,  ///< kBallScale times the van der Waals radius
};

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
  /// The colour that viewers give it by default.
  ///
  /// Reference  jmol-colors; from Ds on that of Mt. Hydrogen is PyMOL's light grey instead of white, because white
  /// atoms are invisible against the white background of a plot.
  Srgb8 color;

  double radius(ElementRadius kind) const;
};

/// Returns the element with an atomic number; null unless 1 <= number <= 118.
const Element* find_element(int number);

/// Returns the element with a symbol, ignoring case and surrounding spaces, or with an atomic number as text: "Fe", "
/// FE", "26". D is hydrogen.
///
/// Result     null if there is none
const Element* find_element(std::string_view symbol);

}  // namespace orrery::points
