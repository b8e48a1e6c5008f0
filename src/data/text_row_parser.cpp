// SPDX-License-Identifier: Apache-2.0
#include "data/text_row_parser.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "data/faults.h"
#include "data/table.h"
#include "data/text_lines.h"
#include "data/text_rows.h"

namespace orrery::data {
namespace {

constexpr bool ends_word(char c) { return is_blank(c) || c == '\n'; }

/// The first space or control character. Processes eight characters at a time, as in text_number.h.
const char* word_end(const char* at) {
  for (;; at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, sizeof word);
    const std::uint64_t inside = ((word & 0x7f7f7f7f7f7f7f7f) + 0x5f5f5f5f5f5f5f5f) | word;
    const std::uint64_t others = ~inside & 0x8080808080808080;
    if (others != 0) return at + first_of(others);
  }
}

template <typename T>
T& element(void* column, std::uint64_t row) {
  return static_cast<T*>(column)[row];
}

}  // namespace

const char* RowParser::parse(const TextLines& lines, std::uint64_t line, std::uint64_t first_row, std::uint64_t rows,
                             const ColumnAddresses& columns) {
  columns_ = &columns;
  for (auto& words : words_) words.clear();
  unescaped_.clear();
  if (layout_->surveys) surveys_.assign(layout_->columns.size(), {});
  faults_.clear();
  fault_count_ = 0;
  row_ = first_row;
  line_ = line;
  const bool skips_lines = layout_->rows == kRowsToEnd;
  const char* at = lines.begin();
  for (const std::uint64_t end = first_row + rows; row_ < end && at < lines.end(); ++line_) {
    const char* const start = at;
    if (skips_lines && has_no_row(at, layout_->allows_comments)) {
      at = line_end(at) + 1;
      continue;
    }
    at = layout_->separator == ' ' ? parse_blank_separated(start) : parse_separated(start);
    if (at == nullptr) at = line_end(start);
    ++at;
    ++row_;
  }
  return at;
}

const char* RowParser::parse_blank_separated(const char* at) {
  const std::size_t count = layout_->columns.size();
  for (std::size_t c = 0; c < count; ++c) {
    at = skip_blanks(at);
    const char* const begin = at;
    if (*at == '\n') {
      fail(fmt::format("has {} values, not {}", c, count));
      return nullptr;
    }
    void* const column = (*columns_)[c];
    if (column == nullptr) {
      at = word_end(at);
      if (layout_->surveys) surveys_[c].add({begin, at}, false, line_);
      continue;
    }
    switch (layout_->columns[c].type) {
      case ColumnType::kFloat64: at = scan_number(at, element<double>(column, row_)); break;
      case ColumnType::kInt64: at = scan_integer(at, element<std::int64_t>(column, row_)); break;
      default: at = word_end(at); element<std::uint32_t>(column, row_) = words_[c].index_of({begin, at});
    }
    if (at == nullptr || !ends_word(*at)) {
      at = word_end(begin);
      if (!store_missing(c, {begin, at})) {
        fail_value(c, begin, at);
        return nullptr;
      }
    }
  }
  if (layout_->allows_more) return line_end(at);
  at = skip_blanks(at);
  if (*at == '\n') return at;
  if (*at == layout_->comment && *at != '\0') return line_end(at);
  fail(fmt::format("has more than {} values", count));
  return nullptr;
}

const char* RowParser::parse_separated(const char* at) {
  const char separator = layout_->separator;
  const auto skip = [separator](const char* p) {
    while (is_blank(*p) && *p != separator) ++p;
    return p;
  };
  const std::size_t count = layout_->columns.size();
  for (std::size_t c = 0; c < count; ++c) {
    if (c > 0) {
      if (*at != separator) {
        fail(fmt::format("has {} values, not {}", c, count));
        return nullptr;
      }
      ++at;
    }
    at = skip(at);
    std::string_view value;
    const char* const begin = at;
    const bool is_quoted = *at == '"';
    if (is_quoted) {
      at = quoted_value(at, value);
      if (at == nullptr) {
        fail(fmt::format("column {}: a quoted value does not end in this line", c + 1));
        return nullptr;
      }
      at = skip(at);
    } else {
      while (*at != separator && *at != '\n') ++at;
      const char* end = at;
      while (end > begin && is_blank(end[-1])) --end;
      value = {begin, end};
    }
    if ((*at != separator && *at != '\n') || !store(c, value, is_quoted)) {
      fail_value(c, begin, std::find_if(at, line_end(at), [&](char x) { return x == separator; }));
      return nullptr;
    }
  }
  if (*at == '\n' || layout_->allows_more) return line_end(at);
  fail(fmt::format("has more than {} values", count));
  return nullptr;
}

/// Result     position after the closing quote; null if there is none
const char* RowParser::quoted_value(const char* at, std::string_view& value) {
  const char* const begin = ++at;
  bool has_quotes = false;
  for (; *at != '\n'; ++at) {
    if (*at != '"') continue;
    if (at[1] != '"') break;
    has_quotes = true;
    ++at;
  }
  if (*at == '\n') return nullptr;
  value = {begin, at};
  if (!has_quotes) return at + 1;
  std::string text;
  for (std::size_t i = 0; i < value.size(); ++i) {
    text += value[i];
    if (value[i] == '"') ++i;
  }
  // The scanners of numbers read beyond the value.
  const std::size_t size = text.size();
  text.append(kTextPadding, '\n');
  value = std::string_view(unescaped_.emplace_back(std::move(text))).substr(0, size);
  return at + 1;
}

/// Result     false if the value is not of the column's type
bool RowParser::store(std::size_t c, std::string_view value, bool is_quoted) {
  if (layout_->surveys) surveys_[c].add(value, is_quoted, line_);
  void* const column = (*columns_)[c];
  if (column == nullptr) return true;
  const char* const end = value.data() + value.size();
  switch (layout_->columns[c].type) {
    case ColumnType::kFloat64:
      return (!value.empty() && scan_number(value.data(), element<double>(column, row_)) == end) ||
             store_missing(c, value);
    case ColumnType::kInt64:
      return !value.empty() && scan_integer(value.data(), element<std::int64_t>(column, row_)) == end;
    default: element<std::uint32_t>(column, row_) = words_[c].index_of(value); return true;
  }
}

/// Stores NaN for a missing value.
///
/// Result     false if the value is not missing, or the column cannot store NaN
bool RowParser::store_missing(std::size_t c, std::string_view value) {
  if (!layout_->allows_missing || layout_->columns[c].type != ColumnType::kFloat64) return false;
  if (!value.empty() && !is_missing_marker(value)) return false;
  element<double>((*columns_)[c], row_) = std::numeric_limits<double>::quiet_NaN();
  return true;
}

void RowParser::fail(std::string text) {
  constexpr std::size_t kMaxKept = 10;  // as many as Faults lists
  if (++fault_count_ <= kMaxKept) faults_.push_back({line_, std::move(text)});
}

void RowParser::fail_value(std::size_t c, const char* begin, const char* end) {
  constexpr std::ptrdiff_t kMaxShown = 40;
  const bool is_long = end - begin > kMaxShown;
  const std::string word(begin, is_long ? begin + kMaxShown : end);
  const ColumnType type = layout_->columns[c].type;
  fail(fmt::format("column {}: '{}{}{}", c + 1, word, is_long ? "...' is not " : "' is not ",
                   type == ColumnType::kInt64  ? "an integer"
                   : type == ColumnType::kText ? "a string"
                                               : "a number"));
}

}  // namespace orrery::data
