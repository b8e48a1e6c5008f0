// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data/byte_source.h"
#include "data/faults.h"
#include "data/number_type.h"
#include "data/table.h"

namespace orrery::data {

/// A number in each record of a binary file.
struct RecordField {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::uint64_t offset = 0;  ///< from the start of the record, bytes
  bool is_big_endian = false;
};

/// Records of equal size, one after another.
struct RecordLayout {
  std::uint64_t begin = 0;   ///< offset of the first record
  std::uint64_t stride = 0;  ///< size of a record, bytes
  std::uint64_t rows = 0;
};

/// Adds an error for each unsigned integer that exceeded int64 and has therefore become negative.
void check_unsigned(const std::string& column, const std::vector<std::int64_t>& values, Faults& faults);

/// Returns whether a file of `size` bytes contains all records.
bool contains(std::uint64_t size, const RecordLayout& layout);

/// Reads fields of all records, in parallel.
///
/// Domain     contains(bytes.size(), layout); each field is inside the record
/// Result     one column per field, of type column_type(field.type)
/// Errors     unsigned integers that an int64 cannot represent are added to `faults`
/// Cost       one pass over the records; 1 MiB per thread in addition to the columns
std::vector<Values> read_records(const ByteSource& bytes, const RecordLayout& layout,
                                 const std::vector<RecordField>& fields, Faults& faults);

}  // namespace orrery::data
