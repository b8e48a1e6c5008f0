// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace orrery::study {

/// A folder of its own for temporary files, gone with everything in it when this goes.
class Scratch {
 public:
  /// Errors     base::Error(kCannotCreate)
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace orrery::study
