// SPDX-License-Identifier: Apache-2.0
#include "data/frames.h"

#include <limits>

#include <fmt/core.h>

#include "base/error.h"
#include "base/stop_point.h"
#include "base/text.h"

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

TextFrame TextFrames::frame(int number) {
  has_frame(number);
  TextFrame out = header(TextCursor(*bytes_, frames_.at(static_cast<std::size_t>(number))));
  Faults faults(bytes_->file());
  require_room(*bytes_, out.layout, out.count_line, faults);
  return out;
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
  const base::StopPoint stop;
  stop.check();
  end_.skip(std::exchange(left_, 0));
  if (!end_.has_filled()) {
    if (frames_.empty()) Faults(bytes_->file()).fail(0, "the file has no frames");
    return false;
  }
  if (frames_.size() == static_cast<std::size_t>(std::numeric_limits<int>::max()))
    Faults(bytes_->file()).fail(end_.line(), "too many frames");
  if (frames_.size() == frames_.capacity()) {  // while the table grows, it exists twice
    const std::uint64_t bytes = memory() + 2 * frames_.size() * sizeof(frames_[0]);
    if (memory_limit_ > 0 && bytes > memory_limit_)
      throw base::Error(
          base::ErrorKind::kNoMemory,
          fmt::format("{}: finding more than {} frames needs {}; {} are available", bytes_->file().string(),
                      frames_.size(), base::bytes_text(bytes), base::bytes_text(memory_limit_)));
  }
  const TextCursor::Place place = end_.place();
  // A frame with too few rows is reported when it is read: those before it are usable.
  left_ = skip_header(end_);
  frames_.push_back(place);
  return true;
}

}  // namespace orrery::data
