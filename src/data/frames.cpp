// SPDX-License-Identifier: Apache-2.0
#include "data/frames.h"

#include <limits>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::data {

Table SingleFrame::empty_table(const std::vector<std::string>& names) const {
  static const Values kEmpty[] = {std::vector<double>(),
                                  std::vector<float>(),
                                  std::vector<std::int64_t>(),
                                  std::vector<std::int32_t>(),
                                  std::vector<std::uint16_t>(),
                                  std::vector<std::uint8_t>(),
                                  Words()};
  Table out;
  out.rows = static_cast<std::size_t>(info_.rows);
  for (const std::string& name : names)
    out.columns.push_back({name, kEmpty[static_cast<std::size_t>(find_named(info_.columns, name)->type)]});
  return out;
}

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

TextFrame TextFrames::unsettled_frame(int number) {
  has_frame(number);
  return header(TextCursor(*bytes_, frames_.at(static_cast<std::size_t>(number))));
}

TextFrame TextFrames::frame(int number) {
  TextFrame out = unsettled_frame(number);
  if (!out.info.roles.element.empty()) settle_element(names(), out.info.roles);
  return out;
}

/// The distinct elements in the first frame that has rows: what they mean must not change from frame to frame. Empty if
/// it has none, and if they cannot be read, which is reported when their frame is read.
const std::vector<std::string>& TextFrames::names() {
  if (names_) return *names_;
  names_.emplace();
  TextFrame found;
  for (int i = 0; found.info.rows == 0 && has_frame(i); ++i) {
    found = unsettled_frame(i);
    if (found.info.roles.element.empty()) return *names_;
  }
  if (found.info.rows == 0) return *names_;
  TextLayout& layout = found.layout;
  const ColumnInfo* const element = find_named(layout.columns, found.info.roles.element);
  layout.columns.resize(static_cast<std::size_t>(element - layout.columns.data()) + 1);
  layout.wanted = {element->name};
  layout.allows_more = true;
  try {
    Faults faults(bytes_->file());
    *names_ = std::get<Words>(read_text_rows(*bytes_, layout, faults).table.columns[0].values).words;
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kBadData) throw;
  }
  return *names_;
}

Table TextFrames::read_rows(const TextFrame& frame) {
  Faults faults(bytes_->file());
  const TextLayout& layout = frame.layout;
  TextTable out = read_text_rows(*bytes_, layout, faults);
  TextCursor cursor(*bytes_, {out.end, layout.first_line + out.table.rows});
  if (left_ > 0 && layout.begin == end_.offset()) {  // saves the search for the next frame from reading the rows again
    end_ = cursor;
    left_ = 0;
  }
  std::string line;
  if (cursor.next_filled(line) && !begins_frame(line))
    faults.fail(cursor.line() - 1, fmt::format("more rows than line {} declares", frame.count_line),
                "correct the number of atoms, or remove the rows");
  return std::move(out.table);
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
