// SPDX-License-Identifier: Apache-2.0
#include "data/atom_table.h"

#include <algorithm>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"

namespace orrery::data {

namespace {

constexpr const char* kPositionNames[] = {"x", "y", "z"};

struct TextMember {
  const char* name;
  std::string_view Atom::*member;
};
constexpr std::array<TextMember, 8> kTexts = {{{"element", &Atom::element},
                                               {"chain", &Atom::chain},
                                               {"subchain", &Atom::subchain},
                                               {"segment", &Atom::segment},
                                               {"name", &Atom::name},
                                               {"residue", &Atom::residue},
                                               {"altloc", &Atom::altloc},
                                               {"record", &Atom::record}}};

/// Identifies an atom among its alternate locations, which may belong to different residues of one number.
std::string identity(const Atom& atom) {
  return fmt::format("{}\n{}\n{}\n{}{}\n{}", atom.chain, atom.subchain, atom.segment, atom.residue_number,
                     atom.insertion, atom.name);
}

bool has_any(const std::vector<std::string>& words) {
  return words.size() > 1 || (words.size() == 1 && !words[0].empty());
}

}  // namespace

std::size_t AtomTable::add(const Atom& atom) {
  if (!atom.altloc.empty()) {
    Alternates& known = alternates_[identity(atom)];
    if (!known.locations.empty() && is_alternate(known, atom)) {
      known.locations.append(atom.altloc) += '\n';
      if (static_cast<float>(atom.occupancy) > occupancies_[known.row]) set(known.row, atom);
      return known.row;
    }
    known = {numbers_.size(), std::string(atom.altloc) + '\n'};
  }
  const std::size_t row = numbers_.size();
  for (auto& values : position_) values.emplace_back();
  b_factors_.emplace_back();
  occupancies_.emplace_back();
  numbers_.emplace_back();
  for (Texts& texts : texts_) texts.index.emplace_back();
  set(row, atom);
  return row;
}

/// Residues of a large simulation may share their number, and water may have none: an atom whose location is known
/// already is another one, as is one without a number that is farther away than water molecules are from each other.
bool AtomTable::is_alternate(const Alternates& known, const Atom& atom) const {
  constexpr double kClosestWater = 2.4;  // ångström
  if (('\n' + known.locations).find(fmt::format("\n{}\n", atom.altloc)) != std::string::npos) return false;
  const Vec3d other{position_[0][known.row], position_[1][known.row], position_[2][known.row]};
  return atom.has_residue_number || math::length(atom.position - other) < kClosestWater;
}

void AtomTable::set(std::size_t row, const Atom& atom) {
  position_[0][row] = atom.position.x;
  position_[1][row] = atom.position.y;
  position_[2][row] = atom.position.z;
  b_factors_[row] = static_cast<float>(atom.b_factor);
  occupancies_[row] = static_cast<float>(atom.occupancy);
  numbers_[row] = atom.residue_number;
  for (std::size_t i = 0; i < kTexts.size(); ++i)
    texts_[i].index[row] = texts_[i].words.index_of(atom.*kTexts[i].member);
}

void AtomTable::reserve(std::size_t rows) {
  for (auto& values : position_) values.reserve(rows);
  b_factors_.reserve(rows);
  occupancies_.reserve(rows);
  numbers_.reserve(rows);
  for (Texts& texts : texts_) texts.index.reserve(rows);
}

FrameInfo AtomTable::info() const {
  FrameInfo info;
  info.rows = rows();
  for (const char* name : kPositionNames) info.columns.push_back({name, ColumnType::kFloat64});
  bool has_subchains = false;
  for (std::size_t i = 0; i < kTexts.size(); ++i) {
    const auto& [name, member] = kTexts[i];
    const bool is_listed = (member != &Atom::subchain && member != &Atom::segment) || has_any(texts_[i].words.words());
    if (is_listed) info.columns.push_back({name, ColumnType::kText});
    has_subchains = has_subchains || (is_listed && member == &Atom::subchain);
  }
  info.columns.push_back({"residue_number", ColumnType::kInt32});
  info.columns.push_back({"b_factor", ColumnType::kFloat32});
  info.columns.push_back({"occupancy", ColumnType::kFloat32});
  info.roles.position = {"x", "y", "z"};
  info.roles.element = "element";
  info.roles.chain = has_subchains ? "subchain" : "chain";
  info.z_up = false;
  return info;
}

Table AtomTable::table(const std::vector<std::string>& columns) const {
  Table table;
  table.rows = numbers_.size();
  for (const std::string& name : columns) {
    for (std::size_t i = 0; i < 3; ++i)
      if (name == kPositionNames[i]) table.columns.push_back({name, position_[i]});
    for (std::size_t i = 0; i < kTexts.size(); ++i)
      if (name == kTexts[i].name)  // without the strings of replaced atoms
        table.columns.push_back({name, words_at(texts_[i].words.words(), texts_[i].index)});
    if (name == "residue_number") table.columns.push_back({name, numbers_});
    if (name == "b_factor") table.columns.push_back({name, b_factors_});
    if (name == "occupancy") table.columns.push_back({name, occupancies_});
  }
  return table;
}

void require_parse_memory(const std::filesystem::path& file, std::uint64_t count, double factor, std::uint64_t held,
                          std::uint64_t limit) {
  const double need = static_cast<double>(count) * factor + static_cast<double>(held);
  if (limit == 0 || need <= static_cast<double>(limit)) return;
  throw base::Error(base::ErrorKind::kNoMemory, file.string() + ": the atoms need about " +
                                                    base::bytes_text(static_cast<std::uint64_t>(need)) +
                                                    " while they are read; " + base::bytes_text(limit) +
                                                    " are available; read the file on a machine with more memory");
}

void require_text(std::string_view block, std::uint64_t& line, Faults& faults) {
  const auto is_control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && (c < '\t' || c > '\r')) || c == 0x7f;
  };
  const auto bad = std::find_if(block.begin(), block.end(), is_control);
  line += static_cast<std::uint64_t>(std::count(block.begin(), bad, '\n'));
  if (bad != block.end())
    faults.fail(line, fmt::format("binary data: a byte of value {}", static_cast<unsigned char>(*bad)),
                "the file is damaged; download or write it again");
}

}  // namespace orrery::data
