// SPDX-License-Identifier: Apache-2.0
#include "data/records.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <type_traits>
#include <variant>

#include <fmt/core.h>

#include "base/stop_point.h"

namespace orrery::data {

namespace {

/// Bytes read at a time: large enough for the system call, small enough for the second-level cache.
constexpr std::uint64_t kRecordBlockBytes = std::uint64_t{1} << 20;

/// The element type of the column that stores numbers of type T; column_type() as a type.
template <class T>
using Stored = std::conditional_t<
    std::is_same_v<T, std::int8_t> || std::is_same_v<T, std::int16_t>, std::int32_t,
    std::conditional_t<std::is_same_v<T, std::uint32_t> || std::is_same_v<T, std::uint64_t>, std::int64_t, T>>;

template <class T, bool big_endian>
void decode(const char* from, std::size_t stride, std::size_t rows, Stored<T>* out) {
  for (std::size_t i = 0; i < rows; ++i) out[i] = static_cast<Stored<T>>(load<T>(from + i * stride, big_endian));
}

void decode_field(const RecordField& field, const char* records, std::size_t stride, std::size_t rows, Values& out,
                  std::size_t first) {
  with_type(field.type, [&](auto number) {
    using T = decltype(number);
    Stored<T>* const to = std::get<std::vector<Stored<T>>>(out).data() + first;
    if (field.is_big_endian) {
      decode<T, true>(records + field.offset, stride, rows, to);
    } else {
      decode<T, false>(records + field.offset, stride, rows, to);
    }
  });
}

}  // namespace

void check_unsigned(const std::string& column, const std::vector<std::int64_t>& values, Faults& faults) {
  for (std::size_t row = 0; row < values.size(); ++row)
    if (values[row] < 0)
      faults.add_of_many(0, fmt::format("row {}: `{}` is {}, larger than the largest int64", row + 1, column,
                                        static_cast<std::uint64_t>(values[row])));
}

bool contains(std::uint64_t size, const RecordLayout& layout) {
  return layout.begin <= size && (layout.stride == 0 || layout.rows <= (size - layout.begin) / layout.stride);
}

std::vector<Column> read_records(const ByteSource& bytes, const RecordLayout& layout,
                                 const std::vector<RecordField>& fields, Faults& faults) {
  const auto rows = static_cast<std::size_t>(layout.rows);
  const auto stride = static_cast<std::size_t>(layout.stride);
  std::vector<Column> out;
  for (const RecordField& field : fields)
    with_type(field.type, [&](auto number) {
      out.push_back({field.name, std::vector<Stored<decltype(number)>>(rows)});
    });
  if (rows == 0 || fields.empty()) return out;
  const std::size_t block_rows = std::max<std::size_t>(1, kRecordBlockBytes / stride);
  const base::StopPoint stop;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (rows - 1) / block_rows + 1),
                    [&](const tbb::blocked_range<std::size_t>& blocks) {
                      std::vector<char> block;
                      for (std::size_t b = blocks.begin(); b < blocks.end(); ++b) {
                        stop.check();
                        const std::size_t first = b * block_rows, count = std::min(block_rows, rows - first);
                        block.resize(count * stride);
                        bytes.read(layout.begin + first * layout.stride, block.size(), block.data());
                        for (std::size_t f = 0; f < fields.size(); ++f)
                          decode_field(fields[f], block.data(), stride, count, out[f].values, first);
                      }
                    });
  for (std::size_t f = 0; f < fields.size(); ++f)
    if (fields[f].type == NumberType::kUint64)
      check_unsigned(fields[f].name, std::get<std::vector<std::int64_t>>(out[f].values), faults);
  return out;
}

}  // namespace orrery::data
