// SPDX-License-Identifier: Apache-2.0
#include "arrays/npy_columns.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "data/byte_source.h"

#include "data/customary.h"
#include "data/dictionary.h"
#include "data/faults.h"
#include "data/records.h"

namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// Appends a character in UTF-8; false if the code point is invalid.
bool append_utf8(std::string& out, std::uint32_t c) {
  const auto add = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (c < 0x80) {
    add(c);
  } else if (c < 0x800) {
    add(0xC0 | c >> 6);
    add(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    if (c >= 0xD800 && c < 0xE000) return false;  // half of a surrogate pair
    add(0xE0 | c >> 12);
    add(0x80 | (c >> 6 & 0x3F));
    add(0x80 | (c & 0x3F));
  } else if (c < 0x110000) {
    add(0xF0 | c >> 18);
    add(0x80 | (c >> 12 & 0x3F));
    add(0x80 | (c >> 6 & 0x3F));
    add(0x80 | (c & 0x3F));
  } else {
    return false;
  }
  return true;
}

/// Decodes a zero-padded string; false if a character is invalid.
bool decode_text(const NpyField& field, const char* from, std::string& out) {
  out.clear();
  if (field.kind == NpyField::Kind::kBytes) {
    out.assign(from, field.size);
    out.erase(out.find_last_not_of('\0') + 1);
    return true;
  }
  const auto at = [&](std::size_t i) { return load<std::uint32_t>(from + 4 * i, field.is_big_endian); };
  std::size_t length = static_cast<std::size_t>(field.size / 4);
  while (length > 0 && at(length - 1) == 0) --length;
  for (std::size_t i = 0; i < length; ++i)
    if (!append_utf8(out, at(i))) return false;
  return true;
}

Values read_texts(const ByteSource& bytes, std::uint64_t rows, const NpyColumn& column, Faults& faults) {
  constexpr std::uint64_t kBlockBytes = std::uint64_t{1} << 20;
  const std::uint64_t stride = column.stride;
  const std::uint64_t block_rows = std::max<std::uint64_t>(1, stride > 0 ? kBlockBytes / stride : kBlockBytes);
  Dictionary words;
  Words out;
  std::string word;
  for (std::uint64_t first = 0; first < rows; first += block_rows) {
    const std::uint64_t count = std::min(block_rows, rows - first);
    const std::string block = bytes.text(column.begin + first * stride, static_cast<std::size_t>(count * stride));
    for (std::uint64_t i = 0; i < count; ++i) {
      if (!decode_text(column.field, block.data() + i * stride + column.offset, word))
        faults.add_of_many(0, fmt::format("row {}: `{}` has an invalid character", first + i + 1, column.name));
      out.index.push_back(words.index_of(word));
    }
  }
  out.words = words.take();
  return out;
}

bool has_record_of(const NpyColumn& a, const NpyColumn& b) { return a.begin == b.begin && a.stride == b.stride; }

}  // namespace

std::vector<NpyColumn> npy_columns(const NpyHeader& header, const std::string& name, std::vector<ColumnInfo>& so_far) {
  std::vector<NpyColumn> out;
  const auto add = [&](const NpyField& field, const std::string& column, std::uint64_t begin, std::uint64_t offset,
                       std::uint64_t stride) {
    out.push_back({column, field, begin, offset, stride});
    so_far.push_back({column, out.back().type()});
  };
  for (const NpyField& field : header.fields) {
    const std::uint64_t width = header.shape.size() == 2 ? header.shape[1] : field.components;
    const std::vector<std::string> names =
        component_names(header.is_structured ? field.name : name, static_cast<std::size_t>(width), so_far);
    for (std::uint64_t i = 0; i < width; ++i) {
      const std::string& column = names[static_cast<std::size_t>(i)];
      if (header.is_structured) {
        add(field, column, header.begin, field.offset + i * field.size, header.item_size);
      } else if (header.is_fortran_order) {
        add(field, column, header.begin + i * header.rows() * field.size, 0, field.size);
      } else {
        add(field, column, header.begin, i * field.size, width * field.size);
      }
    }
  }
  return out;
}

std::uint64_t npy_data_bytes(const NpyHeader& header) {
  // Any number of zero-size items would fit into any file.
  std::uint64_t bytes = header.item_size > 0 ? header.item_size : std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t length : header.shape) {
    if (length == 0) return 0;
    if (bytes > std::numeric_limits<std::uint64_t>::max() / length) return std::numeric_limits<std::uint64_t>::max();
    bytes *= length;
  }
  return bytes;
}

std::string shape_text(const NpyHeader& header) {
  std::string out;
  for (const std::uint64_t length : header.shape) out += (out.empty() ? "" : ", ") + std::to_string(length);
  return fmt::format("({}{}", out, header.shape.size() == 1 ? ",)" : ")");
}

std::vector<Column> read_npy_columns(const ByteSource& bytes, std::uint64_t rows, const std::vector<NpyColumn>& columns,
                                     Faults& faults) {
  std::vector<Column> out(columns.size());
  std::vector<bool> is_read(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (is_read[c]) continue;
    out[c].name = columns[c].name;
    if (columns[c].type() == ColumnType::kText) {
      out[c].values = read_texts(bytes, rows, columns[c], faults);
      continue;
    }
    // All columns of the same records are read in one pass.
    std::vector<RecordField> fields;
    std::vector<std::size_t> targets;
    for (std::size_t k = c; k < columns.size(); ++k) {
      if (columns[k].type() == ColumnType::kText || !has_record_of(columns[k], columns[c])) continue;
      fields.push_back({columns[k].name, columns[k].field.type, columns[k].offset, columns[k].field.is_big_endian});
      targets.push_back(k);
      is_read[k] = true;
    }
    std::vector<Values> values = read_records(bytes, {columns[c].begin, columns[c].stride, rows}, fields, faults);
    for (std::size_t k = 0; k < targets.size(); ++k) out[targets[k]] = {fields[k].name, std::move(values[k])};
  }
  return out;
}

}  // namespace orrery::arrays
