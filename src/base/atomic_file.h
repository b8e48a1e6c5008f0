// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace orrery::base {

/// Returns the target of a symbolic link, even if it does not exist; other paths unchanged.
std::filesystem::path link_target(std::filesystem::path path);

/// A file that appears under its final name only when it is complete.
///
/// The caller writes to a temporary file in the same directory, which commit() syncs and renames. A file that is not
/// committed is removed, even if an exception is thrown or a signal ends the process (remove_unfinished_files).
class AtomicFile {
 public:
  /// Creates the temporary file. If `path` is a symbolic link, its target is written and the link stays.
  ///
  /// Errors     base::Error(kCannotCreate) with the reason, if no file can be created in the directory, or if the name
  ///            belongs to a directory, a device or a pipe
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Returns the path to write to; the file exists and is empty.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Syncs the temporary file and renames it.
  ///
  /// Errors     base::Error(kIo)
  void commit();

  /// Renames the temporary file without syncing it, for a file that is rewritten every second. Its readers never see an
  /// incomplete file; after a crash of the machine it may be empty.
  ///
  /// Errors     base::Error(kIo)
  void commit_unsynced();

 private:
  std::filesystem::path path_, target_, temporary_;
  int slot_;
  bool committed_ = false;
};

/// A buffered output file that appears under its final name only when it is complete.
class OutputFile {
 public:
  /// Creates the temporary file.
  ///
  /// Errors     those of AtomicFile
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// The buffer to append to; flush() writes it once it is large enough.
  std::string& buffer() { return buffer_; }
  /// Writes the buffer if it is large enough.
  ///
  /// Errors     base::Error(kIo)
  void flush();
  /// Writes the rest and commits the file.
  ///
  /// `synced`   false: commit with AtomicFile::commit_unsynced
  /// Errors     base::Error(kIo)
  void finish(bool synced = true);

 private:
  void write();

  std::filesystem::path path_;
  AtomicFile file_;
  int descriptor_;
  std::string buffer_;
};

/// Writes a text file, which appears under its final name only when it is complete.
///
/// `synced`   see OutputFile::finish
/// Errors     those of OutputFile
void write_text_file(const std::filesystem::path& path, std::string_view text, bool synced = true);

/// Unlinks the temporary files of all uncommitted AtomicFiles. Safe in a signal handler; the process must end right
/// after.
void remove_unfinished_files() noexcept;

/// Checks whether a file could be created, so that failure is found before any work; leaves no trace.
///
/// Errors     base::Error(kCannotCreate) naming path and reason
void check_creatable(const std::filesystem::path& path);

}  // namespace orrery::base
