// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace orrery::plot {

/// A file that convert() has written.
struct ConvertedFile {
  std::filesystem::path file;
  std::size_t spheres = 0;
  std::vector<std::string> columns;
  std::vector<std::string> notes;  ///< what was omitted, and why
  std::vector<base::Diagnostic> warnings;
};

}  // namespace orrery::plot
