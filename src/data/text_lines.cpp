// SPDX-License-Identifier: Apache-2.0
#include "data/text_lines.h"

#include <cstring>
#include <limits>

namespace orrery::data {

namespace {

const char* find_newline(const char* begin, const char* end) {
  const void* const found = begin == end ? nullptr : std::memchr(begin, '\n', static_cast<std::size_t>(end - begin));
  return found == nullptr ? end : static_cast<const char*>(found);
}

constexpr std::size_t kFirstReadBytes = std::size_t{16} << 10;
constexpr std::size_t kSkipBytes = std::size_t{1} << 20;
/// Typical length of a line.
constexpr std::uint64_t kLineBytes = 64;

}  // namespace

const char* line_end(const char* at) {
  return static_cast<const char*>(std::memchr(at, '\n', std::numeric_limits<std::size_t>::max() / 2));
}

std::uint64_t newline_count(const char* begin, const char* end) {
  // Counts in bytes, which compilers vectorize.
  constexpr std::ptrdiff_t kLanes = 32;
  constexpr std::ptrdiff_t kBlock = kLanes * 255;
  std::uint64_t count = 0;
  const char* at = begin;
  for (; end - at >= kBlock; at += kBlock) {
    std::uint8_t counts[kLanes] = {};
    for (std::ptrdiff_t i = 0; i < kBlock; i += kLanes)
      for (std::ptrdiff_t lane = 0; lane < kLanes; ++lane)
        counts[lane] = static_cast<std::uint8_t>(counts[lane] + (at[i + lane] == '\n' ? 1 : 0));
    for (const std::uint8_t n : counts) count += n;
  }
  return count + static_cast<std::uint64_t>(std::count(at, end, '\n'));
}

void TextLines::reserve(std::size_t count) {
  if (count <= capacity_) return;
  auto larger = std::make_unique_for_overwrite<char[]>(count);
  if (buffer_) std::memcpy(larger.get(), buffer_.get(), capacity_);
  buffer_ = std::move(larger);
  capacity_ = count;
}

void TextLines::read(const ByteSource& bytes, std::uint64_t first, std::uint64_t last, bool is_line_start) {
  last = std::min(last, bytes.size());
  first = std::min(first, last);
  // The byte before the range determines whether a line begins at its start.
  offset_ = is_line_start || first == 0 ? first : first - 1;
  auto count = static_cast<std::size_t>(last - offset_);
  constexpr std::size_t kStep = std::size_t{4} << 10;  // the rest of a line is read in steps
  reserve(count + kStep + kTextPadding);
  bytes.read(offset_, count, buffer_.get());
  begin_ = 0;
  if (offset_ != first) {
    const char* const newline = find_newline(buffer_.get(), buffer_.get() + count);
    begin_ = std::min(static_cast<std::size_t>(newline - buffer_.get()) + 1, count);
  }
  end_ = count;
  while (end_ > begin_ && buffer_[end_ - 1] != '\n') {
    const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(kStep, bytes.size() - offset_ - count));
    if (more == 0) {
      buffer_[end_++] = '\n';
      break;
    }
    if (count - static_cast<std::size_t>(last - offset_) > kMaxLineBytes) fail_as_too_long(bytes, 0);
    reserve(count + more + kStep + kTextPadding);
    bytes.read(offset_ + count, more, buffer_.get() + count);
    const char* const newline = find_newline(buffer_.get() + count, buffer_.get() + count + more);
    count += more;
    end_ = std::min(static_cast<std::size_t>(newline - buffer_.get()) + 1, count);
  }
  std::memset(buffer_.get() + end_, '\n', kTextPadding);
}

std::uint64_t TextLines::filled_count(bool skips_comments) const {
  std::uint64_t count = 0;
  for (const char* at = begin(); at < end(); at = line_end(at) + 1)
    if (!has_no_row(at, skips_comments)) ++count;
  return count;
}

/// Replaces the buffer by the next bytes of the file.
///
/// Result     false at the end of the file
bool TextCursor::fill(std::size_t count) {
  if (at_end()) return false;
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(count, bytes_->size() - place_.offset)));
  bytes_->read(place_.offset, buffer_.size(), buffer_.data());
  begin_ = 0;
  return true;
}

bool TextCursor::next(std::string& text) {
  text.clear();
  const std::uint64_t start = place_.offset;
  for (bool is_complete = false; !is_complete;) {
    if (begin_ == buffer_.size() && !fill(kFirstReadBytes)) break;
    const char* const begin = buffer_.data() + begin_;
    const char* const end = buffer_.data() + buffer_.size();
    const char* const newline = std::find(begin, end, '\n');
    text.append(begin, newline);
    is_complete = newline != end;
    const auto taken = static_cast<std::size_t>(newline - begin) + (is_complete ? 1 : 0);
    begin_ += taken;
    place_.offset += taken;
    if (text.size() > kMaxLineBytes) fail_as_too_long(*bytes_, place_.line);
  }
  if (place_.offset == start) return false;
  ++place_.line;
  if (text.ends_with('\r')) text.pop_back();
  return true;
}

bool TextCursor::next_filled(std::string& text) {
  while (next(text))
    if (text.find_first_not_of(" \t\r") != std::string::npos) return true;
  return false;
}

bool TextCursor::has_filled() const {
  const auto is_filled = [](char c) { return !is_blank(c) && c != '\n'; };
  if (std::any_of(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.end(), is_filled)) return true;
  std::string ignored;
  const std::size_t left = buffer_.size() - begin_;
  return TextCursor(*bytes_, {place_.offset + left, place_.line}).next_filled(ignored);
}

std::uint64_t TextCursor::skip(std::uint64_t count) {
  // Lines are counted in steps, so that a few of them do not cost a whole buffer.
  constexpr std::size_t kStep = std::size_t{16} << 10;
  std::uint64_t skipped = 0;
  bool is_inside = false;  // of a line
  while (skipped < count && (begin_ < buffer_.size() || fill(kSkipBytes))) {
    const char* const begin = buffer_.data() + begin_;
    const char* end = begin + std::min<std::uint64_t>({kStep, buffer_.size() - begin_, kLineBytes * (count - skipped)});
    const std::uint64_t here = newline_count(begin, end);
    if (here > count - skipped || (here == count - skipped && end[-1] != '\n')) {
      const char* at = begin;
      for (; skipped < count; ++skipped)
        at = static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(end - at))) + 1;
      end = at;
    } else {
      skipped += here;
    }
    is_inside = end[-1] != '\n';
    begin_ += static_cast<std::size_t>(end - begin);
    place_.offset += static_cast<std::uint64_t>(end - begin);
  }
  if (is_inside && skipped < count) ++skipped;  // the last line may lack its newline
  place_.line += skipped;
  return skipped;
}

}  // namespace orrery::data
