// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/number_type.h"

namespace orrery::arrays {

/// A field of a structured array, or the items of a plain one.
struct NpyField {
  enum class Kind { kNumber, kBytes, kUtf32 };

  std::string name;  ///< empty for a plain array
  Kind kind = Kind::kNumber;
  data::NumberType type = data::NumberType::kFloat64;  ///< type of a kNumber
  std::uint64_t size = 0;                              ///< size of a component, bytes
  std::uint64_t components = 1;
  std::uint64_t offset = 0;  ///< offset in the item, bytes
  bool is_big_endian = false;
};

/// The header of an array in NumPy's format.
struct NpyHeader {
  std::vector<NpyField> fields;
  bool is_structured = false;
  bool is_fortran_order = false;
  std::vector<std::uint64_t> shape;
  std::uint64_t item_size = 0;  ///< bytes
  std::uint64_t begin = 0;      ///< offset of the data

  std::uint64_t rows() const { return shape.empty() ? 0 : shape[0]; }
};

/// Maximum length of a header, bytes. NumPy itself refuses to read more than 10,000.
inline constexpr std::uint64_t kLongestNpyHeader = std::uint64_t{1} << 20;

/// Maximum length of a string, bytes or characters; a header that declares more is damaged.
inline constexpr std::uint64_t kLongestNpyText = std::uint64_t{1} << 16;

/// Returns whether bytes begin with NumPy's signature.
bool has_npy_signature(std::string_view head);

/// Returns the offset of the data, according to the first 12 bytes; at most kLongestNpyHeader + 12 unless it is wrong.
///
/// Domain     has_npy_signature(head)
/// Result     0 if `head` is too short
std::uint64_t npy_header_end(std::string_view head);

/// Parses a header of version 1, 2 or 3. Items are numbers, strings, or records of these and of arrays of these.
///
/// `head`     the file up to npy_header_end(), or all of it
/// Result     an empty string, or what is wrong and what to do
/// Reference  npy-format
std::string parse_npy_header(std::string_view head, NpyHeader& header);

}  // namespace orrery::arrays
