// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "data/table.h"

namespace orrery::data {

/// Symbols of the chemical elements, by atomic number from 1.
// clang-format off
inline constexpr std::array<std::string_view, 118> kElementSymbols = {
    "H", "He", "Li", "Be", "B", "C", "N", "O", "F", "Ne", "Na", "Mg", "Al", "Si", "P", "S", "Cl", "Ar", "K", "Ca",
    "Sc", "Ti", "V", "Cr", "Mn", "Fe", "Co", "Ni", "Cu", "Zn", "Ga", "Ge", "As", "Se", "Br", "Kr", "Rb", "Sr", "Y",
    "Zr", "Nb", "Mo", "Tc", "Ru", "Rh", "Pd", "Ag", "Cd", "In", "Sn", "Sb", "Te", "I", "Xe", "Cs", "Ba", "La", "Ce",
    "Pr", "Nd", "Pm", "Sm", "Eu", "Gd", "Tb", "Dy", "Ho", "Er", "Tm", "Yb", "Lu", "Hf", "Ta", "W", "Re", "Os", "Ir",
    "Pt", "Au", "Hg", "Tl", "Pb", "Bi", "Po", "At", "Rn", "Fr", "Ra", "Ac", "Th", "Pa", "U", "Np", "Pu", "Am", "Cm",
    "Bk", "Cf", "Es", "Fm", "Md", "No", "Lr", "Rf", "Db", "Sg", "Bh", "Hs", "Mt", "Ds", "Rg", "Cn", "Nh", "Fl", "Mc",
    "Lv", "Ts", "Og"};
// clang-format on

/// Returns the atomic number of an element given by symbol, ignoring case and surrounding spaces, or by atomic number
/// as text: "Fe", " FE", "26". D is hydrogen.
///
/// Result     0 if there is none
int atomic_number(std::string_view word);

/// Assigns the role of the element to a column of names only if all of them are elements; otherwise, they are types:
/// coarse-grained models and mixtures have particles named A, B or C1.
void settle_element(const std::vector<std::string>& names, Roles& roles);

}  // namespace orrery::data
