// SPDX-License-Identifier: Apache-2.0
// gemmi's grammar of CIF with our own actions: gemmi's document would store every value of the file as a string.
#include "data/cif_rows.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <gemmi/cif.hpp>
#include <string_view>
#include <utility>

#include "base/text.h"

namespace orrery::data {

namespace {

namespace rules = gemmi::cif::rules;
namespace pegtl = tao::pegtl;

/// A place in a row of a table.
struct Slot {
  std::size_t table = 0, item = 0;
  bool is_wanted = false;
};

class RowReader {
 public:
  RowReader(std::vector<CifTable> tables, Faults& faults, const std::function<void()>& begin_block)
      : tables_(std::move(tables)), faults_(faults), begin_block_(begin_block) {
    for (const CifTable& table : tables_) rows_.emplace_back(table.items.size());
    item_lines_.resize(tables_.size());
  }

  void begin_block(std::string_view, std::uint64_t) {
    end_block();
    begin_block_();
  }

  void begin_loop(std::string_view, std::uint64_t) {
    loop_.clear();
    column_ = 0;
  }
  void add_loop_tag(std::string_view tag, std::uint64_t) { loop_.push_back(slot_of(tag)); }
  void add_loop_value(std::string_view value, std::uint64_t line) {
    const Slot slot = loop_[column_];
    if (slot.is_wanted) rows_[slot.table][slot.item] = gemmi::cif::as_string(std::string(value));
    if (++column_ < loop_.size()) return;
    column_ = 0;
    const auto wanted = std::find_if(loop_.begin(), loop_.end(), [](const Slot& s) { return s.is_wanted; });
    if (wanted != loop_.end()) finish_row(wanted->table, line);
  }
  void end_loop(std::string_view, std::uint64_t line) {
    if (column_ != 0) faults_.fail(line, "the last row of the table is incomplete");
  }

  void set_tag(std::string_view tag, std::uint64_t) { item_ = slot_of(tag); }
  void set_value(std::string_view value, std::uint64_t line) {
    if (!item_.is_wanted) return;
    rows_[item_.table][item_.item] = gemmi::cif::as_string(std::string(value));
    item_lines_[item_.table] = line;
  }
  /// Ends the tables that are given as single items: each has one row.
  void end_block() {
    for (std::size_t i = 0; i < tables_.size(); ++i)
      if (const std::uint64_t line = std::exchange(item_lines_[i], 0); line > 0) finish_row(i, line);
  }

 private:
  Slot slot_of(std::string_view name) const {
    const std::string tag = base::lower(name);
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      if (tag.rfind(tables_[t].category, 0) != 0) continue;
      const auto& items = tables_[t].items;
      const auto item = std::find(items.begin(), items.end(), tag.substr(tables_[t].category.size()));
      if (item != items.end()) return {t, static_cast<std::size_t>(item - items.begin()), true};
    }
    return {};
  }
  void finish_row(std::size_t table, std::uint64_t line) {
    tables_[table].take(rows_[table], line);
    for (std::string& value : rows_[table]) value.clear();
  }

  std::vector<CifTable> tables_;
  Faults& faults_;
  const std::function<void()>& begin_block_;
  std::vector<std::vector<std::string>> rows_;  ///< the current row of each table
  std::vector<std::uint64_t> item_lines_;       ///< the last line of a row that was given as single items; 0: none
  std::vector<Slot> loop_;                      ///< one per column of the current loop
  std::size_t column_ = 0;
  Slot item_;
};

/// Calls a method with the text that a rule has matched, and the number of its first line.
template <auto method>
struct Calls {
  template <typename Input>
  static void apply(const Input& in, RowReader& reader) {
    (reader.*method)(std::string_view(in.begin(), in.size()), in.iterator().line);
  }
};

template <typename Rule>
struct Action : pegtl::nothing<Rule> {};
template <>
struct Action<rules::datablockname> : Calls<&RowReader::begin_block> {};
template <>
struct Action<rules::str_loop> : Calls<&RowReader::begin_loop> {};
template <>
struct Action<rules::loop_tag> : Calls<&RowReader::add_loop_tag> {};
template <>
struct Action<rules::loop_value> : Calls<&RowReader::add_loop_value> {};
template <>
struct Action<rules::loop> : Calls<&RowReader::end_loop> {};
template <>
struct Action<rules::item_tag> : Calls<&RowReader::set_tag> {};
template <>
struct Action<rules::item_value> : Calls<&RowReader::set_value> {};

}  // namespace

void read_cif(const std::string& text, std::vector<CifTable> tables, Faults& faults,
              const std::function<void()>& begin_block) {
  RowReader reader(std::move(tables), faults, begin_block);
  pegtl::memory_input<> in(text.data(), text.size(), "");
  try {
    pegtl::parse<rules::file, Action, gemmi::cif::Errors>(in, reader);
  } catch (const pegtl::parse_error& error) {
    faults.fail(error.positions().front().line, "CIF syntax: " + std::string(error.message()));
  }
  reader.end_block();
}

}  // namespace orrery::data
