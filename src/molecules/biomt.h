// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/faults.h"
#include "data/table.h"

namespace orrery::molecules {

/// Reads the biological assemblies in REMARK 350 of a PDB file. Values are separated by spaces, not by column: serial
/// numbers of transforms above 999 overflow their columns and shift those to the right.
///
/// Reference  pdb-format
class BiomtReader {
 public:
  /// Takes the text of a line after "REMARK 350".
  ///
  /// Errors     base::Error(kBadData): malformed or incomplete transforms
  void take(std::string_view text, std::uint64_t line, data::Faults& faults);

  /// Returns the assemblies after the last line.
  std::vector<data::Assembly> finish(data::Faults& faults);

 private:
  data::AssemblyPart& part();

  std::vector<data::Assembly> assemblies_;
  data::Transform transform_;
  int row_ = 0;  ///< number of rows of `transform_` that have been read
  std::string serial_;
};

}  // namespace orrery::molecules
