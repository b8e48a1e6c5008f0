// SPDX-License-Identifier: Apache-2.0
#include "data/text_frames.h"

#include <limits>

#include <fmt/core.h>

#include "data/byte_source.h"
#include "data/faults.h"

namespace orrery::data {

int TextFrames::frame_count() {
  while (add_frame()) {
  }
  return static_cast<int>(frames_.size());
}

TextCursor TextFrames::frame(int number) {
  const auto index = static_cast<std::size_t>(number);
  while (frames_.size() <= index && add_frame()) {
  }
  return TextCursor(*bytes_, frames_.at(index));
}

void TextFrames::require_end(TextCursor rows_end, std::uint64_t count_line) const {
  std::string line;
  if (!rows_end.next_filled(line) || begins_frame(line)) return;
  Faults(bytes_->file())
      .fail(rows_end.line() - 1, fmt::format("more rows than line {} declares", count_line),
            "correct the number of atoms, or remove the rows");
}

/// Result     false if there are no more frames
bool TextFrames::add_frame() {
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
  end_.skip(skip_header(end_));
  frames_.push_back(place);
  return true;
}

}  // namespace orrery::data
