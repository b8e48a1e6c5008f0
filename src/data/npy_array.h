// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/records.h"

namespace orrery::data {

/// A field of a structured array, or the items of a plain one.
struct NpyField {
  enum class Kind { kNumber, kBytes, kUtf32 };

  std::string name;  ///< empty for a plain array
  Kind kind = Kind::kNumber;
  NumberType type = NumberType::kFloat64;  ///< type of a kNumber
  std::uint64_t size = 0;                  ///< size of a component, bytes
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

/// A column of an array: a field, or one component of it.
struct NpyColumn {
  std::string name;
  NpyField field;
  std::uint64_t begin = 0;   ///< offset of the first record that contains it
  std::uint64_t offset = 0;  ///< offset in the record
  std::uint64_t stride = 0;  ///< size of a record

  ColumnType type() const {
    return field.kind == NpyField::Kind::kNumber ? column_type(field.type) : ColumnType::kText;
  }
};

/// Returns the columns of an array whose first dimension counts the rows: the fields of a structured array, else the
/// columns of the second dimension.
///
/// `name`     name of a plain array
/// `so_far`   columns of the file so far; the new ones are appended
/// Domain     one dimension, or two for a plain array
std::vector<NpyColumn> npy_columns(const NpyHeader& header, const std::string& name, std::vector<ColumnInfo>& so_far);

/// Returns the size of an array's data, bytes; the maximum integer if it is larger than any file, or if the header
/// declares items of size zero.
std::uint64_t npy_data_bytes(const NpyHeader& header);

/// Returns the shape for messages: "(100, 3)", "(100,)".
std::string shape_text(const NpyHeader& header);

/// Reads columns.
///
/// Domain     `bytes` contains npy_data_bytes() from header.begin
/// Errors     numbers that are too large, and invalid characters, are added to `faults`
std::vector<Column> read_npy_columns(const ByteSource& bytes, std::uint64_t rows, const std::vector<NpyColumn>& columns,
                                     Faults& faults);

}  // namespace orrery::data
