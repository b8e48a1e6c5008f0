// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arrays/npy_header.h"
#include "data/forward.h"
#include "data/table.h"

namespace orrery::arrays {

/// A column of an array: a field, or one component of it.
struct NpyColumn {
  std::string name;
  NpyField field;
  std::uint64_t begin = 0;   ///< offset of the first record that contains it
  std::uint64_t offset = 0;  ///< offset in the record
  std::uint64_t stride = 0;  ///< size of a record

  data::ColumnType type() const {
    return field.kind == NpyField::Kind::kNumber ? data::column_type(field.type) : data::ColumnType::kText;
  }
};

/// Returns the columns of an array whose first dimension counts the rows: the fields of a structured array, else the
/// columns of the second dimension.
///
/// `name`     name of a plain array
/// `so_far`   columns of the file so far; the new ones are appended
/// Domain     one dimension, or two for a plain array
std::vector<NpyColumn> npy_columns(const NpyHeader& header, const std::string& name,
                                   std::vector<data::ColumnInfo>& so_far);

/// Returns the size of an array's data, bytes; the maximum integer if it is larger than any file, or if the header
/// declares items of size zero.
std::uint64_t npy_data_bytes(const NpyHeader& header);

/// Returns the shape for messages: "(100, 3)", "(100,)".
std::string shape_text(const NpyHeader& header);

/// Reads columns.
///
/// Domain     `bytes` contains npy_data_bytes() from header.begin
/// Errors     numbers that are too large, and invalid characters, are added to `faults`
std::vector<data::Column> read_npy_columns(const data::ByteSource& bytes, std::uint64_t rows,
                                           const std::vector<NpyColumn>& columns, data::Faults& faults);

}  // namespace orrery::arrays
