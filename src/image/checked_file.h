// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/filesystem.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace orrery::image {

/// An OpenImageIO output proxy that records the first failed write.
///
/// Some libraries behind OpenImageIO ignore the results of writes, and silently lose buffered data if the disk is full
/// at the end.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
 public:
  /// Opens a file for writing.
  ///
  /// Domain     the file exists; it is emptied
  explicit CheckedFile(const std::filesystem::path& file);
  ~CheckedFile() override { finish(); }
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  /// Flushes the buffer and closes the file.
  ///
  /// Result     0, or the errno of the first failed call since the file was opened
  int finish();

  const char* proxytype() const override { return "orrery"; }
  bool opened() const override { return file_ != nullptr; }
  bool seek(int64_t offset) override;
  size_t read(void* out, size_t size) override;
  size_t write(const void* bytes, size_t size) override;
  size_t pread(void* out, size_t size, int64_t offset) override;
  size_t pwrite(const void* bytes, size_t size, int64_t offset) override;
  size_t size() const override { return static_cast<size_t>(end_); }

 private:
  size_t fail(int error);

  std::FILE* file_ = nullptr;  ///< buffered: Radiance files are written a few bytes at a time
  int error_ = 0;
  int64_t end_ = 0;   ///< file size including the buffer
  int64_t next_ = 0;  ///< offset after the last write; -1 after a read
};

}  // namespace orrery::image
