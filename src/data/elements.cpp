// SPDX-License-Identifier: Apache-2.0
#include "data/elements.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>

#include "base/text.h"
#include "data/text_lines.h"

namespace orrery::data {
namespace {

/// By atomic number from 1.
// clang-format off
constexpr Element kElements[] = {
    {"H", 1.20, 0.31, 0xE6E6E6}, {"He", 1.40, 0.28, 0xD9FFFF}, {"Li", 1.82, 1.28, 0xCC80FF},
    {"Be", 1.53, 0.96, 0xC2FF00}, {"B", 1.92, 0.84, 0xFFB5B5}, {"C", 1.70, 0.76, 0x909090},
    {"N", 1.55, 0.71, 0x3050F8}, {"O", 1.52, 0.66, 0xFF0D0D}, {"F", 1.47, 0.57, 0x90E050},
    {"Ne", 1.54, 0.58, 0xB3E3F5}, {"Na", 2.27, 1.66, 0xAB5CF2}, {"Mg", 1.73, 1.41, 0x8AFF00},
    {"Al", 1.84, 1.21, 0xBFA6A6}, {"Si", 2.10, 1.11, 0xF0C8A0}, {"P", 1.80, 1.07, 0xFF8000},
    {"S", 1.80, 1.05, 0xFFFF30}, {"Cl", 1.75, 1.02, 0x1FF01F}, {"Ar", 1.88, 1.06, 0x80D1E3},
    {"K", 2.75, 2.03, 0x8F40D4}, {"Ca", 2.31, 1.76, 0x3DFF00}, {"Sc", 2.58, 1.70, 0xE6E6E6},
    {"Ti", 2.46, 1.60, 0xBFC2C7}, {"V", 2.42, 1.53, 0xA6A6AB}, {"Cr", 2.45, 1.39, 0x8A99C7},
    {"Mn", 2.45, 1.39, 0x9C7AC7}, {"Fe", 2.44, 1.32, 0xE06633}, {"Co", 2.40, 1.26, 0xF090A0},
    {"Ni", 2.40, 1.24, 0x50D050}, {"Cu", 2.38, 1.32, 0xC88033}, {"Zn", 2.39, 1.22, 0x7D80B0},
    {"Ga", 1.87, 1.22, 0xC28F8F}, {"Ge", 2.11, 1.20, 0x668F8F}, {"As", 1.85, 1.19, 0xBD80E3},
    {"Se", 1.90, 1.20, 0xFFA100}, {"Br", 1.85, 1.20, 0xA62929}, {"Kr", 2.02, 1.16, 0x5CB8D1},
    {"Rb", 3.03, 2.20, 0x702EB0}, {"Sr", 2.49, 1.95, 0x00FF00}, {"Y", 2.75, 1.90, 0x94FFFF},
    {"Zr", 2.52, 1.75, 0x94E0E0}, {"Nb", 2.56, 1.64, 0x73C2C9}, {"Mo", 2.45, 1.54, 0x54B5B5},
    {"Tc", 2.44, 1.47, 0x3B9E9E}, {"Ru", 2.46, 1.46, 0x248F8F}, {"Rh", 2.44, 1.42, 0x0A7D8C},
    {"Pd", 2.15, 1.39, 0x006985}, {"Ag", 2.53, 1.45, 0xC0C0C0}, {"Cd", 2.49, 1.44, 0xFFD98F},
    {"In", 1.93, 1.42, 0xA67573}, {"Sn", 2.17, 1.39, 0x668080}, {"Sb", 2.06, 1.39, 0x9E63B5},
    {"Te", 2.06, 1.38, 0xD47A00}, {"I", 1.98, 1.39, 0x940094}, {"Xe", 2.16, 1.40, 0x429EB0},
    {"Cs", 3.43, 2.44, 0x57178F}, {"Ba", 2.68, 2.15, 0x00C900}, {"La", 2.98, 2.07, 0x70D4FF},
    {"Ce", 2.88, 2.04, 0xFFFFC7}, {"Pr", 2.92, 2.03, 0xD9FFC7}, {"Nd", 2.95, 2.01, 0xC7FFC7},
    {"Pm", 2.00, 1.99, 0xA3FFC7}, {"Sm", 2.90, 1.98, 0x8FFFC7}, {"Eu", 2.87, 1.98, 0x61FFC7},
    {"Gd", 2.83, 1.96, 0x45FFC7}, {"Tb", 2.79, 1.94, 0x30FFC7}, {"Dy", 2.87, 1.92, 0x1FFFC7},
    {"Ho", 2.81, 1.92, 0x00FF9C}, {"Er", 2.83, 1.89, 0x00E675}, {"Tm", 2.79, 1.90, 0x00D452},
    {"Yb", 2.80, 1.87, 0x00BF38}, {"Lu", 2.74, 1.87, 0x00AB24}, {"Hf", 2.63, 1.75, 0x4DC2FF},
    {"Ta", 2.53, 1.70, 0x4DA6FF}, {"W", 2.57, 1.62, 0x2194D6}, {"Re", 2.49, 1.51, 0x267DAB},
    {"Os", 2.48, 1.44, 0x266696}, {"Ir", 2.41, 1.41, 0x175487}, {"Pt", 2.29, 1.36, 0xD0D0E0},
    {"Au", 2.32, 1.36, 0xFFD123}, {"Hg", 2.45, 1.32, 0xB8B8D0}, {"Tl", 1.96, 1.45, 0xA6544D},
    {"Pb", 2.02, 1.46, 0x575961}, {"Bi", 2.07, 1.48, 0x9E4FB5}, {"Po", 1.97, 1.40, 0xAB5C00},
    {"At", 2.02, 1.50, 0x754F45}, {"Rn", 2.20, 1.50, 0x428296}, {"Fr", 3.48, 2.60, 0x420066},
    {"Ra", 2.83, 2.21, 0x007D00}, {"Ac", 2.80, 2.15, 0x70ABFA}, {"Th", 2.93, 2.06, 0x00BAFF},
    {"Pa", 2.88, 2.00, 0x00A1FF}, {"U", 2.71, 1.96, 0x008FFF}, {"Np", 2.82, 1.90, 0x0080FF},
    {"Pu", 2.81, 1.87, 0x006BFF}, {"Am", 2.83, 1.80, 0x545CF2}, {"Cm", 3.05, 1.69, 0x785CE3},
    {"Bk", 3.40, 1.68, 0x8A4FE3}, {"Cf", 3.05, 1.68, 0xA136D4}, {"Es", 2.70, 1.65, 0xB31FD4},
    {"Fm", 2.00, 1.67, 0xB31FBA}, {"Md", 2.00, 1.73, 0xB30DA6}, {"No", 2.00, 1.76, 0xBD0D87},
    {"Lr", 2.00, 1.61, 0xC70066}, {"Rf", 2.00, 1.57, 0xCC0059}, {"Db", 2.00, 1.49, 0xD1004F},
    {"Sg", 2.00, 1.43, 0xD90045}, {"Bh", 2.00, 1.41, 0xE00038}, {"Hs", 2.00, 1.34, 0xE6002E},
    {"Mt", 2.00, 1.29, 0xEB0026}, {"Ds", 2.00, 1.28, 0xEB0026}, {"Rg", 2.00, 1.21, 0xEB0026},
    {"Cn", 2.00, 1.22, 0xEB0026}, {"Nh", 2.00, 1.36, 0xEB0026}, {"Fl", 2.00, 1.43, 0xEB0026},
    {"Mc", 2.00, 1.62, 0xEB0026}, {"Lv", 2.00, 1.75, 0xEB0026}, {"Ts", 2.00, 1.65, 0xEB0026},
    {"Og", 2.00, 1.57, 0xEB0026}};
// clang-format on
constexpr int kCount = static_cast<int>(std::size(kElements));

}  // namespace

bool is_metal(const Element& element) {
  constexpr std::string_view kOthers[] = {"H",  "He", "B",  "C",  "N",  "O",  "F",  "Ne", "Si", "P",  "S",
                                          "Cl", "Ar", "As", "Se", "Br", "Kr", "Te", "I",  "Xe", "At", "Rn"};
  return std::find(std::begin(kOthers), std::end(kOthers), element.symbol) == std::end(kOthers);
}

const Element* find_element(int number) {
  return number >= 1 && number <= kCount ? &kElements[static_cast<std::size_t>(number) - 1] : nullptr;
}

const Element* find_element(std::string_view word) {
  const std::string_view symbol = trimmed(word);
  const auto is = [&](std::string_view other) {  // without case
    return std::equal(symbol.begin(), symbol.end(), other.begin(), other.end(),
                      [](char a, char b) { return a == b || ((a ^ b) == 0x20 && std::isalpha(a) != 0); });
  };
  if (is("D")) return find_element(1);
  for (const Element& element : kElements)
    if (is(element.symbol)) return &element;
  int number = 0;
  return base::from_text(symbol, number) ? find_element(number) : nullptr;
}

}  // namespace orrery::data
