// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "data/atom_table.h"
#include "data/faults.h"

namespace orrery::data {

/// The residues of a model: runs of rows with the same chain, number and insertion code.
class CifResidues {
 public:
  struct Residue {
    std::uint32_t first_row = 0;
    std::uint32_t insertion = 0;  ///< index into insertions()
  };

  /// Adds a row, the next one.
  void add(std::size_t row, const Atom& atom);

  const std::vector<Residue>& all() const { return residues_; }
  const std::vector<std::string>& insertions() const { return insertions_.words(); }
  std::uint64_t memory() const { return residues_.size() * sizeof(Residue); }

 private:
  std::vector<Residue> residues_;
  Dictionary<> insertions_;
  std::string chain_;  ///< of the last row, as are these
  std::int32_t number_ = 0;
};

/// An atom as the table _struct_conn names it.
struct CifAtomName {
  std::string chain;
  std::int32_t number = 0;
  std::string insertion, residue, name;

  std::string text() const;
};

/// The bonds of an mmCIF file: those that _struct_conn lists, and those within a residue, which _chem_comp_bond lists
/// for each component.
///
/// Reference  mmcif
class CifBonds {
 public:
  void add_component(const std::string& residue, const std::string& a, const std::string& b) {
    components_[residue].emplace_back(a, b);
  }
  void add_connection(CifAtomName a, CifAtomName b, std::uint64_t line) {
    connections_.push_back({std::move(a), std::move(b), line});
  }

  /// Estimates the number of bonds in a model.
  std::uint64_t estimate(std::uint64_t rows) const { return connections_.size() + (components_.empty() ? 0 : rows); }

  /// Returns the bonds of a model, see DataFile::bonds().
  std::vector<Bond> of_model(const AtomTable& atoms, const CifResidues& residues, Faults& faults) const;

 private:
  struct Connection {
    CifAtomName a, b;
    std::uint64_t line = 0;
  };

  std::unordered_map<std::string, std::vector<std::pair<std::string, std::string>>> components_;
  std::vector<Connection> connections_;
};

}  // namespace orrery::data
