// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace orrery::data {

/// The bytes of a data file. A plain file is read on demand; a file compressed with gzip, zstd, bzip2 or xz is
/// decompressed into memory when it is opened. Thread-safe.
class ByteSource {
 public:
  /// Opens a file.
  ///
  /// `limit`    maximum size after decompression, bytes: a small file may decompress to terabytes
  /// Errors     base::Error: kMissingInput, kIo; kBadData for damaged compressed data, and beyond the limit
  static std::shared_ptr<const ByteSource> open(const std::filesystem::path& file, std::uint64_t limit);

  /// Returns bytes in memory as a source. `file` is for messages.
  static std::shared_ptr<const ByteSource> of_memory(const std::filesystem::path& file, std::vector<char> bytes);

  virtual ~ByteSource() = default;

  const std::filesystem::path& file() const { return file_; }
  std::uint64_t size() const { return size_; }
  bool is_compressed() const { return is_compressed_; }

  /// Reads exactly `count` bytes.
  ///
  /// Domain     offset + count <= size()
  /// Errors     base::Error(kIo), also if the file has been truncated meanwhile
  virtual void read(std::uint64_t offset, std::size_t count, char* out) const = 0;

  /// Returns bytes from `offset`, fewer than `count` at the end of the file.
  std::string text(std::uint64_t offset, std::size_t count) const;

 protected:
  ByteSource(std::filesystem::path file, std::uint64_t size, bool is_compressed)
      : file_(std::move(file)), size_(size), is_compressed_(is_compressed) {}

 private:
  std::filesystem::path file_;
  std::uint64_t size_ = 0;
  bool is_compressed_ = false;
};

}  // namespace orrery::data
