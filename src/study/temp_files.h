// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "film/forward.h"

namespace orrery::study {

/// A new temporary folder, removed with its content on destruction.
class TempDir {
 public:
  /// Creates the folder.
  ///
  /// Errors     base::Error(kCannotCreate)
  TempDir();
  ~TempDir();
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct FilePoint;

/// Measures size, write time and error of an image as EXR, in half and float with each compression.
///
/// Errors     base::Error: kCannotCreate, kIo
std::vector<FilePoint> measure_file_axis(const film::Picture& picture);

}  // namespace orrery::study
