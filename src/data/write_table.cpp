// SPDX-License-Identifier: Apache-2.0
#include "data/write_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "data/npy_array.h"

namespace orrery::data {

namespace {

/// Throws base::Error(kUsage): "cannot write FILE: TEXT".
[[noreturn]] void refuse_to_write(const std::filesystem::path& file, const std::string& text) {
  base::refuse(fmt::format("cannot write {}: {}", file.string(), text));
}

const Words* words_in(const Column& column) { return std::get_if<Words>(&column.values); }

/// Calls `on_number(number)` or `on_text(string)` with the value of a row.
template <class OnNumber, class OnText>
void visit_value(const Column& column, std::size_t row, OnNumber on_number, OnText on_text) {
  std::visit(
      [&](const auto& values) {
        if constexpr (requires { values.index; }) {
          on_text(values.words[values.index[row]]);
        } else {
          on_number(values[row]);
        }
      },
      column.values);
}

/// PLY types; there are no 64-bit integers.
enum class PlyOutput { kSame, kInt32, kUint32, kFloat64, kNone };

PlyOutput ply_output(const Column& column) {
  if (words_in(column) != nullptr) return PlyOutput::kNone;
  const auto* const integers = std::get_if<std::vector<std::int64_t>>(&column.values);
  if (integers == nullptr) return PlyOutput::kSame;
  if (integers->empty()) return PlyOutput::kInt32;
  const auto [least, most] = std::minmax_element(integers->begin(), integers->end());
  constexpr std::int64_t kExact = std::int64_t{1} << 53;  // the largest range of integers that float64 represents
  using Int = std::numeric_limits<std::int32_t>;
  if (*least >= Int::min() && *most <= Int::max()) return PlyOutput::kInt32;
  if (*least >= 0 && *most <= std::numeric_limits<std::uint32_t>::max()) return PlyOutput::kUint32;
  return *least >= -kExact && *most <= kExact ? PlyOutput::kFloat64 : PlyOutput::kNone;
}

const char* ply_type(PlyOutput output, ColumnType type) {
  if (output == PlyOutput::kInt32) return "int";
  if (output == PlyOutput::kUint32) return "uint";
  if (output == PlyOutput::kFloat64) return "double";
  constexpr const char* kNames[] = {"double", "float", "double", "int", "ushort", "uchar", "double"};
  return kNames[static_cast<std::size_t>(type)];
}

/// Names for the columns of a file in which some characters cannot be in names. Other names stay.
class DistinctNames {
 public:
  /// `replaced`  these characters become underscores
  /// `used`      names that columns cannot have
  DistinctNames(const Table& table, std::string_view replaced, std::set<std::string> used = {})
      : replaced_(replaced), used_(std::move(used)) {
    for (const Column& column : table.columns)
      if (is_possible(column.name) && used_.insert(column.name).second) kept_.insert(column.name);
  }

  std::string of(std::string name) {
    if (kept_.erase(name) > 0) return name;
    if (name.empty()) name = "_";
    std::replace_if(
        name.begin(), name.end(), [&](char c) { return replaced_.find(c) != std::string_view::npos; }, '_');
    while (!used_.insert(name).second) name += '_';
    return name;
  }

 private:
  bool is_possible(const std::string& name) const {
    return !name.empty() && name.find_first_of(replaced_) == std::string::npos;
  }

  std::string_view replaced_;
  std::set<std::string> used_, kept_;
};

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
  constexpr const char* kNames[] = {"<f8", "<f4", "<i8", "<i4", "<u2", "|u1"};
  if (column.type() != ColumnType::kText) return kNames[static_cast<std::size_t>(column.type())];
  const NpyText text = npy_text(out, column);
  return (text.is_ascii ? "<U" : "|S") + std::to_string(text.length);
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
  if (version == 1)
    append_little_endian(header, static_cast<std::uint16_t>(literal.size()));
  else
    append_little_endian(header, static_cast<std::uint32_t>(literal.size()));
  return header + literal;
}

/// Appends the shortest digits that read back to the same number.
template <class T>
void append_number(std::string& out, T value) {
  constexpr std::size_t kLongestNumber = 32;
  char text[kLongestNumber];
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(value)) {
      out += "nan";
      return;
    }
    // A float32 is read back as float64, so the shortest digits of the float32 would give a different number.
    out.append(text, std::to_chars(text, text + kLongestNumber, static_cast<double>(value)).ptr);
  } else {
    out.append(text, std::to_chars(text, text + kLongestNumber, +value).ptr);
  }
}

void append_quoted(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

bool has_line_end(const std::string& text) { return text.find_first_of("\n\r") != std::string::npos; }

/// Returns whether XYZ, in which spaces separate values, can store the values of a column.
bool is_storable_in_xyz(const Column& column) {
  const Words* const words = words_in(column);
  return words == nullptr || std::all_of(words->words.begin(), words->words.end(), [](const std::string& word) {
           return !word.empty() && word.find_first_of(" \t\r\n\"") == std::string::npos;
         });
}

/// Characters that separate names and values in the header of PLY, and in extended XYZ.
constexpr std::string_view kPlySeparators = " \t\n\v\f\r";
constexpr std::string_view kXyzSeparators = " \t\r\n:=\"'{}[]\\,";

/// A property of extended XYZ: one or more columns.
struct XyzOutput {
  std::string name;
  std::vector<const Column*> columns;
  char type = 'R';
  bool is_color = false;  ///< 8-bit colours, written as 0 to 1
};

char xyz_type(const Column& column) {
  const ColumnType type = column.type();
  if (type == ColumnType::kText) return 'S';
  return type == ColumnType::kFloat64 || type == ColumnType::kFloat32 ? 'R' : 'I';
}

/// Returns the columns from `first` on that are the components of one property, name[1], name[2] ..; else the first.
XyzOutput property_at(const Table& table, std::size_t first) {
  const Column& column = table.columns[first];
  XyzOutput out{column.name, {&column}, xyz_type(column)};
  if (!column.name.ends_with("[1]")) return out;
  const std::string name = column.name.substr(0, column.name.size() - 3);
  for (std::size_t i = first + 1; i < table.columns.size(); ++i) {
    const Column& next = table.columns[i];
    if (next.name != fmt::format("{}[{}]", name, i - first + 1) || xyz_type(next) != out.type ||
        !is_storable_in_xyz(next))
      break;
    out.columns.push_back(&next);
  }
  if (out.columns.size() > 1) out.name = name;
  return out;
}

/// Returns the 8-bit colours at a column, as the property `color`, which other programs understand; empty if it is
/// another column.
std::optional<XyzOutput> color_at(const Table& table, std::size_t first) {
  XyzOutput out{"color", {}, 'R', true};
  for (const char* name : {"red", "green", "blue"}) {
    const std::size_t at = first + out.columns.size();
    if (at >= table.columns.size() || table.columns[at].name != name || table.columns[at].type() != ColumnType::kUint8)
      return {};
    out.columns.push_back(&table.columns[at]);
  }
  return out;
}

/// Returns the column of chemical elements; null if there is none that XYZ can store.
const Column* element_of(const Table& table) {
  for (const char* name : {"element", "species", "symbol"})
    if (const Column* const column = table.find(name);
        column != nullptr && column->type() == ColumnType::kText && is_storable_in_xyz(*column))
      return column;
  return nullptr;
}

/// Returns the properties: species, pos, then the other columns in their order. Adds the names of columns that XYZ
/// cannot store to `left_out`.
std::vector<XyzOutput> xyz_outputs(const Table& table, std::vector<std::string>& left_out) {
  std::vector<XyzOutput> out;
  const Column* const element = element_of(table);
  if (element != nullptr) out.push_back({"species", {element}, 'S'});
  out.push_back({"pos", {table.find("x"), table.find("y"), table.find("z")}, 'R'});
  DistinctNames names(table, kXyzSeparators, {"species", "pos"});
  for (std::size_t i = 0; i < table.columns.size();) {
    const std::string& name = table.columns[i].name;
    if (name == "x" || name == "y" || name == "z" || &table.columns[i] == element) {
      ++i;
      continue;
    }
    if (!is_storable_in_xyz(table.columns[i])) {
      left_out.push_back(name);
      ++i;
      continue;
    }
    const std::optional<XyzOutput> color = color_at(table, i);
    XyzOutput property = color ? *color : property_at(table, i);
    i += property.columns.size();
    property.name = names.of(property.name);
    out.push_back(std::move(property));
  }
  return out;
}

/// Appends a box as the reader of extended XYZ takes it.
void append_box(std::string& out, const Box& box) {
  const auto append = [&](std::initializer_list<Vec3d> vectors) {
    for (const Vec3d v : vectors)
      for (const double x : {v.x, v.y, v.z}) {
        append_number(out, x);
        out += ' ';
      }
    out.back() = '"';
  };
  out += "Lattice=\"";
  append({box.edges[0], box.edges[1], box.edges[2]});
  out += " Origin=\"";
  append({box.origin});
  out += " pbc=\"";
  for (const bool is_periodic : box.periodic) out += is_periodic ? "T " : "F ";
  out.back() = '"';
  out += ' ';
}

// Functions that write a format, and return the names of the columns that they omit.

std::vector<std::string> write_ply_table(base::OutputFile& out, const Table& table, const FrameHeader&,
                                         const std::string& writer) {
  std::vector<std::string> left_out;
  std::vector<PlyOutput> outputs;
  DistinctNames names(table, kPlySeparators);
  std::string& bytes = out.buffer();
  bytes = fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment made by {}\n"
      "element vertex {}\n",
      writer, table.rows);
  for (const Column& column : table.columns) {
    outputs.push_back(ply_output(column));
    if (outputs.back() == PlyOutput::kNone) {
      left_out.push_back(column.name);
    } else {
      bytes += fmt::format("property {} {}\n", ply_type(outputs.back(), column.type()), names.of(column.name));
    }
  }
  bytes += "end_header\n";
  const auto append = [&](auto number) { append_little_endian(bytes, number); };
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto integer = [&] { return std::get<std::vector<std::int64_t>>(table.columns[c].values)[row]; };
      switch (outputs[c]) {
        case PlyOutput::kSame: visit_value(table.columns[c], row, append, [](const std::string&) {}); break;
        case PlyOutput::kInt32: append(static_cast<std::int32_t>(integer())); break;
        case PlyOutput::kUint32: append(static_cast<std::uint32_t>(integer())); break;
        case PlyOutput::kFloat64: append(static_cast<double>(integer())); break;
        case PlyOutput::kNone: break;
      }
    }
    out.flush();
  }
  return left_out;
}

std::vector<std::string> write_npy_table(base::OutputFile& out, const Table& table, const FrameHeader&,
                                         const std::string&) {
  std::string& bytes = out.buffer();
  bytes = npy_header(out, table);
  std::vector<NpyText> texts;
  for (const Column& column : table.columns)
    texts.push_back(words_in(column) != nullptr ? npy_text(out, column) : NpyText());
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto append_text = [&](const std::string& word) {
        const std::size_t padding = texts[c].length - word.size();
        if (texts[c].is_ascii) {
          for (const char character : word) append_little_endian(bytes, static_cast<std::uint32_t>(character));
          bytes.append(4 * padding, '\0');
        } else {
          bytes += word;
          bytes.append(padding, '\0');
        }
      };
      visit_value(
          table.columns[c], row, [&](auto number) { append_little_endian(bytes, number); }, append_text);
    }
    out.flush();
  }
  return {};
}

std::vector<std::string> write_csv_table(base::OutputFile& out, const Table& table, const FrameHeader&,
                                         const std::string&) {
  std::string& text = out.buffer();
  for (const Column& column : table.columns) {
    if (const Words* const words = words_in(column))
      for (const std::string& word : words->words)
        if (has_line_end(word))
          refuse_to_write(out.path(),
                          fmt::format("CSV cannot store the text {} of column {}; write .npy, or leave the column out",
                                      quoted_word(word), quoted_word(column.name)));
    if (has_line_end(column.name))
      refuse_to_write(out.path(),
                      fmt::format("the name of column {} has a line end; rename it", quoted_word(column.name)));
    if (!text.empty()) text += ',';
    if (column.name.find_first_of(" \t,;\"") == std::string::npos) {
      text += column.name;
    } else {
      append_quoted(text, column.name);
    }
  }
  text += '\n';
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (c > 0) text += ',';
      visit_value(
          table.columns[c], row, [&](auto number) { append_number(text, number); },
          [&](const std::string& word) { append_quoted(text, word); });
    }
    text += '\n';
    out.flush();
  }
  return {};
}

std::vector<std::string> write_xyz_table(base::OutputFile& out, const Table& table, const FrameHeader& header,
                                         const std::string&) {
  std::string& text = out.buffer();
  std::vector<std::string> left_out;
  const std::vector<XyzOutput> properties = xyz_outputs(table, left_out);
  text = fmt::format("{}\n", table.rows);
  if (header.box) append_box(text, *header.box);
  if (header.step) {
    text += "Timestep=";
    append_number(text, *header.step);
    text += ' ';
  }
  text += "Properties=";
  for (const XyzOutput& property : properties) {
    if (&property != &properties.front()) text += ':';
    text += fmt::format("{}:{}:{}", property.name, property.type, property.columns.size());
  }
  text += '\n';
  for (std::size_t row = 0; row < table.rows; ++row) {
    bool is_first = true;
    for (const XyzOutput& property : properties)
      for (const Column* const column : property.columns) {
        if (!is_first) text += ' ';
        is_first = false;
        if (property.is_color)
          append_number(text, column->number(row) / std::numeric_limits<std::uint8_t>::max());
        else
          visit_value(
              *column, row, [&](auto number) { append_number(text, number); },
              [&](const std::string& word) { text += word; });
      }
    text += '\n';
    out.flush();
  }
  return left_out;
}

/// Returns the function that writes the format of a file.
auto writer_of(const std::filesystem::path& file) {
  const std::string extension = base::extension(file);
  if (extension == ".ply") return write_ply_table;
  if (extension == ".xyz") return write_xyz_table;
  if (extension == ".npy") return write_npy_table;
  if (extension == ".csv") return write_csv_table;
  refuse_to_write(file, fmt::format("unknown extension `{}`; use .ply, .xyz, .npy or .csv", extension));
}

}  // namespace

bool is_storable_in_ply(const Column& column) {
  return ply_output(column) != PlyOutput::kNone && column.name.find_first_of(kPlySeparators) == std::string::npos;
}

void require_table_format(const std::filesystem::path& file) { writer_of(file); }

std::vector<std::string> write_table(const std::filesystem::path& file, const Table& table, const FrameHeader& header,
                                     const std::string& writer) {
  const auto write = writer_of(file);
  base::OutputFile out(file);
  std::vector<std::string> left_out = write(out, table, header, writer);
  out.finish();
  return left_out;
}

}  // namespace orrery::data
