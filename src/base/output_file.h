// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/atomic_file.h"

namespace orrery::base {

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

}  // namespace orrery::base
