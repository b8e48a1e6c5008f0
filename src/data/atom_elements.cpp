// SPDX-License-Identifier: Apache-2.0
#include "data/atom_elements.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "data/elements.h"
#include "data/text_lines.h"

namespace orrery::data {
namespace {

constexpr std::string_view kUnknown = "X";

/// Sorted. Beside the names of the Protein Data Bank those of AMBER (HIE, CYX, ASH, DA5, WAT), CHARMM (HSD, TIP3, ADE,
/// ASPP) and GROMACS (SOL, LYSH), and of caps.
constexpr std::string_view kStandard[] = {
    "A",   "A3",  "A5",  "ACE",  "ADE",  "ALA",  "ARG", "ARGN", "ASH",  "ASN",  "ASP", "ASPH", "ASPP", "C",    "C3",
    "C5",  "CYM", "CYS", "CYS2", "CYSH", "CYT",  "CYX", "DA",   "DA3",  "DA5",  "DC",  "DC3",  "DC5",  "DG",   "DG3",
    "DG5", "DI",  "DOD", "DT",   "DT3",  "DT5",  "DU",  "G",    "G3",   "G5",   "GLH", "GLN",  "GLU",  "GLUH", "GLUP",
    "GLY", "GUA", "H2O", "HID",  "HIE",  "HIP",  "HIS", "HISA", "HISB", "HISH", "HOH", "HSD",  "HSE",  "HSP",  "HYP",
    "ILE", "LEU", "LSN", "LYN",  "LYS",  "LYSH", "MET", "NH2",  "NHE",  "NME",  "OPC", "PHE",  "PRO",  "RA",   "RC",
    "RG",  "RU",  "SEC", "SER",  "SOL",  "SPC",  "T",   "T3P",  "T4P",  "THR",  "THY", "TIP",  "TIP3", "TIP4", "TIP5",
    "TP3", "TRP", "TYR", "U",    "U3",   "U5",   "URA", "VAL",  "WAT"};
static_assert(std::is_sorted(std::begin(kStandard), std::end(kStandard)));

/// Ions whose names in CHARMM and AMBER are not symbols.
constexpr std::pair<std::string_view, std::string_view> kIons[] = {
    {"BAR", "Ba"}, {"CAD", "Cd"}, {"CAL", "Ca"}, {"CES", "Cs"}, {"CIO", "Cs"},
    {"CLA", "Cl"}, {"LIT", "Li"}, {"POT", "K"},  {"RUB", "Rb"}, {"SOD", "Na"}};

/// Symbols that are more likely than an atom of their first letter, also in a file of left-aligned names: CA and HG are
/// mostly carbon and hydrogen, CL and FE are what they say.
constexpr std::string_view kDistinct[] = {"Ag", "Al", "Au", "Br", "Cl", "Cu", "Fe", "Li", "Mg",
                                          "Mn", "Mo", "Pt", "Rh", "Ru", "Se", "Si", "Zn"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// The symbol of a name without case; empty if there is none. An isotope or a number is none.
std::string_view symbol_of(std::string_view letters) {
  const Element* const element = letters.empty() || !is_letter(letters[0]) ? nullptr : find_element(letters);
  return element == nullptr ? std::string_view() : element->symbol;
}

/// A name without the digits before it and whatever follows its letters: "1HB" is HB, "Na+" is Na.
std::string_view letters_of(std::string_view name) {
  name.remove_prefix(std::min(name.find_first_not_of("0123456789"), name.size()));
  const auto end = std::find_if_not(name.begin(), name.end(), is_letter);
  return name.substr(0, static_cast<std::size_t>(end - name.begin()));
}

/// The element of an atom in a standard residue: its first letter. Coarse-grained models have residues of these names,
/// too, with beads such as BB and SC1, and models of water have sites without atoms.
std::string_view element_in_standard(std::string_view letters) {
  switch (letters.empty() ? '\0' : letters[0]) {
    case 'C': return "C";
    case 'N': return "N";
    case 'O': return "O";
    case 'P': return "P";
    case 'H':
    case 'D': return "H";
    case 'S': return letters == "SE" ? "Se" : letters == "SC" ? kUnknown : "S";
    default: return kUnknown;
  }
}

}  // namespace

bool is_standard_residue(std::string_view name) {
  if (std::binary_search(std::begin(kStandard), std::end(kStandard), name)) return true;
  // AMBER's residues at the ends of a chain: NALA, CALA.
  return name.size() == 4 && (name[0] == 'N' || name[0] == 'C') &&
         std::binary_search(std::begin(kStandard), std::end(kStandard), name.substr(1));
}

std::string_view AtomElements::element_of(std::string_view field, std::string_view residue) {
  key_.assign(field).append(residue);
  const auto [at, is_new] = known_.try_emplace(key_);
  if (is_new) at->second = deduced(field, residue);
  const auto [element, is_guess] = at->second;
  if (element == kUnknown)
    unknown_.add(trimmed(field), residue, element);
  else if (is_guess)
    guessed_.add(trimmed(field), residue, element);
  return element;
}

AtomElements::Deduced AtomElements::deduced(std::string_view field, std::string_view residue) const {
  const std::string_view name = trimmed(field), letters = letters_of(name);
  std::string_view element;
  bool is_guess = false;
  if (is_standard_residue(residue)) {
    element = element_in_standard(letters);
  } else if (const auto ion = std::find_if(std::begin(kIons), std::end(kIons),
                                           [&](const auto& i) { return i.first == residue && i.first == name; });
             ion != std::end(kIons)) {
    element = ion->second;
  } else if (const std::string_view symbol = symbol_of(letters);
             !symbol.empty() && base::lower(letters) == base::lower(letters_of(residue))) {
    element = symbol;  // an ion: CA of CA, Na+ of Na+
  } else {
    const std::string_view one = symbol_of(letters.substr(0, 1));
    std::string_view two = letters.size() < 2 ? std::string_view() : symbol_of(letters.substr(0, 2));
    // Hydrogens have names of four letters, and two-letter elements that begin with H nearly never.
    const bool is_hydrogen = letters.starts_with('H') && name.size() == 4;
    // " CA " is aligned as carbon, and "1HG" begins with a number.
    if (field.starts_with(' ') || name.substr(0, 2) != letters.substr(0, 2) || is_hydrogen) two = {};
    is_guess = !one.empty() && !two.empty();
    if (is_guess && is_left_aligned_ &&
        std::find(std::begin(kDistinct), std::end(kDistinct), two) == std::end(kDistinct))
      two = {};
    element = !two.empty() ? two : !one.empty() ? one : kUnknown;
  }
  return {element, is_guess};
}

void AtomElements::Doubts::add(std::string_view name, std::string_view residue, std::string_view element) {
  constexpr int kMaxListed = 3;
  ++atoms;
  if (listed == kMaxListed) return;
  const std::string example = fmt::format("{} of {}{}", name, residue.empty() ? "a residue without a name" : residue,
                                          element == kUnknown ? "" : fmt::format(" is {}", element));
  if (examples.find(example) != std::string::npos) return;
  examples += (listed == 0 ? "" : ", ") + example;
  ++listed;
}

std::string AtomElements::warning() const {
  if (guessed_.atoms == 0 && unknown_.atoms == 0) return {};
  std::string out = "the file does not list elements";
  if (guessed_.atoms > 0)
    out += fmt::format("; those of {} were guessed from names: {}", base::counted(guessed_.atoms, "atom"),
                       guessed_.examples);
  if (unknown_.atoms > 0)
    out += fmt::format("; those of {} are unknown: {}", base::counted(unknown_.atoms, "atom"), unknown_.examples);
  return out;
}

}  // namespace orrery::data
