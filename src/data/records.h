// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/byte_source.h"
#include "data/faults.h"
#include "data/table.h"

namespace orrery::data {

/// The types of numbers in binary files.
enum class NumberType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

/// Calls `visit(T{})` with the C++ type of a number type.
template <class Visit>
constexpr auto with_type(NumberType type, Visit visit) {
  switch (type) {
    case NumberType::kInt8: return visit(std::int8_t{});
    case NumberType::kUint8: return visit(std::uint8_t{});
    case NumberType::kInt16: return visit(std::int16_t{});
    case NumberType::kUint16: return visit(std::uint16_t{});
    case NumberType::kInt32: return visit(std::int32_t{});
    case NumberType::kUint32: return visit(std::uint32_t{});
    case NumberType::kInt64: return visit(std::int64_t{});
    case NumberType::kUint64: return visit(std::uint64_t{});
    case NumberType::kFloat32: return visit(float{});
    case NumberType::kFloat64: break;
  }
  return visit(double{});
}

/// Returns the size of a number, bytes.
constexpr std::size_t size_of(NumberType type) {
  return with_type(type, [](auto number) { return sizeof(number); });
}

/// Returns the column type that stores such numbers: the same type, or the next larger one that represents all of them.
/// Unsigned 64-bit integers become int64.
constexpr ColumnType column_type(NumberType type) {
  constexpr ColumnType kTypes[] = {ColumnType::kInt32,   ColumnType::kUint8,  ColumnType::kInt32, ColumnType::kUint16,
                                   ColumnType::kInt32,   ColumnType::kInt64,  ColumnType::kInt64, ColumnType::kInt64,
                                   ColumnType::kFloat32, ColumnType::kFloat64};
  return kTypes[static_cast<std::size_t>(type)];
}

/// A file format's name of a number type.
struct NumberTypeName {
  std::string_view name;
  NumberType type;
};

/// Returns the number type with a name; none if no type has it.
template <std::size_t count>
constexpr std::optional<NumberType> number_type(const NumberTypeName (&names)[count], std::string_view name) {
  for (const NumberTypeName& known : names)
    if (known.name == name) return known.type;
  return {};
}

/// Loads a number of either byte order.
template <class T>
T load(const char* from, bool is_big_endian) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (is_big_endian != (std::endian::native == std::endian::big)) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Appends the bytes of a number, the least significant one first.
template <class T>
void append_little_endian(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof(T));
  out.append(bytes, sizeof(T));
}

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
/// Result     one column per field, with its name and of type column_type(field.type)
/// Errors     unsigned integers that an int64 cannot represent are added to `faults`
/// Cost       one pass over the records; 1 MiB per thread in addition to the columns
std::vector<Column> read_records(const ByteSource& bytes, const RecordLayout& layout,
                                 const std::vector<RecordField>& fields, Faults& faults);

}  // namespace orrery::data
