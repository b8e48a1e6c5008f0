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
  std::string Atom::*member;
};
constexpr std::array<TextMember, 7> kTexts = {{{"element", &Atom::element},
                                               {"chain", &Atom::chain},
                                               {"subchain", &Atom::subchain},
                                               {"name", &Atom::name},
                                               {"residue", &Atom::residue},
                                               {"altloc", &Atom::altloc},
                                               {"record", &Atom::record}}};

/// Identifies an atom among its alternate locations, which may belong to different residues of one number.
std::string identity(const Atom& atom) {
  return atom.chain + '\n' + atom.subchain + '\n' + std::to_string(atom.residue_number) + atom.insertion + '\n' +
         atom.name;
}

}  // namespace

std::size_t AtomTable::add(const Atom& atom) {
  if (!atom.altloc.empty()) {
    const auto [it, is_new] = alternates_.try_emplace(identity(atom), numbers_.size());
    if (!is_new) {
      if (static_cast<float>(atom.occupancy) > occupancies_[it->second]) set(it->second, atom);
      return it->second;
    }
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

FrameInfo AtomTable::info(bool has_subchains) const {
  FrameInfo info;
  info.rows = rows();
  for (const char* name : kPositionNames) info.columns.push_back({name, ColumnType::kFloat64});
  for (const TextMember& text : kTexts)
    if (has_subchains || text.member != &Atom::subchain) info.columns.push_back({text.name, ColumnType::kText});
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

void require_parse_memory(const std::filesystem::path& file, std::uint64_t bytes, double factor, std::uint64_t held,
                          std::uint64_t limit) {
  const double need = static_cast<double>(bytes) * factor + static_cast<double>(held);
  if (limit == 0 || need <= static_cast<double>(limit)) return;
  throw base::Error(base::ErrorKind::kNoMemory,
                    file.string() + ": " + base::bytes_text(bytes) + " of atoms need about " +
                        base::bytes_text(static_cast<std::uint64_t>(need)) + " while they are read; " +
                        base::bytes_text(limit) + " are available; read the file on a machine with more memory");
}

void require_text(const ByteSource& bytes, Faults& faults) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  const auto is_control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && (c < '\t' || c > '\r')) || c == 0x7f;
  };
  std::uint64_t line = 1;
  for (std::uint64_t at = 0; at < bytes.size(); at += kBlock) {
    const std::string block = bytes.text(at, kBlock);
    const auto bad = std::find_if(block.begin(), block.end(), is_control);
    line += static_cast<std::uint64_t>(std::count(block.begin(), bad, '\n'));
    if (bad != block.end())
      faults.fail(line, fmt::format("binary data: a byte of value {}", static_cast<unsigned char>(*bad)),
                  "the file is damaged; download or write it again");
  }
}

}  // namespace orrery::data
