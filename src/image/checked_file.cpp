// SPDX-License-Identifier: Apache-2.0
#include "image/checked_file.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace orrery::image {

CheckedFile::CheckedFile(const std::filesystem::path& file) : IOProxy(file.string(), Write) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_TRUNC | O_CLOEXEC);
  if (descriptor >= 0) file_ = fdopen(descriptor, "r+");
  if (file_ == nullptr) fail(errno);
}

int CheckedFile::finish() {
  if (std::FILE* const file = std::exchange(file_, nullptr); file != nullptr && std::fclose(file) != 0) fail(errno);
  return error_;
}

size_t CheckedFile::fail(int error) {
  if (error_ == 0) error_ = error;
  return 0;
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
  if (offset != next_ && fseeko(file_, offset, SEEK_SET) != 0) return fail(errno);
  if (std::fwrite(bytes, 1, size, file_) != size) return fail(errno);
  next_ = offset + static_cast<int64_t>(size);
  end_ = std::max(end_, next_);
  return size;
}

size_t CheckedFile::read(void* out, size_t size) {
  const size_t got = pread(out, size, m_pos);
  m_pos += static_cast<int64_t>(got);
  return got;
}

size_t CheckedFile::pread(void* out, size_t size, int64_t offset) {
  if (error_ != 0) return 0;
  next_ = -1;  // a seek must separate reading and writing
  if (fseeko(file_, offset, SEEK_SET) != 0) return fail(errno);
  const size_t got = std::fread(out, 1, size, file_);
  if (std::ferror(file_) != 0) fail(errno);
  return got;
}

}  // namespace orrery::image
