// SPDX-License-Identifier: Apache-2.0
#include "data/cif_bonds.h"

#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <variant>

#include <fmt/core.h>

#include "data/bonds.h"

namespace orrery::data {

namespace {

/// The columns of a model that name its atoms, and its residues.
class AtomNames {
 public:
  AtomNames(const AtomTable& atoms, const CifResidues& residues)
      : table_(atoms.table({"chain", "residue", "name", "residue_number"})),
        chains_(std::get<Words>(table_.columns[0].values)),
        components_(std::get<Words>(table_.columns[1].values)),
        names_(std::get<Words>(table_.columns[2].values)),
        numbers_(std::get<std::vector<std::int32_t>>(table_.columns[3].values)),
        residues_(residues) {}

  std::size_t rows() const { return table_.rows; }
  const Words& components() const { return components_; }
  const Words& names() const { return names_; }

  /// Calls f(residue, first row, row after the last) for each residue.
  template <class F>
  void each_residue(F f) const {
    const auto& all = residues_.all();
    for (std::size_t i = 0; i < all.size(); ++i)
      f(all[i], all[i].first_row, i + 1 < all.size() ? all[i + 1].first_row : static_cast<std::uint32_t>(rows()));
  }

  /// The name of an atom in _struct_conn: chain, residue number, insertion code, component, atom.
  using Key = std::tuple<std::string_view, std::int32_t, std::string_view, std::string_view, std::string_view>;

  /// Calls f(value of the name, row) for each atom that has one of the names.
  ///
  /// `names`    a map from names
  template <class Map, class F>
  void each_named(Map& names, F f) const {
    each_residue([&](const CifResidues::Residue& residue, std::uint32_t first, std::uint32_t end) {
      Key key{chains_.words[chains_.index[first]], numbers_[first], residues_.insertions()[residue.insertion], {}, {}};
      const auto next = names.lower_bound(key);
      const auto residue_of = [](const Key& k) { return std::tuple(std::get<0>(k), std::get<1>(k), std::get<2>(k)); };
      if (next == names.end() || residue_of(next->first) != residue_of(key)) return;
      for (std::uint32_t row = first; row < end; ++row) {
        std::get<3>(key) = components_.words[components_.index[row]];
        std::get<4>(key) = names_.words[names_.index[row]];
        if (const auto found = names.find(key); found != names.end()) f(found->second, row);
      }
    });
  }

 private:
  Table table_;
  const Words& chains_;
  const Words& components_;
  const Words& names_;
  const std::vector<std::int32_t>& numbers_;
  const CifResidues& residues_;
};

AtomNames::Key key_of(const CifAtomName& atom) {
  return {atom.chain, atom.number, atom.insertion, atom.residue, atom.name};
}

/// The first row of an atom's name, and how many have it.
struct NamedRows {
  std::uint32_t first = 0;
  std::size_t count = 0;
};

/// Indices of strings; strings that do not occur have none.
class Indices {
 public:
  explicit Indices(const Words& column) {
    for (std::uint32_t i = 0; i < column.words.size(); ++i) indices_.emplace(column.words[i], i);
  }
  std::optional<std::uint32_t> of(const std::string& word) const {
    const auto at = indices_.find(word);
    return at == indices_.end() ? std::nullopt : std::optional(at->second);
  }

 private:
  std::unordered_map<std::string_view, std::uint32_t> indices_;
};

/// The bonds of a component: to each atom's name, the names of others, as indices.
using Component = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;

/// Adds the bonds within a residue. In files without residue numbers, all water is one residue: a name that occurs
/// again begins the next molecule.
class ResidueBonds {
 public:
  ResidueBonds(const AtomNames& atoms, const std::unordered_map<std::uint32_t, Component>& components,
               std::vector<Bond>& out)
      : atoms_(atoms), components_(components), out_(out) {}

  void add(std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t row = first; row < end; ++row) {
      const std::uint32_t name = atoms_.names().index[row];
      if (rows_.count(name) > 0) finish();
      rows_.emplace(name, row);
    }
    finish();
  }

 private:
  void finish() {
    const auto& component_of = atoms_.components().index;
    for (const auto& [name, row] : rows_) {
      const auto component = components_.find(component_of[row]);
      if (component == components_.end()) continue;
      const auto partners = component->second.find(name);
      if (partners == component->second.end()) continue;
      for (const std::uint32_t partner : partners->second)
        if (const auto other = rows_.find(partner);
            other != rows_.end() && other->second != row && component_of[other->second] == component_of[row])
          out_.push_back(ordered_bond(row, other->second));
    }
    rows_.clear();
  }

  const AtomNames& atoms_;
  const std::unordered_map<std::uint32_t, Component>& components_;
  std::vector<Bond>& out_;
  std::unordered_map<std::uint32_t, std::uint32_t> rows_;  ///< by name
};

}  // namespace

void CifResidues::add(std::size_t row, const Atom& atom) {
  const std::uint32_t insertion = insertions_.index_of(atom.insertion);
  if (!residues_.empty() && chain_ == atom.chain && number_ == atom.residue_number &&
      residues_.back().insertion == insertion)
    return;
  residues_.push_back({static_cast<std::uint32_t>(row), insertion});
  chain_ = atom.chain;
  number_ = atom.residue_number;
}

std::string CifAtomName::text() const {
  return fmt::format("{} of {} {}{} in chain {}", name, residue, number, insertion, chain);
}

std::vector<Bond> CifBonds::of_model(const AtomTable& table, const CifResidues& residues, Faults& faults) const {
  std::vector<Bond> out;
  if (components_.empty() && connections_.empty()) return out;
  const AtomNames atoms(table, residues);

  const Indices component_indices(atoms.components()), name_indices(atoms.names());
  std::unordered_map<std::uint32_t, Component> components;
  for (const auto& [residue, pairs] : components_) {
    const auto component = component_indices.of(residue);
    if (!component) continue;
    for (const auto& [a, b] : pairs) {
      const auto first = name_indices.of(a), second = name_indices.of(b);
      if (!first || !second) continue;
      std::vector<std::uint32_t>& partners = components[*component][*first];
      partners.push_back(*second);
      if (partners.size() > kMaxBondsInFile)
        faults.fail(0,
                    fmt::format("_chem_comp_bond: atom {} of {} has more than {} bonds", a, residue, kMaxBondsInFile));
    }
  }
  ResidueBonds within(atoms, components, out);
  if (!components.empty())
    atoms.each_residue([&](const auto&, std::uint32_t first, std::uint32_t end) { within.add(first, end); });

  std::map<AtomNames::Key, NamedRows> rows_of;
  for (const Connection& connection : connections_)
    for (const CifAtomName* const atom : {&connection.a, &connection.b}) rows_of[key_of(*atom)] = {};
  if (!rows_of.empty())
    atoms.each_named(rows_of, [](NamedRows& rows, std::uint32_t row) {
      if (rows.count++ == 0) rows.first = row;
    });
  const auto row_of = [&](const CifAtomName& atom, std::uint64_t line) -> std::optional<std::uint32_t> {
    const NamedRows& rows = rows_of[key_of(atom)];
    if (rows.count == 1) return rows.first;
    faults.add_of_many(line, fmt::format("a bond of atom {}, {}", atom.text(),
                                         rows.count == 0 ? "which does not exist" : "but several atoms are named so"));
    return std::nullopt;
  };
  for (const Connection& connection : connections_) {
    const auto a = row_of(connection.a, connection.line), b = row_of(connection.b, connection.line);
    if (a && b && *a == *b)
      faults.add_of_many(connection.line, fmt::format("a bond of atom {} with itself", connection.a.text()));
    else if (a && b)
      out.push_back(ordered_bond(*a, *b));
  }
  finish_bonds(out, faults);
  return out;
}

}  // namespace orrery::data
