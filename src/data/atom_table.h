// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "data/dictionary.h"
#include "data/faults.h"
#include "data/table.h"

namespace orrery::data {

/// An atom of a PDB or mmCIF file.
struct Atom {
  Vec3d position{0, 0, 0};  ///< ångström
  double b_factor = 0;
  double occupancy = 1;
  std::int32_t residue_number = 0;
  bool has_residue_number = true;
  std::string_view insertion;  ///< insertion code: distinguishes residues with the same number
  std::string_view element;    ///< "C", "Zn"; "X": unknown
  std::string_view chain;
  std::string_view subchain;  ///< mmCIF: label_asym_id, to which assemblies refer
  std::string_view segment;   ///< PDB: segment id of simulations
  std::string_view name;      ///< "CA"
  std::string_view residue;   ///< "ALA"
  std::string_view altloc;    ///< identifier of the alternate location; empty: the atom has only one
  std::string_view record;    ///< "ATOM", "HETATM"
};

/// The table of atoms that PDB and mmCIF share. Of the alternate locations of an atom, which would be overlapping
/// spheres, only the one with the highest occupancy is kept; of equal ones, the first.
class AtomTable {
  static constexpr std::size_t kTextColumns = 8;

 public:
  /// Adds an atom, or replaces an alternate location of the same atom.
  ///
  /// Result     its row
  std::size_t add(const Atom& atom);

  void reserve(std::size_t rows);
  std::uint64_t rows() const { return numbers_.size(); }
  /// Memory of a row, and of all, bytes.
  static constexpr std::uint64_t kBytesPerRow = 3 * sizeof(double) + 2 * sizeof(float) + (1 + kTextColumns) * 4;
  std::uint64_t memory() const { return rows() * kBytesPerRow; }

  /// Describes the table. The columns `subchain`, which has the role of the chain, and `segment` are listed if an atom
  /// has any.
  FrameInfo info() const;

  Table table(const std::vector<std::string>& columns) const;

 private:
  /// A text column under construction.
  struct Texts {
    Dictionary<> words;
    std::vector<std::uint32_t> index;  ///< one per row
  };

  /// The alternate locations of an atom.
  struct Alternates {
    std::size_t row = 0;
    std::string locations;  ///< those added, each followed by a newline
  };

  bool is_alternate(const Alternates& known, const Atom& atom) const;
  void set(std::size_t row, const Atom& atom);

  std::array<std::vector<double>, 3> position_;
  std::vector<float> b_factors_, occupancies_;
  std::vector<std::int32_t> numbers_;
  std::array<Texts, kTextColumns> texts_;
  std::unordered_map<std::string, Alternates> alternates_;  ///< atoms with alternate locations, by their identity
};

/// Checks whether there is enough memory to parse all atoms of a text file at once.
///
/// `count`    of atoms, or of bytes of text
/// `factor`   bytes of memory for each
/// `held`     bytes that the file takes in memory already
/// `limit`    bytes; 0: none
/// Errors     base::Error(kNoMemory) with the needed size
void require_parse_memory(const std::filesystem::path& file, std::uint64_t count, double factor, std::uint64_t held,
                          std::uint64_t limit);

/// Throws an error at the first control character of a text: a file with binary data would lose atoms.
///
/// `line`     number of the first line, then of the last
void require_text(std::string_view text, std::uint64_t& line, Faults& faults);

}  // namespace orrery::data
