// SPDX-License-Identifier: Apache-2.0
#include "data/frames.h"

#include <limits>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::data {

int TextFrames::frame_count() {
  while (add_frame()) {
  }
  return static_cast<int>(frames_.size());
}

bool TextFrames::has_frame(int number) {
  while (frames_.size() <= static_cast<std::size_t>(number))
    if (!add_frame()) return false;
  return true;
}

TextCursor TextFrames::frame(int number) {
  has_frame(number);
  return TextCursor(*bytes_, frames_.at(static_cast<std::size_t>(number)));
}

const std::vector<std::string>& TextFrames::names() {
  if (names_) return *names_;
  names_.emplace();
  std::optional<Names> found;
  for (int i = 0; has_frame(i) && (found = names_of(i)) && found->count == 0;) ++i;
  if (!found || found->count == 0) return *names_;
  TextLayout layout;
  layout.begin = found->rows.offset;
  layout.first_line = found->rows.line;
  layout.rows = found->count;
  layout.columns.assign(found->column + 1, {ColumnType::kText, false});
  layout.columns.back().is_wanted = true;
  layout.allows_more = true;
  try {
    Faults faults(bytes_->file());
    *names_ = std::get<Words>(read_text_rows(*bytes_, layout, faults).values.back()).words;
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kBadData) throw;
  }
  return *names_;
}

TextTable TextFrames::read_rows(const TextLayout& layout, std::uint64_t count_line) {
  Faults faults(bytes_->file());
  TextTable out = read_text_rows(*bytes_, layout, faults);
  TextCursor cursor(*bytes_, {out.end, layout.first_line + out.rows});
  if (left_ > 0 && layout.begin == end_.offset()) {  // saves the search for the next frame from reading the rows again
    end_ = cursor;
    left_ = 0;
  }
  std::string line;
  if (cursor.next_filled(line) && !begins_frame(line))
    faults.fail(cursor.line() - 1, fmt::format("more rows than line {} declares", count_line),
                "correct the number of atoms, or remove the rows");
  return out;
}

/// Result     false if there are no more frames
bool TextFrames::add_frame() {
  end_.skip(std::exchange(left_, 0));
  std::string line;
  TextCursor ahead(*bytes_, end_.place());
  if (!ahead.next_filled(line)) {
    if (frames_.empty()) Faults(bytes_->file()).fail(0, "the file has no frames");
    return false;
  }
  if (frames_.size() == static_cast<std::size_t>(std::numeric_limits<int>::max()))
    Faults(bytes_->file()).fail(ahead.line(), "too many frames");
  const TextCursor::Place place = end_.place();
  // A frame with too few rows is reported when it is read: those before it are usable.
  left_ = skip_header(end_);
  frames_.push_back(place);
  return true;
}

}  // namespace orrery::data
