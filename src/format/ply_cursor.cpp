// SPDX-License-Identifier: Apache-2.0
#include "format/ply_cursor.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace orrery::format {
namespace {

template <class T>
double as_double(const char* bytes, bool swap) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (swap)
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(copy[i], copy[sizeof(T) - 1 - i]);
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
}

double binary_value(const char* at, PlyType type, bool swap) {
  switch (type) {
    case PlyType::kInt8: return as_double<std::int8_t>(at, swap);
    case PlyType::kUint8: return as_double<std::uint8_t>(at, swap);
    case PlyType::kInt16: return as_double<std::int16_t>(at, swap);
    case PlyType::kUint16: return as_double<std::uint16_t>(at, swap);
    case PlyType::kInt32: return as_double<std::int32_t>(at, swap);
    case PlyType::kUint32: return as_double<std::uint32_t>(at, swap);
    case PlyType::kFloat32: return as_double<float>(at, swap);
    case PlyType::kFloat64: return as_double<double>(at, swap);
  }
  return 0;
}

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

PlyCursor::PlyCursor(std::string_view data, PlyEncoding encoding, int line)
    : at_(data.data()),
      end_(data.data() + data.size()),
      row_end_(encoding == PlyEncoding::kAscii ? at_ : end_),
      line_(line),
      ascii_(encoding == PlyEncoding::kAscii),
      swap_((encoding == PlyEncoding::kBigEndian) != (std::endian::native == std::endian::big)) {}

void PlyCursor::begin_row() {
  if (!ascii_) return;
  while (at_ < end_) {
    const void* const found = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
    row_end_ = found != nullptr ? static_cast<const char*>(found) : end_;
    row_line_ = line_;
    skip_blanks();
    if (at_ < row_end_) return;
    step_over_line_end();
  }
  row_end_ = end_;
  row_line_ = line_;
}

bool PlyCursor::end_row() {
  if (!ascii_) return true;
  skip_blanks();
  if (at_ < row_end_) return false;
  step_over_line_end();
  return true;
}

bool PlyCursor::take(PlyType type, double& value) {
  if (ascii_) return take_word(value);
  const std::size_t size = ply_size(type);
  if (bytes_left() < size) return false;
  value = binary_value(at_, type, swap_);
  at_ += size;
  return true;
}

bool PlyCursor::skip(const PlyProperty& property) {
  double value = 0;
  if (!property.is_list) return take(property.type, value);
  if (!take(property.count_type, value)) return false;
  is_bad_length_ = !(value >= 0) || value != std::floor(value);
  if (is_bad_length_) return false;
  for (double i = 0; i < value; ++i) {
    double ignored = 0;
    if (!take(property.type, ignored)) return false;  // stops at the end of the data, whatever the length is
  }
  return true;
}

std::string PlyCursor::fault() const {
  if (is_bad_length_) return "the length of the list is not a non-negative integer";
  if (ascii_ && at_ < row_end_) return "`" + word() + "` is not a number";
  return ascii_ && row_end_ < end_ ? "unexpected end of line; a row must be one line" : "unexpected end of file";
}

std::string PlyCursor::word() const {
  constexpr std::ptrdiff_t kLongestShown = 40;
  const char* const most = at_ + std::min(kLongestShown, row_end_ - at_);
  return {at_, std::find_if(at_, most, is_blank)};
}

void PlyCursor::skip_blanks() {
  while (at_ < row_end_ && is_blank(*at_)) ++at_;
}

void PlyCursor::step_over_line_end() {
  at_ = row_end_;
  if (at_ == end_) return;
  ++at_;
  ++line_;
}

bool PlyCursor::take_word(double& value) {
  skip_blanks();
  const char* const begin = at_ < row_end_ && *at_ == '+' ? at_ + 1 : at_;
  const auto [end, error] = std::from_chars(begin, row_end_, value);
  if (error == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
  if (end == begin || error == std::errc::invalid_argument || (end < row_end_ && !is_blank(*end))) return false;
  at_ = end;
  return true;
}

}  // namespace orrery::format
