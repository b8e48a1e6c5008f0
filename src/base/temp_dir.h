// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace orrery::base {

/// A new temporary folder, removed with its content on destruction.
class TempDir {
 public:
  /// Creates the folder.
  ///
  /// Errors     Error(kCannotCreate)
  TempDir();
  ~TempDir();
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace orrery::base
