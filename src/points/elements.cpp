// SPDX-License-Identifier: Apache-2.0
#include "points/elements.h"

#include <cstddef>
#include <iterator>

#include "data/columns.h"

namespace orrery::points {
namespace {

struct Row {
  double van_der_waals, covalent;
  std::uint32_t color;  ///< 0xRRGGBB
};

// clang-format off
constexpr Row kRows[] = {
    {1.20, 0.31, 0xE6E6E6},  // H
    {1.40, 0.28, 0xD9FFFF},  // He
    {1.82, 1.28, 0xCC80FF},  // Li
    {1.53, 0.96, 0xC2FF00},  // Be
    {1.92, 0.84, 0xFFB5B5},  // B
    {1.70, 0.76, 0x909090},  // C
    {1.55, 0.71, 0x3050F8},  // N
    {1.52, 0.66, 0xFF0D0D},  // O
    {1.47, 0.57, 0x90E050},  // F
    {1.54, 0.58, 0xB3E3F5},  // Ne
    {2.27, 1.66, 0xAB5CF2},  // Na
    {1.73, 1.41, 0x8AFF00},  // Mg
    {1.84, 1.21, 0xBFA6A6},  // Al
    {2.10, 1.11, 0xF0C8A0},  // Si
    {1.80, 1.07, 0xFF8000},  // P
    {1.80, 1.05, 0xFFFF30},  // S
    {1.75, 1.02, 0x1FF01F},  // Cl
    {1.88, 1.06, 0x80D1E3},  // Ar
    {2.75, 2.03, 0x8F40D4},  // K
    {2.31, 1.76, 0x3DFF00},  // Ca
    {2.58, 1.70, 0xE6E6E6},  // Sc
    {2.46, 1.60, 0xBFC2C7},  // Ti
    {2.42, 1.53, 0xA6A6AB},  // V
    {2.45, 1.39, 0x8A99C7},  // Cr
    {2.45, 1.39, 0x9C7AC7},  // Mn
    {2.44, 1.32, 0xE06633},  // Fe
    {2.40, 1.26, 0xF090A0},  // Co
    {2.40, 1.24, 0x50D050},  // Ni
    {2.38, 1.32, 0xC88033},  // Cu
    {2.39, 1.22, 0x7D80B0},  // Zn
    {1.87, 1.22, 0xC28F8F},  // Ga
    {2.11, 1.20, 0x668F8F},  // Ge
    {1.85, 1.19, 0xBD80E3},  // As
    {1.90, 1.20, 0xFFA100},  // Se
    {1.85, 1.20, 0xA62929},  // Br
    {2.02, 1.16, 0x5CB8D1},  // Kr
    {3.03, 2.20, 0x702EB0},  // Rb
    {2.49, 1.95, 0x00FF00},  // Sr
    {2.75, 1.90, 0x94FFFF},  // Y
    {2.52, 1.75, 0x94E0E0},  // Zr
    {2.56, 1.64, 0x73C2C9},  // Nb
    {2.45, 1.54, 0x54B5B5},  // Mo
    {2.44, 1.47, 0x3B9E9E},  // Tc
    {2.46, 1.46, 0x248F8F},  // Ru
    {2.44, 1.42, 0x0A7D8C},  // Rh
    {2.15, 1.39, 0x006985},  // Pd
    {2.53, 1.45, 0xC0C0C0},  // Ag
    {2.49, 1.44, 0xFFD98F},  // Cd
    {1.93, 1.42, 0xA67573},  // In
    {2.17, 1.39, 0x668080},  // Sn
    {2.06, 1.39, 0x9E63B5},  // Sb
    {2.06, 1.38, 0xD47A00},  // Te
    {1.98, 1.39, 0x940094},  // I
    {2.16, 1.40, 0x429EB0},  // Xe
    {3.43, 2.44, 0x57178F},  // Cs
    {2.68, 2.15, 0x00C900},  // Ba
    {2.98, 2.07, 0x70D4FF},  // La
    {2.88, 2.04, 0xFFFFC7},  // Ce
    {2.92, 2.03, 0xD9FFC7},  // Pr
    {2.95, 2.01, 0xC7FFC7},  // Nd
    {2.00, 1.99, 0xA3FFC7},  // Pm
    {2.90, 1.98, 0x8FFFC7},  // Sm
    {2.87, 1.98, 0x61FFC7},  // Eu
    {2.83, 1.96, 0x45FFC7},  // Gd
    {2.79, 1.94, 0x30FFC7},  // Tb
    {2.87, 1.92, 0x1FFFC7},  // Dy
    {2.81, 1.92, 0x00FF9C},  // Ho
    {2.83, 1.89, 0x00E675},  // Er
    {2.79, 1.90, 0x00D452},  // Tm
    {2.80, 1.87, 0x00BF38},  // Yb
    {2.74, 1.87, 0x00AB24},  // Lu
    {2.63, 1.75, 0x4DC2FF},  // Hf
    {2.53, 1.70, 0x4DA6FF},  // Ta
    {2.57, 1.62, 0x2194D6},  // W
    {2.49, 1.51, 0x267DAB},  // Re
    {2.48, 1.44, 0x266696},  // Os
    {2.41, 1.41, 0x175487},  // Ir
    {2.29, 1.36, 0xD0D0E0},  // Pt
    {2.32, 1.36, 0xFFD123},  // Au
    {2.45, 1.32, 0xB8B8D0},  // Hg
    {1.96, 1.45, 0xA6544D},  // Tl
    {2.02, 1.46, 0x575961},  // Pb
    {2.07, 1.48, 0x9E4FB5},  // Bi
    {1.97, 1.40, 0xAB5C00},  // Po
    {2.02, 1.50, 0x754F45},  // At
    {2.20, 1.50, 0x428296},  // Rn
    {3.48, 2.60, 0x420066},  // Fr
    {2.83, 2.21, 0x007D00},  // Ra
    {2.80, 2.15, 0x70ABFA},  // Ac
    {2.93, 2.06, 0x00BAFF},  // Th
    {2.88, 2.00, 0x00A1FF},  // Pa
    {2.71, 1.96, 0x008FFF},  // U
    {2.82, 1.90, 0x0080FF},  // Np
    {2.81, 1.87, 0x006BFF},  // Pu
    {2.83, 1.80, 0x545CF2},  // Am
    {3.05, 1.69, 0x785CE3},  // Cm
    {3.40, 1.68, 0x8A4FE3},  // Bk
    {3.05, 1.68, 0xA136D4},  // Cf
    {2.70, 1.65, 0xB31FD4},  // Es
    {2.00, 1.67, 0xB31FBA},  // Fm
    {2.00, 1.73, 0xB30DA6},  // Md
    {2.00, 1.76, 0xBD0D87},  // No
    {2.00, 1.61, 0xC70066},  // Lr
    {2.00, 1.57, 0xCC0059},  // Rf
    {2.00, 1.49, 0xD1004F},  // Db
    {2.00, 1.43, 0xD90045},  // Sg
    {2.00, 1.41, 0xE00038},  // Bh
    {2.00, 1.34, 0xE6002E},  // Hs
    {2.00, 1.29, 0xEB0026},  // Mt
    {2.00, 1.28, 0xEB0026},  // Ds
    {2.00, 1.21, 0xEB0026},  // Rg
    {2.00, 1.22, 0xEB0026},  // Cn
    {2.00, 1.36, 0xEB0026},  // Nh
    {2.00, 1.43, 0xEB0026},  // Fl
    {2.00, 1.62, 0xEB0026},  // Mc
    {2.00, 1.75, 0xEB0026},  // Lv
    {2.00, 1.65, 0xEB0026},  // Ts
    {2.00, 1.57, 0xEB0026},  // Og
};
// clang-format on

constexpr std::size_t kCount = data::kElementSymbols.size();
static_assert(std::size(kRows) == kCount);

constexpr Srgb8 srgb8(std::uint32_t code) {
  return {static_cast<std::uint8_t>(code >> 16), static_cast<std::uint8_t>(code >> 8), static_cast<std::uint8_t>(code)};
}

constexpr std::array<Element, kCount> make_elements() {
  std::array<Element, kCount> out{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const Row& row = kRows[i];
    out[i] = {data::kElementSymbols[i], row.van_der_waals, row.covalent, srgb8(row.color)};
  }
  return out;
}

constexpr std::array<Element, kCount> kElements = make_elements();

}  // namespace

double Element::radius(ElementRadius kind) const {
  switch (kind) {
    case ElementRadius::kVanDerWaals: return van_der_waals;
    case ElementRadius::kCovalent: return covalent;
    case ElementRadius::kBall: return kBallScale * van_der_waals;
  }
  return van_der_waals;
}

const Element* find_element(int number) {
  return number >= 1 && number <= static_cast<int>(kCount) ? &kElements[static_cast<std::size_t>(number) - 1] : nullptr;
}

const Element* find_element(std::string_view symbol) { return find_element(data::atomic_number(symbol)); }

}  // namespace orrery::points
