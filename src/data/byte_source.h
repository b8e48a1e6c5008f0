// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace orrery::data {

/// Bytes that arrive in an unknown number. In blocks, because a vector exists twice while it grows.
class ByteBlocks {
 public:
  std::uint64_t size() const { return size_; }

  /// Returns room for the next bytes: at least one, and at most `most`.
  ///
  /// Domain     most > 0
  std::span<char> room(std::uint64_t most);
  /// Appends the first `count` bytes of the room.
  void append(std::size_t count) { size_ += count; }
  void append(std::string_view bytes);

  /// Domain     offset + count <= size()
  void read(std::uint64_t offset, std::size_t count, char* out) const;

 private:
  std::vector<std::unique_ptr<char[]>> blocks_;
  std::uint64_t size_ = 0;
};

/// The bytes of a data file. A plain file is read on demand; a file compressed with gzip, zstd, bzip2 or xz is
/// decompressed into memory when it is opened. A UTF-8 byte order mark is skipped. Thread-safe.
class ByteSource {
 public:
  /// Opens a file.
  ///
  /// `limit`    maximum size after decompression, bytes: a small file may decompress to terabytes
  /// Errors     base::Error: kMissingInput, kIo; kBadData for damaged compressed data, and beyond the limit
  static std::shared_ptr<const ByteSource> open(const std::filesystem::path& file, std::uint64_t limit);

  /// Returns bytes in memory as a source. `file` is for messages.
  static std::shared_ptr<const ByteSource> of_memory(const std::filesystem::path& file, ByteBlocks bytes);
  static std::shared_ptr<const ByteSource> of_memory(const std::filesystem::path& file, std::string_view bytes);

  virtual ~ByteSource() = default;

  const std::filesystem::path& file() const { return file_; }
  std::uint64_t size() const { return size_; }
  bool is_in_memory() const { return is_in_memory_; }
  /// Memory that the bytes take until this is destroyed.
  std::uint64_t memory() const { return is_in_memory_ ? size_ : 0; }

  /// Reads exactly `count` bytes.
  ///
  /// Domain     offset + count <= size()
  /// Errors     base::Error(kIo), also if the file has been truncated meanwhile
  virtual void read(std::uint64_t offset, std::size_t count, char* out) const = 0;

  /// Returns bytes from `offset`, fewer than `count` at the end of the file.
  std::string text(std::uint64_t offset, std::size_t count) const;

 protected:
  ByteSource(std::filesystem::path file, std::uint64_t size, bool is_in_memory)
      : file_(std::move(file)), size_(size), is_in_memory_(is_in_memory) {}

  /// Offset of the first byte in the file.
  std::uint64_t begin() const { return begin_; }

 private:
  std::filesystem::path file_;
  std::uint64_t begin_ = 0;
  std::uint64_t size_ = 0;
  bool is_in_memory_ = false;
};

/// The bytes of a file, shared by its readers.
using Bytes = std::shared_ptr<const ByteSource>;

/// Returns whether a file begins like one that open() decompresses.
bool is_compressed(std::string_view head);

/// Reads the members of a ZIP archive one after another.
class ZipReader {
 public:
  /// Starts before the first member.
  ///
  /// Domain     `bytes` outlives this object
  explicit ZipReader(const ByteSource& bytes);
  ~ZipReader();
  ZipReader(const ZipReader&) = delete;
  ZipReader& operator=(const ZipReader&) = delete;

  /// Advances to the next member; false at the end.
  ///
  /// Errors     base::Error(kBadData) if the archive is damaged
  bool next();
  const std::string& name() const { return name_; }
  /// Reads the next bytes of the member, fewer than `count` only at its end.
  ///
  /// Errors     as for next()
  /// Cost       memory for the bytes that exist, not for `count`
  ByteBlocks read(std::uint64_t count);
  /// The same as text, for the header of a member.
  std::string read_text(std::size_t count);

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::string name_;
};

}  // namespace orrery::data
