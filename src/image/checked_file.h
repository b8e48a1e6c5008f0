// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace orrery::image {

/// The file that OpenImageIO writes into, so that no failed write goes unseen.
///
/// The libraries behind it do not all look at what a write returns, and what they keep in a buffer is lost in silence
/// when the disk is full at the end. Here every byte passes one place, and the first failure is kept.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
 public:
  /// Domain     the file exists; it is emptied
  explicit CheckedFile(const std::filesystem::path& file);
  ~CheckedFile() override;
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  /// Writes what is held back and closes.
  ///
  /// Result     0, or the errno of the first call that failed since the file was opened
  int finish();

  const char* proxytype() const override { return "orrery"; }
  bool opened() const override { return descriptor_ >= 0; }
  bool seek(int64_t offset) override;
  size_t read(void* out, size_t size) override;
  size_t write(const void* bytes, size_t size) override;
  size_t pread(void* out, size_t size, int64_t offset) override;
  size_t pwrite(const void* bytes, size_t size, int64_t offset) override;
  size_t size() const override;

 private:
  bool flush_pending();
  bool write_at(const unsigned char* bytes, size_t size, int64_t offset);
  bool fail(int error);

  int descriptor_ = -1;
  int error_ = 0;
  int64_t end_ = 0;                     ///< of what was given to this object, in the file already or held back
  int64_t pending_offset_ = 0;          ///< in the file, of the first byte held back
  std::vector<unsigned char> pending_;  ///< small writes in a row are gathered here
};

}  // namespace orrery::image
