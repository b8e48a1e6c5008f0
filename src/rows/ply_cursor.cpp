// SPDX-License-Identifier: Apache-2.0
#include "rows/ply_cursor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/core.h>

#include "data/faults.h"
#include "data/text_lines.h"
#include "data/text_rows.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

double binary_value(const char* at, NumberType type, bool is_big_endian) {
  return with_type(type, [=](auto number) { return static_cast<double>(load<decltype(number)>(at, is_big_endian)); });
}

bool is_white_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

PlyCursor::PlyCursor(const ByteSource& bytes, std::uint64_t begin, PlyEncoding encoding, int line)
    : bytes_(&bytes),
      next_(std::min(begin, bytes.size())),
      buffer_(2 * kMaxLineBytes),
      line_(line),
      ascii_(encoding == PlyEncoding::kAscii),
      is_big_endian_(encoding == PlyEncoding::kBigEndian) {
  fill();
}

/// Moves the unread bytes to the front of the buffer, and reads more.
void PlyCursor::fill() {
  const auto left = static_cast<std::size_t>(end_ - at_);
  if (left > 0) std::memmove(buffer_.data(), at_, left);
  const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_.size() - left, bytes_->size() - next_));
  bytes_->read(next_, more, buffer_.data() + left);
  next_ += more;
  at_ = buffer_.data();
  end_ = row_end_ = at_ + left + more;
}

void PlyCursor::find_row_end() {
  const auto found = [&] { return std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_)); };
  const void* newline = found();
  while (newline == nullptr && next_ < bytes_->size()) {
    if (static_cast<std::size_t>(end_ - at_) > kMaxLineBytes)
      Faults(bytes_->file())
          .fail(static_cast<std::uint64_t>(line_), "a line is longer than 1 MiB", "the file is damaged");
    fill();
    newline = found();
  }
  row_end_ = newline != nullptr ? static_cast<const char*>(newline) : end_;
}

void PlyCursor::begin_row() {
  if (!ascii_) return;
  for (row_line_ = line_; bytes_left() > 0; row_line_ = line_) {
    find_row_end();
    skip_blanks();
    if (at_ < row_end_) return;
    step_over_line_end();
  }
  row_end_ = end_;
}

bool PlyCursor::end_row() {
  if (!ascii_) return true;
  skip_blanks();
  if (at_ < row_end_) return false;
  step_over_line_end();
  return true;
}

bool PlyCursor::take(NumberType type, double& value) {
  if (ascii_) return take_word(value);
  const std::size_t size = size_of(type);
  if (bytes_left() < size) return false;
  if (static_cast<std::size_t>(end_ - at_) < size) fill();
  value = binary_value(at_, type, is_big_endian_);
  at_ += size;
  return true;
}

bool PlyCursor::skip(const PlyProperty& property) {
  double value = 0;
  if (!property.is_list) return take(property.type, value);
  if (!take(property.count_type, value)) return false;
  is_bad_length_ = !(value >= 0) || value != std::floor(value);
  if (is_bad_length_) return false;
  if (!ascii_) {
    const std::size_t size = size_of(property.type);
    if (value > static_cast<double>(bytes_left() / size)) return false;
    skip_bytes(static_cast<std::uint64_t>(value) * size);
    return true;
  }
  for (double i = 0; i < value; ++i) {
    double ignored = 0;
    if (!take(property.type, ignored)) return false;  // stops at the end of the row, regardless of the length
  }
  return true;
}

void PlyCursor::skip_bytes(std::uint64_t bytes) {
  const std::uint64_t some = std::min(bytes, static_cast<std::uint64_t>(end_ - at_));
  at_ += some;
  next_ += bytes - some;
}

std::string PlyCursor::fault() const {
  if (is_bad_length_) return "the length of the list is not a non-negative integer";
  if (ascii_ && at_ < row_end_) return fmt::format("`{}` is not a number", word());
  return ascii_ && bytes_left() > 0 ? "unexpected end of line; a row must be one line" : "unexpected end of file";
}

std::string PlyCursor::word() const {
  constexpr std::ptrdiff_t kLongestShown = 40;
  const char* const most = at_ + std::min(kLongestShown, row_end_ - at_);
  return {at_, std::find_if(at_, most, is_white_space)};
}

void PlyCursor::skip_blanks() {
  while (at_ < row_end_ && is_white_space(*at_)) ++at_;
}

void PlyCursor::step_over_line_end() {
  at_ = row_end_;
  if (at_ == end_) return;
  ++at_;
  ++line_;
}

bool PlyCursor::take_word(double& value) {
  skip_blanks();
  const char* const end = std::find_if(at_, row_end_, is_white_space);
  if (!parse_number({at_, end}, value)) return false;
  at_ = end;
  return true;
}

}  // namespace orrery::rows
