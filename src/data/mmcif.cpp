// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <gemmi/elem.hpp>
#include <gemmi/numb.hpp>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/atom_table.h"
#include "data/bonds.h"
#include "data/cif_rows.h"
#include "data/readers.h"
#include "data/text_lines.h"

namespace orrery::data {

namespace {

/// Maximum number of transforms in a file. The largest viruses need a few thousand.
constexpr std::size_t kMaxTransforms = 1'000'000;

/// The words of a list, whose separators may be commas or white space.
std::vector<std::string> split(const std::string& list) {
  const std::vector<std::string_view> words = words_of(list, ", \t\r\n");
  return {words.begin(), words.end()};
}

/// Splits "1,(1-60)(P)" into a term "1" and one of the factors "1-60" and "P". Empty if parentheses are not balanced.
std::vector<std::vector<std::string>> terms_of(const std::string& expression) {
  std::vector<std::vector<std::string>> terms(1);
  bool is_open = false, begins_factor = true;
  for (const char c : expression) {
    if (c == '(' || c == ')') {
      if (is_open == (c == '(')) return {};
      is_open = c == '(';
      begins_factor = true;
    } else if (c == ',' && !is_open) {
      terms.emplace_back();
      begins_factor = true;
    } else {
      if (std::exchange(begins_factor, false)) terms.back().emplace_back();
      terms.back().back() += c;
    }
  }
  if (is_open) return {};
  for (std::vector<std::string>& factors : terms)
    std::erase_if(factors, [](const std::string& factor) { return split(factor).empty(); });
  std::erase_if(terms, [](const auto& factors) { return factors.empty(); });
  return terms;
}

Vec3d product(const Transform& t, Vec3d p) { return {dot(t.rows[0], p), dot(t.rows[1], p), dot(t.rows[2], p)}; }

/// `second` after `first`.
Transform composed(const Transform& second, const Transform& first) {
  const Vec3d x = product(second, {first.rows[0].x, first.rows[1].x, first.rows[2].x});
  const Vec3d y = product(second, {first.rows[0].y, first.rows[1].y, first.rows[2].y});
  const Vec3d z = product(second, {first.rows[0].z, first.rows[1].z, first.rows[2].z});
  return {{Vec3d{x.x, y.x, z.x}, Vec3d{x.y, y.y, z.y}, Vec3d{x.z, y.z, z.z}},
          product(second, first.translation) + second.translation};
}

/// Builds the biological assemblies of an mmCIF file from the tables _pdbx_struct_oper_list and
/// _pdbx_struct_assembly_gen, which may come in any order.
///
/// Reference  mmcif
class CifAssemblies {
 public:
  void add_operator(const std::string& id, const Transform& transform) { operators_[id] = transform; }

  /// Adds a part of an assembly: chains, and the expression of their transforms.
  ///
  /// `expression`   "1", "1,3", "(1-60)", "(1-5)(X0)"
  /// `chains`       "A,B,C"
  void add_part(const std::string& assembly, const std::string& expression, const std::string& chains,
                std::uint64_t line) {
    parts_.push_back({assembly, expression, chains, line});
  }

  /// Returns the assemblies in the order of the file; none if the file defines no operators.
  ///
  /// Errors     base::Error(kBadData): undefined operators, malformed expressions, too many transforms
  std::vector<Assembly> finish(Faults& faults) const {
    std::vector<Assembly> assemblies;
    if (operators_.empty()) return assemblies;
    std::unordered_map<std::string, std::size_t> index_of;
    std::size_t total = 0;
    for (const Part& part : parts_) {
      AssemblyPart out{split(part.chains), transforms_of(part, faults)};
      if ((total += out.transforms.size()) > kMaxTransforms)
        faults.fail(part.line, fmt::format("the assemblies have more than {} transforms", kMaxTransforms));
      const auto [same, is_new] = index_of.try_emplace(part.assembly, assemblies.size());
      if (is_new) assemblies.push_back({part.assembly, {}});
      assemblies[same->second].parts.push_back(std::move(out));
    }
    return assemblies;
  }

 private:
  struct Part {
    std::string assembly, expression, chains;
    std::uint64_t line = 0;
  };

  std::vector<Transform> transforms_of(const Part& part, Faults& faults) const {
    const auto add = [&](const std::string& id, std::vector<Transform>& out) {
      const auto it = operators_.find(id);
      if (it == operators_.end())
        faults.fail(part.line, fmt::format("assembly {}: the operator `{}` is not defined", part.assembly, id));
      if (out.size() == kMaxTransforms)
        faults.fail(part.line, fmt::format("assembly {}: more than {} operators", part.assembly, kMaxTransforms));
      out.push_back(it->second);
    };
    const auto terms = terms_of(part.expression);
    std::vector<Transform> result;
    for (const std::vector<std::string>& factors : terms) {
      std::vector<Transform> products = {Transform{}};
      for (const std::string& factor : factors) {
        std::vector<Transform> transforms;
        for (const std::string& word : split(factor)) {
          const std::size_t dash = word.find('-');
          int first = 0, last = 0;
          if (dash != std::string::npos && base::from_text(word.substr(0, dash), first) &&
              base::from_text(word.substr(dash + 1), last)) {
            // Stops at the first undefined number, however large the range.
            for (std::int64_t id = first; id <= last; ++id) add(std::to_string(id), transforms);
          } else {
            add(word, transforms);
          }
        }
        if (result.size() + transforms.size() * products.size() > kMaxTransforms)
          faults.fail(part.line, fmt::format("assembly {}: more than {} transforms", part.assembly, kMaxTransforms));
        // The rightmost factor is applied first.
        std::vector<Transform> longer;
        for (const Transform& second : products)
          for (const Transform& first : transforms) longer.push_back(composed(second, first));
        products = std::move(longer);
      }
      result.insert(result.end(), products.begin(), products.end());
    }
    if (result.empty())
      faults.fail(part.line, fmt::format("assembly {}: `{}` has no operators, or unbalanced parentheses", part.assembly,
                                         part.expression));
    return result;
  }

  std::map<std::string, Transform> operators_;
  std::vector<Part> parts_;
};

/// The residues of a model: runs of rows with the same chain, number and insertion code.
class CifResidues {
 public:
  /// Adds a row, the next one.
  void add(std::size_t row, const Atom& atom) {
    const std::uint32_t insertion = insertions_.index_of(atom.insertion);
    if (!residues_.empty() && chain_ == atom.chain && number_ == atom.residue_number &&
        residues_.back().insertion == insertion)
      return;
    residues_.push_back({static_cast<std::uint32_t>(row), insertion});
    chain_ = atom.chain;
    number_ = atom.residue_number;
  }

  std::uint64_t memory() const { return residues_.size() * sizeof(Residue); }

  /// Calls f(insertion code, first row, row after the last) for each residue of a model with so many rows.
  template <class F>
  void each(std::size_t rows, F f) const {
    for (std::size_t i = 0; i < residues_.size(); ++i) {
      const std::size_t end = i + 1 < residues_.size() ? residues_[i + 1].first_row : rows;
      f(insertions_.words()[residues_[i].insertion], residues_[i].first_row, static_cast<std::uint32_t>(end));
    }
  }

 private:
  struct Residue {
    std::uint32_t first_row = 0;
    std::uint32_t insertion = 0;  ///< index into `insertions_`
  };

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

  std::string text() const { return fmt::format("{} of {} {}{} in chain {}", name, residue, number, insertion, chain); }
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
  std::vector<Bond> of_model(const AtomTable& table, const CifResidues& residues, Faults& faults,
                             std::vector<std::string>& warnings) const {
    std::vector<Bond> out;
    if (components_.empty() && connections_.empty()) return out;
    const Atoms atoms(table);
    add_within_residues(atoms, residues, faults, out);
    add_connected(atoms, residues, faults, out);
    warn_of_missing(faults, warnings);
    finish_bonds(out, faults);
    return out;
  }

 private:
  struct Connection {
    CifAtomName a, b;
    std::uint64_t line = 0;
  };

  /// The columns that name the atoms of a model.
  struct Atoms {
    explicit Atoms(const AtomTable& atoms)
        : table(atoms.table({"chain", "residue", "name", "residue_number"})),
          chains(std::get<Words>(table.columns[0].values)),
          components(std::get<Words>(table.columns[1].values)),
          names(std::get<Words>(table.columns[2].values)),
          numbers(std::get<std::vector<std::int32_t>>(table.columns[3].values)) {}

    Table table;
    const Words &chains, &components, &names;
    const std::vector<std::int32_t>& numbers;
  };

  /// To the name of an atom in a component, the names of its partners, all as indices into the columns.
  using Partners = std::unordered_map<std::uint64_t, std::vector<std::uint32_t>>;
  static std::uint64_t partner_key(std::uint32_t component, std::uint32_t name) {
    return std::uint64_t{component} << 32 | name;
  }

  static std::unordered_map<std::string_view, std::uint32_t> indices_of(const Words& column) {
    std::unordered_map<std::string_view, std::uint32_t> out;
    for (std::uint32_t i = 0; i < column.words.size(); ++i) out.emplace(column.words[i], i);
    return out;
  }

  /// The partners in the components that occur in a model.
  Partners partners_in(const Atoms& atoms, Faults& faults) const {
    Partners out;
    const auto components = indices_of(atoms.components), names = indices_of(atoms.names);
    for (const auto& [residue, pairs] : components_) {
      const auto component = components.find(residue);
      if (component == components.end()) continue;
      for (const auto& [a, b] : pairs) {
        const auto first = names.find(a), second = names.find(b);
        if (first == names.end() || second == names.end()) continue;
        std::vector<std::uint32_t>& partners = out[partner_key(component->second, first->second)];
        partners.push_back(second->second);
        if (partners.size() > kMaxBondsInFile)
          faults.fail(
              0, fmt::format("_chem_comp_bond: atom {} of {} has more than {} bonds", a, residue, kMaxBondsInFile));
      }
    }
    return out;
  }

  /// In files without residue numbers, all water is one residue: a name that occurs again begins the next molecule.
  void add_within_residues(const Atoms& atoms, const CifResidues& residues, Faults& faults,
                           std::vector<Bond>& out) const {
    const Partners partners = partners_in(atoms, faults);
    if (partners.empty()) return;
    const std::vector<std::uint32_t>&component_of = atoms.components.index, &name_of = atoms.names.index;
    std::unordered_map<std::uint32_t, std::uint32_t> rows;  // of a molecule, by name
    const auto finish = [&] {
      for (const auto& [name, row] : rows) {
        const auto found = partners.find(partner_key(component_of[row], name));
        if (found == partners.end()) continue;
        for (const std::uint32_t partner : found->second)
          if (const auto other = rows.find(partner);
              other != rows.end() && other->second != row && component_of[other->second] == component_of[row])
            out.push_back(ordered_bond(row, other->second));
      }
      rows.clear();
    };
    residues.each(atoms.table.rows, [&](const std::string&, std::uint32_t first, std::uint32_t end) {
      for (std::uint32_t row = first; row < end; ++row) {
        if (rows.count(name_of[row]) > 0) finish();
        rows.emplace(name_of[row], row);
      }
      finish();
    });
  }

  /// Chain, number and insertion code of a residue; component and name of one of its atoms.
  using ResidueKey = std::tuple<std::string_view, std::int32_t, std::string_view>;
  using AtomKey = std::pair<ResidueKey, std::pair<std::string_view, std::string_view>>;
  static AtomKey key_of(const CifAtomName& atom) {
    return {{atom.chain, atom.number, atom.insertion}, {atom.residue, atom.name}};
  }

  void add_connected(const Atoms& atoms, const CifResidues& residues, Faults& faults, std::vector<Bond>& out) const {
    if (connections_.empty()) return;
    std::map<AtomKey, std::vector<std::uint32_t>> rows_of;
    for (const Connection& connection : connections_)
      for (const CifAtomName* const atom : {&connection.a, &connection.b}) rows_of[key_of(*atom)] = {};
    residues.each(atoms.table.rows, [&](const std::string& insertion, std::uint32_t first, std::uint32_t end) {
      const ResidueKey residue{atoms.chains.words[atoms.chains.index[first]], atoms.numbers[first], insertion};
      const auto next = rows_of.lower_bound({residue, {}});
      if (next == rows_of.end() || next->first.first != residue) return;
      for (std::uint32_t row = first; row < end; ++row) {
        const auto found = rows_of.find(
            {residue,
             {atoms.components.words[atoms.components.index[row]], atoms.names.words[atoms.names.index[row]]}});
        if (found != rows_of.end()) found->second.push_back(row);
      }
    });
    const auto row_of = [&](const CifAtomName& atom, std::uint64_t line) -> std::optional<std::uint32_t> {
      const std::vector<std::uint32_t>& rows = rows_of[key_of(atom)];
      if (rows.size() == 1) return rows[0];
      faults.add_of_many(line, fmt::format("a bond of atom {}, {}", atom.text(),
                                           rows.empty() ? "which does not exist" : "but several atoms are named so"));
      return std::nullopt;
    };
    for (const Connection& connection : connections_) {
      const auto a = row_of(connection.a, connection.line), b = row_of(connection.b, connection.line);
      if (a && b && *a == *b)
        faults.add_of_many(connection.line, fmt::format("a bond of atom {} with itself", connection.a.text()));
      else if (a && b)
        out.push_back(ordered_bond(*a, *b));
    }
  }

  std::unordered_map<std::string, std::vector<std::pair<std::string, std::string>>> components_;
  std::vector<Connection> connections_;
};

/// Items of _atom_site.
constexpr std::string_view kAtomItems[] = {
    "group_pdb",    "type_symbol",   "label_atom_id", "auth_atom_id", "label_alt_id",   "label_comp_id",
    "auth_comp_id", "label_asym_id", "auth_asym_id",  "auth_seq_id",  "label_seq_id",   "pdbx_pdb_ins_code",
    "cartn_x",      "cartn_y",       "cartn_z",       "occupancy",    "b_iso_or_equiv", "pdbx_pdb_model_num"};

const std::vector<std::string> kOperatorItems = {
    "id",           "matrix[1][1]", "matrix[1][2]", "matrix[1][3]", "vector[1]",    "matrix[2][1]", "matrix[2][2]",
    "matrix[2][3]", "vector[2]",    "matrix[3][1]", "matrix[3][2]", "matrix[3][3]", "vector[3]"};

constexpr std::string_view kCifBlanks = " \t\r\n";

/// Items of _struct_conn. of each of the two atoms; {} is 1 or 2.
constexpr std::string_view kPartnerItems[] = {"ptnr{}_auth_asym_id",  "ptnr{}_label_asym_id",     "ptnr{}_auth_seq_id",
                                              "ptnr{}_label_seq_id",  "pdbx_ptnr{}_pdb_ins_code", "ptnr{}_auth_comp_id",
                                              "ptnr{}_label_comp_id", "ptnr{}_label_atom_id",     "ptnr{}_symmetry"};

/// The place of an item in a row; does not compile if there is no such item.
template <std::size_t kCount>
consteval std::size_t place_in(const std::string_view (&items)[kCount], std::string_view item) {
  std::size_t i = 0;
  while (items[i] != item) ++i;
  return i;
}
consteval std::size_t of_atom(std::string_view item) { return place_in(kAtomItems, item); }
consteval std::size_t of_partner(std::string_view item) { return place_in(kPartnerItems, item); }

/// Items of _struct_conn.: the type, then those of both atoms.
std::vector<std::string> connection_items() {
  std::vector<std::string> out = {"conn_type_id"};
  for (const char* const partner : {"1", "2"})
    for (const std::string_view item : kPartnerItems)
      out.push_back(std::string(item).replace(item.find("{}"), 2, partner));
  return out;
}

using Row = std::vector<std::string>;

/// The author's value, which users know, else the one assigned by the PDB.
const std::string& preferred(const Row& row, std::size_t author, std::size_t label) {
  return row[author].empty() ? row[label] : row[author];
}

/// 0 if there is no number.
std::int32_t residue_number(const std::string& text) {
  std::int32_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

class MmcifReader final : public DataFile {
 public:
  MmcifReader(const Bytes& bytes, const OpenOptions& options) : faults_(bytes->file()) {
    // Measured: 2.1 for short rows of atoms; longer rows take less.
    constexpr double kMemoryPerByte = 2.25;
    require_parse_memory(bytes->file(), bytes->size(), kMemoryPerByte, bytes->memory(), options.memory_limit);
    CifAssemblies assemblies;
    const auto take_operator = [&](const Row& row, std::uint64_t line) {
      if (is_past_atoms_) return;
      double v[12];
      for (std::size_t i = 0; i < 12; ++i) {
        v[i] = gemmi::cif::as_number(row[i + 1]);
        if (!std::isfinite(v[i]))
          faults_.fail(line, fmt::format("operator `{}` of the assemblies is malformed", row[0]));
      }
      assemblies.add_operator(
          row[0], {{Vec3d{v[0], v[1], v[2]}, Vec3d{v[4], v[5], v[6]}, Vec3d{v[8], v[9], v[10]}}, {v[3], v[7], v[11]}});
    };
    const std::string text = bytes->text(0, static_cast<std::size_t>(bytes->size()));
    std::uint64_t last = 1;
    require_text(text, last, faults_);
    read_cif(text,
             {{"_atom_site.",
               {std::begin(kAtomItems), std::end(kAtomItems)},
               [this](const Row& row, std::uint64_t line) { take_atom(row, line); }},
              {"_pdbx_struct_oper_list.", kOperatorItems, take_operator},
              {"_pdbx_struct_assembly_gen.",
               {"assembly_id", "oper_expression", "asym_id_list"},
               [&](const Row& row, std::uint64_t line) {
                 if (!is_past_atoms_) assemblies.add_part(row[0], row[1], row[2], line);
               }},
              {"_struct_conn.", connection_items(),
               [this](const Row& row, std::uint64_t line) {
                 if (!is_past_atoms_) take_connection(row, line);
               }},
              {"_chem_comp_bond.",
               {"comp_id", "atom_id_1", "atom_id_2"},
               [this](const Row& row, std::uint64_t) { bonds_.add_component(row[0], row[1], row[2]); }},
              {"_struct.",
               {"title"},
               [this](const Row& row, std::uint64_t) {
                 if (!is_past_atoms_) title_ = row[0];
               }}},
             faults_, [this] { is_past_atoms_ = !models_.empty(); });
    faults_.raise_if_any();
    if (models_.empty()) faults_.fail(0, "no atoms: the table _atom_site is missing");
    assemblies_ = assemblies.finish(faults_);
    atom_ = {};
  }

  int frame_count() override { return static_cast<int>(models_.size()); }

  FrameInfo describe(int frame) override {
    const Model& model = models_[static_cast<std::size_t>(frame)];
    FrameInfo info = model.atoms.info();
    info.assemblies = assemblies_;
    info.title = title_;
    const double step = gemmi::cif::as_number(model.number);
    if (!std::isnan(step)) info.step = step;
    info.bonds = bonds_.estimate(info.rows);
    info.has_bonds = info.bonds > 0;
    info.lists_all_bonds = false;
    if (other_atoms_ > 0)
      info.warnings.push_back(fmt::format("{} of later data blocks were left out; split the file to use them",
                                          base::counted(other_atoms_, "atom")));
    return info;
  }

  std::uint64_t memory() const override {
    std::uint64_t bytes = 0;
    for (const Model& model : models_) bytes += model.atoms.memory() + model.residues.memory();
    return bytes;
  }
  Table read(int frame, const std::vector<std::string>& columns) override {
    return models_[static_cast<std::size_t>(frame)].atoms.table(columns);
  }
  std::vector<Bond> bonds(int frame, std::vector<std::string>& warnings) override {
    const Model& model = models_[static_cast<std::size_t>(frame)];
    Faults faults = faults_;
    return bonds_.of_model(model.atoms, model.residues, faults, warnings);
  }

 private:
  struct Model {
    std::string number;
    AtomTable atoms;
    CifResidues residues = {};
  };

  void take_atom(const Row& row, std::uint64_t line) {
    if (is_past_atoms_) return void(++other_atoms_);
    atom_.position = {number(row[of_atom("cartn_x")], line), number(row[of_atom("cartn_y")], line),
                      number(row[of_atom("cartn_z")], line)};
    atom_.occupancy = row[of_atom("occupancy")].empty() ? 1 : number(row[of_atom("occupancy")], line);
    atom_.b_factor = number(row[of_atom("b_iso_or_equiv")], line);
    atom_.has_residue_number = !preferred(row, of_atom("auth_seq_id"), of_atom("label_seq_id")).empty();
    atom_.residue_number = residue_number(preferred(row, of_atom("auth_seq_id"), of_atom("label_seq_id")));
    atom_.insertion = row[of_atom("pdbx_pdb_ins_code")];
    atom_.element = gemmi::Element(row[of_atom("type_symbol")]).name();
    atom_.chain = preferred(row, of_atom("auth_asym_id"), of_atom("label_asym_id"));
    atom_.subchain =
        row[of_atom("label_asym_id")].empty() ? row[of_atom("auth_asym_id")] : row[of_atom("label_asym_id")];
    atom_.name = preferred(row, of_atom("auth_atom_id"), of_atom("label_atom_id"));
    atom_.residue = preferred(row, of_atom("auth_comp_id"), of_atom("label_comp_id"));
    atom_.altloc = row[of_atom("label_alt_id")];
    atom_.record = row[of_atom("group_pdb")].empty() ? std::string_view("ATOM") : row[of_atom("group_pdb")];
    // Models are contiguous in nearly all files.
    if (models_.empty() || models_[model_].number != row[of_atom("pdbx_pdb_model_num")]) {
      const auto [it, is_new] = model_of_.try_emplace(row[of_atom("pdbx_pdb_model_num")], models_.size());
      if (is_new) models_.push_back({row[of_atom("pdbx_pdb_model_num")], {}});
      model_ = it->second;
    }
    Model& model = models_[model_];
    const std::size_t added = model.atoms.add(atom_);
    if (added + 1 == model.atoms.rows()) model.residues.add(added, atom_);
  }

  /// Takes a covalent bond; the table also lists salt bridges, hydrogen bonds, and the coordination of metals.
  void take_connection(const Row& row, std::uint64_t line) {
    const std::string type = base::lower(row[0]);
    if (!type.starts_with("covale") && type != "disulf") return;
    constexpr std::size_t kFirst = 1, kSecond = kFirst + std::size(kPartnerItems);
    // Neither symmetry copies of the atoms nor bonds to them are in the file.
    if (row[kFirst + of_partner("ptnr{}_symmetry")] != row[kSecond + of_partner("ptnr{}_symmetry")]) return;
    const auto atom = [&](std::size_t at) {
      return CifAtomName{
          preferred(row, at + of_partner("ptnr{}_auth_asym_id"), at + of_partner("ptnr{}_label_asym_id")),
          residue_number(preferred(row, at + of_partner("ptnr{}_auth_seq_id"), at + of_partner("ptnr{}_label_seq_id"))),
          row[at + of_partner("pdbx_ptnr{}_pdb_ins_code")],
          preferred(row, at + of_partner("ptnr{}_auth_comp_id"), at + of_partner("ptnr{}_label_comp_id")),
          row[at + of_partner("ptnr{}_label_atom_id")]};
    };
    bonds_.add_connection(atom(kFirst), atom(kSecond), line);
  }

  /// NaN if there is no value.
  double number(const std::string& text, std::uint64_t line) {
    const double value = gemmi::cif::as_number(text);
    if (std::isnan(value) && !text.empty())
      faults_.add_of_many(line, fmt::format("`{}` is not a number", text.substr(0, 40)));
    return value;
  }

  Faults faults_;
  std::vector<Model> models_;
  std::unordered_map<std::string, std::size_t> model_of_;  ///< index into `models_` by number
  std::size_t model_ = 0;                                  ///< index of the latest atom's model
  std::vector<Assembly> assemblies_;
  std::string title_;
  Atom atom_;
  CifBonds bonds_;
  bool is_past_atoms_ = false;     ///< a data block with atoms has ended
  std::uint64_t other_atoms_ = 0;  ///< of later blocks
};

bool is_mmcif(const Signature& signature) {
  std::string_view text = signature.head;
  // Removes the next word, and the comments before it.
  const auto word = [&] {
    for (;;) {
      text.remove_prefix(std::min(text.find_first_not_of(kCifBlanks), text.size()));
      if (!text.starts_with('#')) break;
      text.remove_prefix(std::min(text.find('\n'), text.size()));
    }
    const std::string_view out = text.substr(0, text.find_first_of(kCifBlanks));
    text.remove_prefix(out.size());
    return base::lower(out);
  };
  if (!word().starts_with("data_")) return false;
  if (signature.extension == ".cif" || signature.extension == ".mmcif") return true;
  // The first column of a table may be named so.
  const std::string second = word();
  return second.starts_with('_') || second == "loop_" || second.starts_with("save_");
}

/// Whether the first table of atoms is that of a small molecule: its names have an underscore where mmCIF has a point.
/// Texts of a publication may precede it.
bool is_of_small_molecule(const ByteSource& bytes) {
  constexpr std::string_view kTable = "_atom_site", kAnisotropic = "_anisotrop.";  // the latter of mmCIF
  TextCursor cursor(bytes);
  for (std::string line; cursor.next_filled(line);) {
    const std::string_view word = trimmed(line);
    if (!word.starts_with(kTable)) continue;
    const std::string_view rest = word.substr(kTable.size());
    if (rest.starts_with('.') || (rest.starts_with('_') && !rest.starts_with(kAnisotropic))) return rest[0] == '_';
  }
  return false;
}

std::unique_ptr<DataFile> open_cif(const Bytes& bytes, const OpenOptions& options) {
  if (!is_of_small_molecule(*bytes)) return std::make_unique<MmcifReader>(bytes, options);
  return open_small_cif(bytes, options);
}

}  // namespace

const FormatReader kMmcif = {"mmCIF", is_mmcif, open_cif};

}  // namespace orrery::data
