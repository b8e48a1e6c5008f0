// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace orrery::base {

/// Returns the target of a symbolic link, even if it does not exist; other paths unchanged.
std::filesystem::path link_target(std::filesystem::path path);

/// A temporary file or folder of this process, locked until destruction, which removes it, unless it has been renamed.
///
/// Its name is `.STEM.XXXXXXXXXXXXXX`. The last letters are a mark that depends on the others and on the name of the
/// machine. When a process first creates a temporary in a folder, it removes those there that have such a mark, but no
/// lock: their processes were killed.
class Temporary {
 public:
  enum class Kind { kFile, kFolder };

  /// Creates the file or folder.
  ///
  /// Errors     FileError(kCannotCreate) about `subject`
  Temporary(Kind kind, const std::filesystem::path& folder, const std::string& stem,
            const std::filesystem::path& subject);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }
  int descriptor() const noexcept { return descriptor_; }
  /// Renames it.
  ///
  /// Result     false, and errno, on failure
  bool rename(const std::filesystem::path& target) noexcept;

 private:
  void release() noexcept;

  std::filesystem::path path_;
  int descriptor_ = -1;
  int slot_ = -1;
};

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

  /// The final path.
  const std::filesystem::path& path() const noexcept { return path_; }
  /// Returns the path to write to; the file exists and is empty.
  const std::filesystem::path& temporary() const noexcept { return temporary_.path(); }
  /// The temporary file, open for reading and writing.
  int descriptor() const noexcept { return temporary_.descriptor(); }

  /// Syncs the temporary file and renames it.
  ///
  /// `synced`   false: for a file that is rewritten every second. Its readers never see an incomplete file; after a
  ///            crash of the machine it may be empty
  /// Errors     base::Error(kIo)
  void commit(bool synced = true);

 private:
  std::filesystem::path path_, target_;
  Temporary temporary_;
};

/// A buffered output file that appears under its final name only when it is complete.
class OutputFile {
 public:
  /// Creates the temporary file.
  ///
  /// Errors     those of AtomicFile
  explicit OutputFile(std::filesystem::path path) : file_(std::move(path)) {}

  const std::filesystem::path& path() const { return file_.path(); }
  /// The buffer to append to; flush() writes it once it is large enough.
  std::string& buffer() { return buffer_; }
  /// Writes the buffer if it is large enough.
  ///
  /// Errors     base::Error(kIo)
  void flush();
  /// Writes the rest and commits the file.
  ///
  /// `synced`   see AtomicFile::commit
  /// Errors     base::Error(kIo)
  void finish(bool synced = true);

 private:
  void write();

  AtomicFile file_;
  std::string buffer_;
};

/// Writes a text file, which appears under its final name only when it is complete.
///
/// `synced`   see AtomicFile::commit
/// Errors     those of OutputFile
void write_text_file(const std::filesystem::path& path, std::string_view text, bool synced = true);

/// A new temporary folder, removed with its content on destruction.
class TempDir {
 public:
  /// Creates the folder.
  ///
  /// Errors     base::Error(kCannotCreate)
  TempDir();

  const std::filesystem::path& path() const noexcept { return folder_.path(); }

 private:
  Temporary folder_;
};

/// Removes the temporary files and folders of this process. Safe in a signal handler; the process must end right after.
void remove_unfinished_files() noexcept;

/// Checks whether a file could be created, so that failure is found before any work; leaves no trace. Outputs of a
/// command are checked by FileSet::add_output.
///
/// Errors     base::Error(kCannotCreate) naming path and reason
void check_creatable(const std::filesystem::path& path);

}  // namespace orrery::base
