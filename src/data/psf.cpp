// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "data/atom_elements.h"
#include "data/bonds.h"
#include "data/columns.h"
#include "data/dictionary.h"
#include "data/frames.h"
#include "data/readers.h"

// Topologies of CHARMM, X-PLOR and NAMD: sections, each with a number and a name, such as "24 !NATOM". Positions are in
// other files.
//
// Reference  namd-psf
namespace orrery::data {
namespace {

class Psf final : public SingleFrame {
 public:
  explicit Psf(const Bytes& bytes) : SingleFrame(bytes), faults_(bytes->file()), bonds_(*bytes_) {
    info_.rows = layout_.rows = section("!NATOM");
    layout_.begin = bonds_.offset();
    layout_.first_line = bonds_.line();
    layout_.allows_more = true;
    using enum ColumnType;
    layout_.columns = {{"id", kInt64},  {"segment", kText}, {"residue_number", kInt64}, {"residue", kText},
                       {"name", kText}, {"type", kText},    {"charge", kFloat64},       {"mass", kFloat64}};
    require_room(*bytes_, layout_, bonds_.line() - 1, faults_);
    layout_.wanted = {"name", "residue"};
    const TextTable names = read_text_rows(*bytes_, layout_, faults_);
    deduce_elements(std::get<Words>(names.table.columns[0].values), std::get<Words>(names.table.columns[1].values));
    info_.columns = layout_.columns;
    info_.columns.push_back({"element", kText});
    info_.roles.element = "element";
    info_.roles.chain = "segment";
    bonds_ = TextCursor(*bytes_, {names.end, layout_.first_line + info_.rows});
    info_.bonds = section("!NBOND");
    info_.has_bonds = info_.bonds > 0;
  }

  Table read(int, const std::vector<std::string>& columns) override {
    layout_.wanted = columns;
    const bool has_elements = std::erase(layout_.wanted, "element") > 0;
    Table out = read_text_rows(*bytes_, layout_, faults_).table;
    if (has_elements) out.columns.push_back({"element", elements_});
    return in_order(std::move(out), columns);
  }

  std::vector<Bond> bonds(int, std::vector<std::string>&) override {
    std::vector<Bond> out;
    TextCursor cursor = bonds_;
    std::string line;
    while (out.size() < info_.bonds) {
      if (!cursor.next_filled(line))
        faults_.fail(cursor.line(),
                     fmt::format("truncated: the file ends after {} of {} bonds", out.size(), info_.bonds));
      const auto words = words_of(line);
      for (std::size_t i = 0; i < words.size(); i += 2) {
        std::int64_t a = 0, b = 0;
        const auto is_atom = [&](std::int64_t n) { return n >= 1 && static_cast<std::uint64_t>(n) <= info_.rows; };
        if (i + 1 == words.size() || !parse_integer(words[i], a) || !parse_integer(words[i + 1], b) || !is_atom(a) ||
            !is_atom(b) || a == b)
          faults_.fail(cursor.line() - 1, fmt::format("expected pairs of atoms from 1 to {}", info_.rows));
        out.push_back(ordered_bond(static_cast<std::uint64_t>(a - 1), static_cast<std::uint64_t>(b - 1)));
      }
    }
    finish_bonds(out, faults_);
    return out;
  }

  std::uint64_t memory() const override {
    return SingleFrame::memory() + elements_.index.size() * sizeof(std::uint32_t);
  }

 private:
  /// Advances `bonds_` behind the title of a section.
  ///
  /// Result     its number
  std::uint64_t section(std::string_view name) {
    std::string line;
    std::int64_t count = 0;
    while (bonds_.next(line))
      if (const auto words = words_of(line);
          words.size() > 1 && words[1].starts_with(name) && parse_integer(words[0], count) && count >= 0)
        return static_cast<std::uint64_t>(count);
    faults_.fail(0, fmt::format("no section {}", name), "the file is truncated");
  }

  void deduce_elements(const Words& names, const Words& residues) {
    AtomElements deduced(true);  // names are aligned without regard to the element
    WordColumn elements;
    for (std::size_t row = 0; row < names.index.size(); ++row)
      elements.add(deduced.element_of(names.words[names.index[row]], residues.words[residues.index[row]]));
    elements_ = elements.take();
    if (const std::string warning = deduced.warning(); !warning.empty()) info_.warnings.push_back(warning);
  }

  Faults faults_;
  TextLayout layout_;
  TextCursor bonds_;  ///< at the first line of bonds
  Words elements_;
};

bool is_psf(const Signature& signature) {
  const std::string_view head = signature.head;
  return head.starts_with("PSF") && head.find("!NTITLE") != std::string_view::npos;
}

}  // namespace

const FormatReader kPsf = {"PSF", is_psf, open_as<Psf>};

}  // namespace orrery::data
