// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "data/table.h"

namespace orrery::data {

/// A file that is written through a buffer and appears when it is complete.
class TableOutput {
 public:
  /// Errors     those of base::AtomicFile
  explicit TableOutput(const std::filesystem::path& path);
  ~TableOutput();
  TableOutput(const TableOutput&) = delete;
  TableOutput& operator=(const TableOutput&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// The bytes to append to; flush() writes them once there are enough.
  std::string& buffer() { return buffer_; }
  /// Errors     base::Error(kIo)
  void flush();
  /// Writes the rest and commits the file.
  ///
  /// Errors     base::Error(kIo)
  void finish();

 private:
  void write();

  std::filesystem::path path_;
  base::AtomicFile file_;
  int descriptor_;
  std::string buffer_;
};

/// Raises base::Error(kUsage): "cannot write FILE: TEXT".
[[noreturn]] void refuse_to_write(const std::filesystem::path& file, const std::string& text);

/// The writers of the formats. They return the names of columns that they leave out.
std::vector<std::string> write_ply_table(TableOutput& out, const Table& table);
void write_npy_table(TableOutput& out, const Table& table);
void write_csv_table(TableOutput& out, const Table& table);
std::vector<std::string> write_xyz_table(TableOutput& out, const Table& table);

}  // namespace orrery::data
