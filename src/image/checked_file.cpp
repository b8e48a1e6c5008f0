// SPDX-License-Identifier: Apache-2.0
#include "image/checked_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace orrery::image {
namespace {

/// Write buffer size. Radiance files are written a few bytes at a time; a system call for each would be too slow.
constexpr std::size_t kLargestPending = std::size_t{1} << 16;

}  // namespace

CheckedFile::CheckedFile(const std::filesystem::path& file) : IOProxy(file.string(), Write) {
  descriptor_ = ::open(file.c_str(), O_RDWR | O_TRUNC | O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
}

CheckedFile::~CheckedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int CheckedFile::finish() {
  flush_pending();
  if (descriptor_ >= 0 && ::close(descriptor_) != 0) fail(errno);
  descriptor_ = -1;
  return error_;
}

bool CheckedFile::fail(int error) {
  if (error_ == 0) error_ = error;
  return false;
}

bool CheckedFile::write_at(const unsigned char* bytes, size_t size, int64_t offset) {
  while (size > 0) {
    const ssize_t written = ::pwrite(descriptor_, bytes, size, offset);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail(errno);
    if (written == 0) return fail(ENOSPC);
    bytes += written;
    size -= static_cast<size_t>(written);
    offset += written;
  }
  return true;
}

bool CheckedFile::flush_pending() {
  if (error_ != 0) return false;
  const bool written = write_at(pending_.data(), pending_.size(), pending_offset_);
  pending_.clear();
  return written;
}

bool CheckedFile::seek(int64_t offset) {
  if (offset < 0) return false;
  m_pos = offset;
  return true;
}

size_t CheckedFile::write(const void* bytes, size_t size) {
  const size_t written = pwrite(bytes, size, m_pos);
  m_pos += static_cast<int64_t>(written);
  return written;
}

size_t CheckedFile::pwrite(const void* bytes, size_t size, int64_t offset) {
  if (error_ != 0) return 0;
  const auto* const first = static_cast<const unsigned char*>(bytes);
  const bool continues = offset == pending_offset_ + static_cast<int64_t>(pending_.size());
  if (!continues || pending_.size() + size > kLargestPending) {
    if (!flush_pending()) return 0;
    pending_offset_ = offset;
  }
  if (size > kLargestPending) {
    if (!write_at(first, size, offset)) return 0;
    pending_offset_ = offset + static_cast<int64_t>(size);
  } else {
    pending_.insert(pending_.end(), first, first + size);
  }
  end_ = std::max(end_, offset + static_cast<int64_t>(size));
  return size;
}

size_t CheckedFile::read(void* out, size_t size) {
  const size_t got = pread(out, size, m_pos);
  m_pos += static_cast<int64_t>(got);
  return got;
}

size_t CheckedFile::pread(void* out, size_t size, int64_t offset) {
  if (!flush_pending()) return 0;
  pending_offset_ = end_;
  size_t got = 0;
  while (got < size) {
    const ssize_t n =
        ::pread(descriptor_, static_cast<unsigned char*>(out) + got, size - got, offset + static_cast<int64_t>(got));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno);
    if (n <= 0) break;
    got += static_cast<size_t>(n);
  }
  return got;
}

size_t CheckedFile::size() const { return static_cast<size_t>(end_); }

}  // namespace orrery::image
