// SPDX-License-Identifier: Apache-2.0
// No header of C++20: where clang rejects gemmi's grammar in C++20, tests/fuzz/run.sh compiles cif_rows.cpp in C++17.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "data/faults.h"

namespace orrery::data {

/// A table of a CIF file to be read, given as a loop or as single items.
struct CifTable {
  std::string category;            ///< "_atom_site."
  std::vector<std::string> items;  ///< names of the items, lower case: "cartn_x"
  /// Receives a row: the values of `items`, unquoted; empty where the file has no value, `?` or `.`. `line` is the
  /// row's last line.
  std::function<void(const std::vector<std::string>& values, std::uint64_t line)> take;
};

/// Reads tables of a CIF file row by row. Other tables are skipped without being stored.
///
/// `begin_block`  called at the beginning of each data block
/// Errors     base::Error(kBadData): syntax errors, incomplete rows; those of `take`
void read_cif(const std::string& text, std::vector<CifTable> tables, Faults& faults,
              const std::function<void()>& begin_block);

}  // namespace orrery::data
