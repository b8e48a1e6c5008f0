// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "support/data_tables.h"

namespace orrery::support {

/// An array in NumPy's format.
///
/// `description`  of the items, in Python's syntax: "'<f4'"
/// `shape`        "(10, 3)"
inline std::string npy_bytes(const std::string& description, bool is_fortran_order, const std::string& shape,
                             const std::string& data, int version = 1) {
  const std::string header = "{'descr': " + description +
                             ", 'fortran_order': " + (is_fortran_order ? "True" : "False") + ", 'shape': " + shape +
                             ", }\n";
  std::string out = "\x93NUMPY";
  out += static_cast<char>(version);
  out += '\0';
  out += version == 1 ? number_bytes(static_cast<std::uint16_t>(header.size()))
                      : number_bytes(static_cast<std::uint32_t>(header.size()));
  return out + header + data;
}

}  // namespace orrery::support
