// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "data/byte_source.h"
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
  std::string insertion;  ///< insertion code: distinguishes residues with the same number
  std::string element;    ///< "C", "Zn"; "X": unknown
  std::string chain;
  std::string subchain;  ///< mmCIF: label_asym_id, to which assemblies refer
  std::string name;      ///< "CA"
  std::string residue;   ///< "ALA"
  std::string altloc;    ///< identifier of the alternate location; empty: the atom has only one
  std::string record;    ///< "ATOM", "HETATM"
};

/// The table of atoms that PDB and mmCIF share. Of the alternate locations of an atom, which would be overlapping
/// spheres, only the one with the highest occupancy is kept; of equal ones, the first.
class AtomTable {
 public:
  /// Adds an atom, or replaces an alternate location of the same atom.
  ///
  /// Result     its row
  std::size_t add(const Atom& atom);

  std::uint64_t rows() const { return numbers_.size(); }
  /// Memory of the rows, bytes.
  std::uint64_t memory() const {
    return rows() * (3 * sizeof(double) + 2 * sizeof(float) + (1 + std::tuple_size_v<decltype(texts_)>)*4);
  }

  /// Describes the table.
  ///
  /// `has_subchains`   true: lists the column `subchain`, and assigns it the role of the chain
  FrameInfo info(bool has_subchains) const;

  Table table(const std::vector<std::string>& columns) const;

 private:
  /// A text column under construction.
  struct Texts {
    Dictionary<> words;
    std::vector<std::uint32_t> index;  ///< one per row
  };

  void set(std::size_t row, const Atom& atom);

  std::array<std::vector<double>, 3> position_;
  std::vector<float> b_factors_, occupancies_;
  std::vector<std::int32_t> numbers_;
  std::array<Texts, 7> texts_;
  std::unordered_map<std::string, std::size_t> alternates_;  ///< rows of atoms with alternate locations
};

/// Checks whether there is enough memory to parse all atoms of a text file at once.
///
/// `bytes`    size of the text
/// `factor`   bytes of memory per byte of text, as measured
/// `held`     bytes that the file takes in memory already
/// `limit`    bytes; 0: none
/// Errors     base::Error(kNoMemory) with the needed size
void require_parse_memory(const std::filesystem::path& file, std::uint64_t bytes, double factor, std::uint64_t held,
                          std::uint64_t limit);

/// Throws an error at the first control character: a file with binary data would lose atoms.
void require_text(const ByteSource& bytes, Faults& faults);

}  // namespace orrery::data
