// SPDX-License-Identifier: Apache-2.0
#include "data/text_rows.h"

#include <sys/mman.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <deque>
#include <functional>
#include <utility>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "data/dictionary.h"
#include "data/faults.h"
#include "data/text_lines.h"

namespace orrery::data {

namespace {

constexpr bool ends_word(char c) { return is_blank(c) || c == '\n'; }

/// The first space or control character.
const char* word_end(const char* at) {
  static_assert(std::endian::native == std::endian::little);
  for (;; at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, sizeof word);
    const std::uint64_t inside = ((word & 0x7f7f7f7f7f7f7f7f) + 0x5f5f5f5f5f5f5f5f) | word;
    const std::uint64_t others = ~inside & 0x8080808080808080;
    if (others != 0) return at + std::countr_zero(others) / 8;
  }
}

template <typename T>
T& element(void* column, std::uint64_t row) {
  return static_cast<T*>(column)[row];
}

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

  /// Distinct words of a text column, valid as long as the lines.
  const std::vector<std::string_view>& words(std::size_t column) const { return words_[column].words(); }
  /// Surveys of the columns, if the layout requests them.
  const std::vector<ColumnSurvey>& surveys() const { return surveys_; }
  /// The first faulty lines, in order.
  const std::vector<Fault>& faults() const { return faults_; }
  std::uint64_t fault_count() const { return fault_count_; }

 private:
  const char* parse_blank_separated(const char* at) {
    const std::size_t count = layout_->columns.size();
    for (std::size_t c = 0; c < count; ++c) {
      at = skip_blanks(at);
      const char* const begin = at;
      if (*at == '\n') return fail(fmt::format("the row has {} values, not {}", c, count));
      if (const char* const end = store_decimal(c, at); end != nullptr && ends_word(*end)) {
        at = end;
        continue;
      }
      at = word_end(at);
      const bool is_skipped = (*columns_)[c] == nullptr;
      if (!store(c, {begin, at}, false) || !(is_skipped || ends_word(*at))) return fail_value(c, begin, at);
    }
    if (layout_->allows_more) return line_end(at);
    at = skip_blanks(at);
    if (*at == '\n') return at;
    if (*at == layout_->comment && *at != '\0') return line_end(at);
    return fail(fmt::format("the row has more than {} values", count));
  }

  const char* parse_separated(const char* at) {
    const char separator = layout_->separator;
    const auto skip = [separator](const char* p) {
      while (is_blank(*p) && *p != separator) ++p;
      return p;
    };
    const std::size_t count = layout_->columns.size();
    for (std::size_t c = 0; c < count; ++c) {
      if (c > 0) {
        if (*at != separator) return fail(fmt::format("the row has {} values, not {}", c, count));
        ++at;
      }
      at = skip(at);
      if (const char* const end = store_decimal(c, at); end != nullptr && (*end == separator || *end == '\n')) {
        at = end;
        continue;
      }
      std::string_view value;
      const char* const begin = at;
      const bool is_quoted = *at == '"';
      if (is_quoted) {
        at = quoted_value(at, value);
        if (at == nullptr) return fail(fmt::format("column {}: a quoted value does not end in this line", c + 1));
        at = skip(at);
      } else {
        while (*at != separator && *at != '\n') ++at;
        const char* end = at;
        while (end > begin && is_blank(end[-1])) --end;
        value = {begin, end};
      }
      if ((*at != separator && *at != '\n') || !store(c, value, is_quoted)) {
        return fail_value(c, begin, std::find(at, line_end(at), separator));
      }
    }
    if (*at == '\n' || layout_->allows_more) return line_end(at);
    return fail(fmt::format("the row has more than {} values", count));
  }

  /// Result     position after the closing quote; null if there is none
  const char* quoted_value(const char* at, std::string_view& value) {
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
    value = unescaped_.emplace_back(std::move(text));
    return at + 1;
  }

  /// Stores a decimal number, the usual value of a column of float64.
  ///
  /// Result     as for scan_decimal()
  const char* store_decimal(std::size_t c, const char* at) {
    void* const column = (*columns_)[c];
    if (column == nullptr || layout_->surveys || layout_->columns[c].type != ColumnType::kFloat64) return nullptr;
    return scan_decimal(at, element<double>(column, row_));
  }

  /// Result     false if the value is not of the column's type
  bool store(std::size_t c, std::string_view value, bool is_quoted) {
    if (layout_->surveys) surveys_[c].add(value, is_quoted, line_);
    void* const column = (*columns_)[c];
    if (column == nullptr) return true;
    switch (layout_->columns[c].type) {
      case ColumnType::kFloat64: return parse_number(value, element<double>(column, row_)) || store_missing(c, value);
      case ColumnType::kInt64: return parse_integer(value, element<std::int64_t>(column, row_));
      default: element<std::uint32_t>(column, row_) = words_[c].index_of(value); return true;
    }
  }

  /// Stores NaN for a missing value of a column of numbers.
  ///
  /// Result     false if the value is not missing
  bool store_missing(std::size_t c, std::string_view value) {
    if (!layout_->allows_missing) return false;
    if (!value.empty() && !is_missing_marker(value)) return false;
    element<double>((*columns_)[c], row_) = std::numeric_limits<double>::quiet_NaN();
    return true;
  }

  /// Adds a fault of the row; returns null, the end of a row that cannot be parsed.
  std::nullptr_t fail(std::string text) {
    constexpr std::size_t kMaxKept = 10;  // as many as Faults lists
    if (++fault_count_ <= kMaxKept) faults_.push_back({line_, std::move(text)});
    return nullptr;
  }

  std::nullptr_t fail_value(std::size_t c, const char* begin, const char* end) {
    constexpr std::ptrdiff_t kMaxShown = 40;
    if (!ends_word(*end) && *end != layout_->separator) ++end;  // a control character, which ends the word
    const bool is_long = end - begin > kMaxShown;
    const std::string word(begin, is_long ? begin + kMaxShown : end);
    const ColumnType type = layout_->columns[c].type;
    return fail(fmt::format("column {}: '{}{}{}", c + 1, word, is_long ? "...' is not " : "' is not ",
                            type == ColumnType::kInt64  ? "an integer"
                            : type == ColumnType::kText ? "a string"
                                                        : "a number"));
  }

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

/// A part of the file on its way through the pipeline.
struct Chunk {
  explicit Chunk(const TextLayout& layout) : parser(layout) {}

  TextLines lines;
  RowParser parser;
  std::uint64_t number = 0, line_count = 0, row_count = 0, first_line = 0, first_row = 0, parsed_rows = 0;
  ColumnAddresses addresses;
  std::uint64_t end = 0;  ///< offset behind the last row
};

/// Requests huge pages: page faults take a fifth of the time otherwise.
template <typename T>
void prefer_huge_pages(std::vector<T>& values) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kHugePage = std::uintptr_t{2} << 20;
  const auto begin = (reinterpret_cast<std::uintptr_t>(values.data()) + kHugePage - 1) / kHugePage * kHugePage;
  const auto end = reinterpret_cast<std::uintptr_t>(values.data() + values.capacity()) / kHugePage * kHugePage;
  // Only a hint: the result does not matter.
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

Values reserved_values(ColumnType type, std::uint64_t rows) {
  const auto reserved = [&](auto values) {
    values.reserve(rows);
    prefer_huge_pages(values);
    return values;
  };
  switch (type) {
    case ColumnType::kInt64: return reserved(std::vector<std::int64_t>());
    case ColumnType::kText: return Words{{}, reserved(std::vector<std::uint32_t>())};
    default: return reserved(std::vector<double>());
  }
}

/// Extends a column within its reserved memory, while other threads are writing to its rows.
void* resized(Values& column, std::uint64_t rows) {
  return std::visit(
      [rows](auto& v) -> void* {
        if constexpr (requires { v.index; }) {
          v.index.resize(rows);
          return v.index.data();
        } else if constexpr (requires { v.resize(rows); }) {
          v.resize(rows);
          return v.data();
        } else {
          return nullptr;  // readers never create views
        }
      },
      column);
}

/// Reads one table. Chunks are read, and their lines counted, in parallel; in order, they get their rows of the
/// columns; in parallel, they are parsed in place; in order, their words and faults are collected.
class TableReader {
 public:
  TableReader(const ByteSource& bytes, const TextLayout& layout, Faults& faults)
      : bytes_(bytes),
        layout_(layout),
        faults_(faults),
        begin_(std::min(layout.begin, bytes.size())),
        chunk_count_((bytes.size() - begin_ + layout.chunk_bytes - 1) / layout.chunk_bytes),
        max_rows_(layout.rows == kRowsToEnd ? counted_rows() : std::min(layout.rows, possible_rows())),
        next_line_(layout.first_line),
        is_complete_(max_rows_ == 0),
        words_(layout.columns.size()) {
    out_.end = begin_;
    for (const std::string& name : layout.wanted)
      out_.table.columns.push_back({name, reserved_values(find_named(layout.columns, name)->type, max_rows_)});
    for (const ColumnInfo& column : layout.columns) targets_.push_back(out_.table.find(column.name));
    if (layout.surveys) out_.surveys.resize(layout.columns.size());
  }

  TextTable run() {
    // As the last stage keeps the order, chunks on their way have consecutive numbers.
    const auto slots = static_cast<std::size_t>(
        std::min<std::uint64_t>(2 * static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency()), chunk_count_));
    for (std::size_t i = 0; i < slots; ++i) chunks_.emplace_back(layout_);
    using tbb::filter_mode;
    if (slots > 0)
      tbb::parallel_pipeline(
          slots,
          tbb::make_filter<void, Chunk*>(filter_mode::serial_in_order, [&](auto& flow) { return next(flow); }) &
              tbb::make_filter<Chunk*, Chunk*>(filter_mode::parallel, [&](Chunk* c) { return load(c); }) &
              tbb::make_filter<Chunk*, Chunk*>(filter_mode::serial_in_order, [&](Chunk* c) { return place(c); }) &
              tbb::make_filter<Chunk*, Chunk*>(filter_mode::parallel, [&](Chunk* c) { return parse(c); }) &
              tbb::make_filter<Chunk*, void>(filter_mode::serial_in_order, [&](Chunk* c) { finish(*c); }));
    if (layout_.rows != kRowsToEnd && out_.table.rows < layout_.rows)
      faults_.add(next_line_, fmt::format("the file ends after {} of {} rows", out_.table.rows, layout_.rows),
                  "the file is truncated, or its header declares too many");
    faults_.raise_if_any();
    for (std::size_t c = 0; c < targets_.size(); ++c)
      if (is_wanted_text(c)) std::get<Words>(targets_[c]->values).words = words_[c].take();
    return std::move(out_);
  }

 private:
  void read_lines(std::uint64_t chunk, TextLines& lines) const {
    stop_.check();
    const std::uint64_t first = begin_ + chunk * layout_.chunk_bytes;
    lines.read(bytes_, first, first + layout_.chunk_bytes, chunk == 0);
  }

  /// Upper bound of the number of rows, used to check declared counts before memory is reserved. Allows some malformed
  /// rows, so that these are reported.
  std::uint64_t possible_rows() const {
    constexpr std::uint64_t kMargin = 1000;
    const std::uint64_t bytes_per_value = layout_.separator == ' ' ? 2 : 1;
    const std::uint64_t bytes_per_row = std::max<std::uint64_t>(1, bytes_per_value * layout_.columns.size());
    return (bytes_.size() - begin_) / bytes_per_row + kMargin;
  }

  std::uint64_t counted_rows() const {
    tbb::enumerable_thread_specific<TextLines> lines;
    return tbb::parallel_reduce(
        tbb::blocked_range<std::uint64_t>(0, chunk_count_, 1), std::uint64_t{0},
        [&](const tbb::blocked_range<std::uint64_t>& range, std::uint64_t count) {
          for (std::uint64_t chunk = range.begin(); chunk < range.end(); ++chunk) {
            read_lines(chunk, lines.local());
            count += lines.local().filled_count(layout_.allows_comments);
          }
          return count;
        },
        std::plus<>());
  }

  Chunk* next(tbb::flow_control& flow) {
    if (next_chunk_ == chunk_count_ || is_complete_) {
      flow.stop();
      return nullptr;
    }
    Chunk& chunk = chunks_[next_chunk_ % chunks_.size()];
    chunk.number = next_chunk_++;
    return &chunk;
  }

  Chunk* load(Chunk* chunk) const {
    read_lines(chunk->number, chunk->lines);
    chunk->line_count = chunk->lines.count();
    chunk->row_count =
        layout_.rows == kRowsToEnd ? chunk->lines.filled_count(layout_.allows_comments) : chunk->line_count;
    return chunk;
  }

  Chunk* place(Chunk* chunk) {
    chunk->first_line = next_line_;
    Table& table = out_.table;
    chunk->first_row = table.rows;
    chunk->parsed_rows = std::min(chunk->row_count, max_rows_ - table.rows);
    next_line_ += chunk->line_count;
    table.rows += chunk->parsed_rows;
    chunk->addresses.clear();
    for (Column* const target : targets_)
      chunk->addresses.push_back(target != nullptr ? resized(target->values, table.rows) : nullptr);
    if (table.rows == max_rows_) is_complete_ = true;
    return chunk;
  }

  Chunk* parse(Chunk* chunk) const {
    const char* const end =
        chunk->parser.parse(chunk->lines, chunk->first_line, chunk->first_row, chunk->parsed_rows, chunk->addresses);
    chunk->end = std::min(chunk->lines.offset_of(end), bytes_.size());  // there may be an added newline
    return chunk;
  }

  void finish(const Chunk& chunk) {
    if (chunk.parsed_rows > 0) out_.end = chunk.end;
    const auto& faults = chunk.parser.faults();
    for (const RowParser::Fault& fault : faults) faults_.add_of_many(fault.line, fault.text);
    // Those that the parser did not keep follow ten others, and are only counted.
    for (std::uint64_t i = faults.size(); i < chunk.parser.fault_count(); ++i) faults_.add_of_many(0, {});
    for (std::size_t c = 0; c < targets_.size(); ++c)
      if (is_wanted_text(c)) merge_words(chunk, c);
    for (std::size_t c = 0; c < out_.surveys.size(); ++c) out_.surveys[c].add(chunk.parser.surveys()[c]);
  }

  bool is_wanted_text(std::size_t column) const {
    return targets_[column] != nullptr && layout_.columns[column].type == ColumnType::kText;
  }

  /// Replaces indices into the chunk's words by indices into the table's.
  void merge_words(const Chunk& chunk, std::size_t column) {
    std::vector<std::uint32_t> merged;
    for (const std::string_view word : chunk.parser.words(column)) merged.push_back(words_[column].index_of(word));
    if (words_[column].words().size() > std::numeric_limits<std::uint32_t>::max())
      faults_.fail(chunk.first_line, fmt::format("column {} has too many distinct strings", column + 1));
    auto* const index = static_cast<std::uint32_t*>(chunk.addresses[column]) + chunk.first_row;
    if (!chunk.parser.faults().empty()) return;  // some rows have no index
    for (std::uint64_t i = 0; i < chunk.parsed_rows; ++i) index[i] = merged[index[i]];
  }

  const ByteSource& bytes_;
  const TextLayout& layout_;
  base::StopPoint stop_;
  Faults& faults_;
  std::uint64_t begin_;
  std::uint64_t chunk_count_;
  std::uint64_t max_rows_;  ///< for which there is memory
  std::uint64_t next_chunk_ = 0;
  std::uint64_t next_line_;
  std::atomic<bool> is_complete_;
  std::vector<Chunk> chunks_;
  std::vector<Dictionary<>> words_;  ///< of the text columns
  TextTable out_;
  std::vector<Column*> targets_;  ///< of the columns, in `out_`; null unless they are wanted
};

}  // namespace

void ColumnSurvey::add(std::string_view value, bool value_is_quoted, std::uint64_t line) {
  constexpr std::int64_t kLargestExact = std::int64_t{1} << 53;
  if (value.empty()) {
    has_missing = true;
    return;
  }
  is_quoted = is_quoted && value_is_quoted;
  std::int64_t integer = 0;
  double number = 0;
  if (value.find('.') == std::string_view::npos && parse_integer(value, integer)) {
    has_large_integers = has_large_integers || integer > kLargestExact || integer < -kLargestExact;
    number = static_cast<double>(integer);
  } else if (parse_number(value, number)) {
    has_fractions = true;
  } else {
    if (is_missing_marker(value)) {
      has_missing = has_markers = true;
    } else if (first_word_line == 0) {
      first_word_line = line;
      first_word = value;
    }
    return;
  }
  has_numbers = true;
  largest = std::max(largest, number);
}

void ColumnSurvey::add(const ColumnSurvey& later) {
  has_numbers = has_numbers || later.has_numbers;
  has_fractions = has_fractions || later.has_fractions;
  has_large_integers = has_large_integers || later.has_large_integers;
  has_missing = has_missing || later.has_missing;
  has_markers = has_markers || later.has_markers;
  is_quoted = is_quoted && later.is_quoted;
  largest = std::max(largest, later.largest);
  if (first_word_line == 0) {
    first_word_line = later.first_word_line;
    first_word = later.first_word;
  }
}

bool is_missing_marker(std::string_view word) {
  constexpr std::array<std::string_view, 8> kMarkers = {"NA", "N/A", "n/a", "#N/A", "<NA>", "null", "NULL", "None"};
  return std::find(kMarkers.begin(), kMarkers.end(), word) != kMarkers.end();
}

void require_room(const ByteSource& bytes, const TextLayout& layout, std::uint64_t count_line, Faults& faults) {
  constexpr std::uint64_t kSlack = std::uint64_t{1} << 20;
  // A value has a character, and one follows it.
  const std::uint64_t row_bytes = 2 * std::max<std::uint64_t>(1, layout.columns.size());
  const std::uint64_t left = bytes.size() - std::min(bytes.size(), layout.begin);
  if (layout.rows != kRowsToEnd && layout.rows > (left + kSlack) / row_bytes)
    faults.fail(count_line, fmt::format("truncated: {} rows are declared, but only {} bytes follow", layout.rows, left),
                "correct the number of atoms, or write the file again");
}

TextTable read_text_rows(const ByteSource& bytes, const TextLayout& layout, Faults& faults) {
  return TableReader(bytes, layout, faults).run();
}

}  // namespace orrery::data
