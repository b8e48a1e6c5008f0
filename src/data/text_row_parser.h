// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "data/dictionary.h"
#include "data/text_rows.h"

namespace orrery::data {

class TextLines;

/// Destinations of the parsed values: one address per column, null for columns to skip.
using ColumnAddresses = std::vector<void*>;

/// Parses some lines of a table. Used by one thread at a time.
class RowParser {
 public:
  struct Fault {
    std::uint64_t line;
    std::string text;
  };

  explicit RowParser(const TextLayout& layout) : layout_(&layout), words_(layout.columns.size()) {}

  /// Parses lines into `rows` rows from `first_row` of the columns. Text columns receive indices into words().
  ///
  /// `line`     number of the first line
  /// Result     the end of the last row
  const char* parse(const TextLines& lines, std::uint64_t line, std::uint64_t first_row, std::uint64_t rows,
                    const ColumnAddresses& columns);

  /// Distinct words of a text column, valid as long as the lines.
  const std::vector<std::string_view>& words(std::size_t column) const { return words_[column].words(); }
  /// Surveys of the columns, if the layout requests them.
  const std::vector<ColumnSurvey>& surveys() const { return surveys_; }
  /// The first faulty lines, in order.
  const std::vector<Fault>& faults() const { return faults_; }
  std::uint64_t fault_count() const { return fault_count_; }

 private:
  const char* parse_blank_separated(const char* at);
  const char* parse_separated(const char* at);
  const char* quoted_value(const char* at, std::string_view& value);
  bool store(std::size_t column, std::string_view value, bool is_quoted);
  bool store_missing(std::size_t column, std::string_view value);
  void fail(std::string text);
  void fail_value(std::size_t column, const char* begin, const char* end);

  const TextLayout* layout_;
  const ColumnAddresses* columns_ = nullptr;
  std::uint64_t row_ = 0;
  std::uint64_t line_ = 0;
  std::vector<Dictionary<std::string_view>> words_;
  std::deque<std::string> unescaped_;  ///< storage for words with escaped quotes
  std::vector<ColumnSurvey> surveys_;
  std::vector<Fault> faults_;
  std::uint64_t fault_count_ = 0;
};

}  // namespace orrery::data
