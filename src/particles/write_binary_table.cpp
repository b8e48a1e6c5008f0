// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "arrays/npy_header.h"
#include "data/byte_source.h"
#include "data/quoted_word.h"
#include "particles/table_output.h"

namespace orrery::particles {

using namespace arrays;  // NOLINT(google-build-using-namespace)
using namespace data;    // NOLINT(google-build-using-namespace)

namespace {

template <class T>
void append_little_endian(std::string& out, T value) {
  char bytes[sizeof(T)];
  store(value, bytes, false);
  out.append(bytes, sizeof(T));
}

const Words* words_in(const Column& column) { return std::get_if<Words>(&column.values); }

/// Appends the numbers of a row of a column in the column's type; `append_text(words, row)` appends a string.
template <class AppendText>
void append_bytes(std::string& out, const Column& column, std::size_t row, AppendText append_text) {
  std::visit(
      [&](const auto& values) {
        if constexpr (requires { values.index; }) {
          append_text(values, row);
        } else {
          append_little_endian(out, values[row]);
        }
      },
      column.values);
}

/// PLY types; there are no 64-bit integers.
enum class PlyOutput { kSame, kInt32, kUint32, kFloat64, kNone };

PlyOutput ply_output(const base::OutputFile& out, const Column& column) {
  if (words_in(column) != nullptr) return PlyOutput::kNone;
  const auto* const integers = std::get_if<std::vector<std::int64_t>>(&column.values);
  if (integers == nullptr) return PlyOutput::kSame;
  if (integers->empty()) return PlyOutput::kInt32;
  const auto [least, most] = std::minmax_element(integers->begin(), integers->end());
  constexpr std::int64_t kExact = std::int64_t{1} << 53;  // the largest range of integers that float64 represents
  using Int = std::numeric_limits<std::int32_t>;
  if (*least >= Int::min() && *most <= Int::max()) return PlyOutput::kInt32;
  if (*least >= 0 && *most <= std::numeric_limits<std::uint32_t>::max()) return PlyOutput::kUint32;
  if (*least >= -kExact && *most <= kExact) return PlyOutput::kFloat64;
  refuse_to_write(
      out.path(),
      fmt::format("PLY has no integer type that is large enough for column {}; write .npy, or leave the column out",
                  quoted_word(column.name)));
}

const char* ply_type(PlyOutput output, ColumnType type) {
  if (output == PlyOutput::kInt32) return "int";
  if (output == PlyOutput::kUint32) return "uint";
  if (output == PlyOutput::kFloat64) return "double";
  switch (type) {
    case ColumnType::kFloat32: return "float";
    case ColumnType::kInt32: return "int";
    case ColumnType::kUint16: return "ushort";
    case ColumnType::kUint8: return "uchar";
    case ColumnType::kFloat64:
    case ColumnType::kInt64:
    case ColumnType::kText: break;
  }
  return "double";
}

/// Returns the name of a property: without spaces, and different from the previous ones.
std::string ply_name(std::string name, std::set<std::string>& used) {
  if (name.empty()) name = "_";
  for (char& c : name)
    if (c == ' ' || (c >= '\t' && c <= '\r')) c = '_';
  while (!used.insert(name).second) name += '_';
  return name;
}

/// The type of a text column in NumPy: Unicode, or bytes if a string is not ASCII.
struct NpyText {
  std::size_t length = 1;  ///< characters or bytes
  bool is_ascii = true;
};

NpyText npy_text(const base::OutputFile& out, const Column& column) {
  NpyText text;
  for (const std::string& word : words_in(column)->words) {
    text.length = std::max(text.length, word.size());
    text.is_ascii = text.is_ascii && std::all_of(word.begin(), word.end(), [](char c) { return c > 0; });
    if (word.size() > kLongestNpyText || word.ends_with('\0'))
      refuse_to_write(
          out.path(),
          fmt::format("column {} has a string that is too long or ends in a zero byte; leave the column out",
                      quoted_word(column.name)));
  }
  return text;
}

std::string npy_type(const base::OutputFile& out, const Column& column) {
  switch (column.type()) {
    case ColumnType::kFloat64: break;
    case ColumnType::kFloat32: return "<f4";
    case ColumnType::kInt64: return "<i8";
    case ColumnType::kInt32: return "<i4";
    case ColumnType::kUint16: return "<u2";
    case ColumnType::kUint8: return "|u1";
    case ColumnType::kText: {
      const NpyText text = npy_text(out, column);
      return (text.is_ascii ? "<U" : "|S") + std::to_string(text.length);
    }
  }
  return "<f8";
}

/// Quotes a string in Python's syntax.
std::string python_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

std::string npy_header(const base::OutputFile& out, const Table& table) {
  std::string literal = "{'descr': [";
  for (const Column& column : table.columns)
    literal += fmt::format("({}, '{}'), ", python_text(column.name), npy_type(out, column));
  literal += fmt::format("], 'fortran_order': False, 'shape': ({},), }}", table.rows);
  const bool is_ascii = std::all_of(literal.begin(), literal.end(), [](char c) { return c > 0; });
  constexpr std::size_t kAlignment = 64;  // of the data, with signature, version and length in front of the header
  const bool is_short = literal.size() + kAlignment <= std::numeric_limits<std::uint16_t>::max();
  const char version = !is_ascii ? 3 : is_short ? 1 : 2;
  const std::size_t before = version == 1 ? 10 : 12;
  literal.append(kAlignment - 1 - (before + literal.size()) % kAlignment, ' ');
  literal += '\n';
  std::string header = "\x93NUMPY";
  header += version;
  header += '\0';
  if (version == 1) {
    append_little_endian(header, static_cast<std::uint16_t>(literal.size()));
  } else {
    append_little_endian(header, static_cast<std::uint32_t>(literal.size()));
  }
  return header + literal;
}

}  // namespace

std::vector<std::string> write_ply_table(base::OutputFile& out, const Table& table, const std::string& writer) {
  std::vector<std::string> left_out;
  std::vector<PlyOutput> outputs;
  std::set<std::string> used;
  std::string& bytes = out.buffer();
  bytes = fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment made by {}\n"
      "element vertex {}\n",
      writer, table.rows);
  for (const Column& column : table.columns) {
    outputs.push_back(ply_output(out, column));
    if (outputs.back() == PlyOutput::kNone) {
      left_out.push_back(column.name);
    } else {
      bytes += fmt::format("property {} {}\n", ply_type(outputs.back(), column.type()), ply_name(column.name, used));
    }
  }
  bytes += "end_header\n";
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto integer = [&] { return std::get<std::vector<std::int64_t>>(table.columns[c].values)[row]; };
      switch (outputs[c]) {
        case PlyOutput::kSame: append_bytes(bytes, table.columns[c], row, [](const Words&, std::size_t) {}); break;
        case PlyOutput::kInt32: append_little_endian(bytes, static_cast<std::int32_t>(integer())); break;
        case PlyOutput::kUint32: append_little_endian(bytes, static_cast<std::uint32_t>(integer())); break;
        case PlyOutput::kFloat64: append_little_endian(bytes, static_cast<double>(integer())); break;
        case PlyOutput::kNone: break;
      }
    }
    out.flush();
  }
  return left_out;
}

void write_npy_table(base::OutputFile& out, const Table& table) {
  std::string& bytes = out.buffer();
  bytes = npy_header(out, table);
  std::vector<NpyText> texts;
  for (const Column& column : table.columns)
    texts.push_back(words_in(column) != nullptr ? npy_text(out, column) : NpyText());
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      append_bytes(bytes, table.columns[c], row, [&](const Words& words, std::size_t r) {
        const std::string& word = words.words[words.index[r]];
        const std::size_t padding = texts[c].length - word.size();
        if (texts[c].is_ascii) {
          for (const char character : word) append_little_endian(bytes, static_cast<std::uint32_t>(character));
          bytes.append(4 * padding, '\0');
        } else {
          bytes += word;
          bytes.append(padding, '\0');
        }
      });
    out.flush();
  }
}

}  // namespace orrery::particles
