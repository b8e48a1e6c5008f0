// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "support/data_tables.h"

namespace orrery::support {

/// Bytes of numbers in a file.
template <class T>
std::string sequence(std::initializer_list<T> values, bool is_big_endian = false) {
  std::string out;
  for (const T v : values) out += number_bytes(v, is_big_endian);
  return out;
}

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
