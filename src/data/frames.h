// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "data/columns.h"
#include "data/data_file.h"
#include "data/text_lines.h"
#include "data/text_rows.h"

namespace orrery::data {

/// A file with one frame, which is described when it is opened.
class SingleFrame : public DataFile {
 public:
  explicit SingleFrame(Bytes bytes) : bytes_(std::move(bytes)) {}

  int frame_count() final { return 1; }
  FrameInfo describe(int) override { return info_; }
  std::uint64_t memory() const override { return bytes_->memory(); }

 protected:
  /// Returns a table of these columns without values, which the caller appends.
  Table empty_table(const std::vector<std::string>& names) const;

  Bytes bytes_;
  FrameInfo info_;
};

/// What the header of a frame in a text file says.
struct TextFrame {
  FrameInfo info;
  TextLayout layout;             ///< of the rows
  std::uint64_t count_line = 0;  ///< the line that declares their number
};

/// A text file of frames, each a header and a number of rows. Frames are located on demand.
class TextFrames : public DataFile {
 public:
  int frame_count() override;
  bool has_frame(int number) override;
  FrameInfo describe(int number) override { return frame(number).info; }
  std::uint64_t memory() const override { return bytes_->memory() + frames_.capacity() * sizeof(frames_[0]); }

 protected:
  TextFrames(Bytes bytes, const OpenOptions& options)
      : bytes_(std::move(bytes)), memory_limit_(options.memory_limit), end_(*bytes_) {}

  const ByteSource& bytes() const { return *bytes_; }

  /// Reads the header of a frame.
  ///
  /// Errors     base::Error(kBadData) for a malformed header up to that frame
  TextFrame frame(int number);

  /// Reads the columns `frame.layout.wanted`, and checks that the rows are followed by another frame or by the end of
  /// the file.
  Table read_rows(const TextFrame& frame);

 private:
  /// Reads a header.
  virtual TextFrame header(TextCursor cursor) = 0;
  /// Skips a header, and returns the number of rows.
  virtual std::uint64_t skip_header(TextCursor& cursor) const = 0;
  virtual bool begins_frame(std::string_view line) const = 0;

  bool add_frame();

  Bytes bytes_;
  std::uint64_t memory_limit_;             ///< see OpenOptions
  std::vector<TextCursor::Place> frames_;  ///< frames found so far
  TextCursor end_;                         ///< position after the last of them, or at its rows
  std::uint64_t left_ = 0;                 ///< number of rows that `end_` has yet to skip
};

}  // namespace orrery::data
