// SPDX-License-Identifier: Apache-2.0
#include "data/text_rows.h"

#include <sys/mman.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "data/byte_source.h"
#include "data/dictionary.h"
#include "data/faults.h"
#include "data/text_lines.h"
#include "data/text_row_parser.h"

namespace orrery::data {
namespace {

/// A part of the file on its way through the pipeline.
struct Chunk {
  explicit Chunk(const TextLayout& layout) : parser(layout) {}

  TextLines lines;
  RowParser parser;
  std::uint64_t number = 0;
  std::uint64_t line_count = 0;
  std::uint64_t row_count = 0;
  std::uint64_t first_line = 0;
  std::uint64_t first_row = 0;
  std::uint64_t parsed_rows = 0;
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

Values reserved_column(const TextColumn& column, std::uint64_t rows) {
  const auto reserved = [&](auto values) {
    if (column.is_wanted) values.reserve(rows);
    prefer_huge_pages(values);
    return values;
  };
  switch (column.type) {
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
    table_.end = begin_;
    for (const TextColumn& column : layout.columns) table_.values.push_back(reserved_column(column, max_rows_));
    if (layout.surveys) table_.surveys.resize(layout.columns.size());
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
    if (layout_.rows != kRowsToEnd && table_.rows < layout_.rows)
      faults_.add(next_line_, fmt::format("the file ends after {} of {} rows", table_.rows, layout_.rows),
                  "the file is truncated, or its header declares too many");
    faults_.raise_if_any();
    for (std::size_t c = 0; c < words_.size(); ++c)
      if (auto* const column = std::get_if<Words>(&table_.values[c])) column->words = words_[c].take();
    return std::move(table_);
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
    chunk->first_row = table_.rows;
    chunk->parsed_rows = std::min(chunk->row_count, max_rows_ - table_.rows);
    next_line_ += chunk->line_count;
    table_.rows += chunk->parsed_rows;
    chunk->addresses.clear();
    for (std::size_t c = 0; c < table_.values.size(); ++c)
      chunk->addresses.push_back(layout_.columns[c].is_wanted ? resized(table_.values[c], table_.rows) : nullptr);
    if (table_.rows == max_rows_) is_complete_ = true;
    return chunk;
  }

  Chunk* parse(Chunk* chunk) const {
    const char* const end =
        chunk->parser.parse(chunk->lines, chunk->first_line, chunk->first_row, chunk->parsed_rows, chunk->addresses);
    chunk->end = std::min(chunk->lines.offset_of(end), bytes_.size());  // there may be an added newline
    return chunk;
  }

  void finish(const Chunk& chunk) {
    if (chunk.parsed_rows > 0) table_.end = chunk.end;
    const auto& faults = chunk.parser.faults();
    for (const RowParser::Fault& fault : faults) faults_.add_of_many(fault.line, fault.text);
    // Those that the parser did not keep follow ten others, and are only counted.
    for (std::uint64_t i = faults.size(); i < chunk.parser.fault_count(); ++i) faults_.add_of_many(0, {});
    for (std::size_t c = 0; c < table_.values.size(); ++c)
      if (layout_.columns[c].type == ColumnType::kText && layout_.columns[c].is_wanted) merge_words(chunk, c);
    for (std::size_t c = 0; c < table_.surveys.size(); ++c) table_.surveys[c].add(chunk.parser.surveys()[c]);
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
  TextTable table_;
};

}  // namespace

TextTable read_text_rows(const ByteSource& bytes, const TextLayout& layout, Faults& faults) {
  return TableReader(bytes, layout, faults).run();
}

}  // namespace orrery::data
