// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

namespace orrery::data {

/// Whether a residue is an amino acid, a nucleotide or water, by one of the names that programs give them.
bool is_standard_residue(std::string_view name);

/// Deduces the elements of a PDB file's atoms from their names, where the file does not list them.
///
/// The format aligns elements: " CA " is a carbon, "CA  " is calcium. AMBER, GROMACS and others write all names from
/// the first column, so only names of standard residues and of ions are sure.
class AtomElements {
 public:
  /// `is_left_aligned`   the file writes carbon as "CA  "
  explicit AtomElements(bool is_left_aligned = false) : is_left_aligned_(is_left_aligned) {}

  /// Returns the symbol of the element; "X" if it is unknown.
  ///
  /// `name`     the four columns
  std::string_view element_of(std::string_view name, std::string_view residue);

  /// Returns a warning about the elements that are guesses or unknown, with examples; empty if there are none.
  std::string warning() const;

 private:
  struct Deduced {
    std::string_view element;
    bool is_guess = false;  ///< the name could be that of another element
  };
  /// Atoms of which a warning tells, and the first few different ones.
  struct Doubts {
    std::uint64_t atoms = 0;
    std::string examples;
    int listed = 0;

    void add(std::string_view name, std::string_view residue, std::string_view element);
  };

  Deduced deduced(std::string_view name, std::string_view residue) const;

  bool is_left_aligned_;
  std::unordered_map<std::string, Deduced> known_;  ///< by the four columns and the residue
  std::string key_;
  Doubts guessed_, unknown_;
};

}  // namespace orrery::data
