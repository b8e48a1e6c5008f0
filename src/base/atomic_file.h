// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace orrery::base {

/// A file that appears under its name whole, or not at all.
///
/// It is written under a temporary name in the same directory by whoever likes, then synced and renamed. What was not
/// committed is removed, also when an exception passes by or the process is told to stop (remove_unfinished_files).
class AtomicFile {
 public:
  /// A link stays a link: the file that it leads to is written.
  ///
  /// Errors     base::Error(kCannotCreate) naming the reason, where the directory cannot take a new file, or where the
  ///            name belongs to a directory, a device or a pipe
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write; exists, and is empty, until somebody writes.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Syncs and renames.
  ///
  /// Errors     base::Error(kIo)
  void commit();

 private:
  std::filesystem::path path_, target_, temporary_;
  int slot_;
  bool committed_ = false;
};

/// Unlinks what AtomicFiles have not committed. Safe in a signal handler; the process must end right after.
void remove_unfinished_files() noexcept;

/// Writes a text as an AtomicFile.
///
/// Errors     as AtomicFile
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Finds out before any work is done whether a file could be created there; leaves no trace.
///
/// Errors     base::Error(kCannotCreate) naming path and reason
void check_creatable(const std::filesystem::path& path);

}  // namespace orrery::base
