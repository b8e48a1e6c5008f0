// SPDX-License-Identifier: Apache-2.0
#include "data/npy_array.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "data/columns.h"
#include "data/dictionary.h"

namespace orrery::data {

namespace {

using nlohmann::json;

/// What is wrong with a header.
struct NpyFault {
  std::string text;
};

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

/// Translates a header to JSON, from which Python's literals differ in quotes, tuples, the names of Booleans, and
/// commas after the last element.
///
/// `is_latin1`  it is encoded in Latin-1 instead of UTF-8
/// Errors       NpyFault
std::string json_text_of(std::string_view python, bool is_latin1) {
  std::string out;
  char quote = '\0';  // of the string
  for (std::size_t i = 0; i < python.size(); ++i) {
    const std::string_view rest = python.substr(i);
    const char c = rest.front();
    const bool is_in_string = quote != '\0';
    if (is_in_string && c == '\\') {
      const std::string_view escape = rest.substr(0, 2);
      if (escape != "\\\\" && escape != "\\'" && escape != "\\\"")
        throw NpyFault{"the header is malformed: a string contains an escape sequence that is not supported"};
      out += escape[1] == '\'' ? "'" : escape;
      ++i;
    } else if (is_in_string ? c == quote : c == '\'' || c == '"') {
      quote = is_in_string ? '\0' : c;
      out += '"';
    } else if (is_in_string) {
      if (c == '"') out += '\\';
      is_latin1 ? void(append_utf8(out, static_cast<unsigned char>(c))) : out.push_back(c);
    } else if (rest.starts_with("True") || rest.starts_with("False")) {
      out += c == 'T' ? "true" : "false";
      i += c == 'T' ? 3 : 4;
    } else if (c == ',') {
      const std::size_t next = rest.find_first_not_of(" \t\r\n", 1);
      if (next == std::string_view::npos || std::string_view(")]}").find(rest[next]) == std::string_view::npos)
        out += c;
    } else if (c != 'L') {  // of long integers of Python 2
      out += c == '(' ? '[' : c == ')' ? ']' : c;
    }
  }
  return out;
}

const std::string& text_of(const json& value) { return value.get_ref<const std::string&>(); }

using namespace std::string_view_literals;

constexpr std::string_view kNpySignature = "\x93NUMPY"sv;
/// NumPy's own limit.
constexpr std::size_t kMaxDimensions = 64;
/// Bytes of the longest number, complex256.
constexpr std::uint64_t kLongestNumber = 32;

/// Parses the type of an item, e.g. `<f4`.
///
/// `where`    precedes faults
/// Result     a field has 0 components if it is padding, or of a type of numbers without a column type, such as float16
NpyField parse_type(const std::string& code, const std::string& where = {}) {
  const auto fail = [&](const std::string& text) { throw NpyFault{where + text}; };
  const std::string type = "the type " + quoted_word(code);
  const std::string unsupported = type + " is not supported; convert the array to numbers, e.g. with `astype('f8')`";
  constexpr std::string_view kWithoutColumn = "fcmM";  // float, complex, times; `<M8[ns]` has a unit
  const bool has_order = !code.empty() && std::string_view("<>|=").find(code[0]) != std::string_view::npos;
  if (code == "O" || (has_order && code.size() > 1 && code[1] == 'O'))
    fail("it contains Python objects; convert them, e.g. with `astype('f8')`");
  NpyField field;
  const bool is_time = has_order && code.size() > 1 && (code[1] == 'M' || code[1] == 'm');
  const std::string_view size = std::string_view(code).substr(std::min<std::size_t>(code.size(), 2));
  if (!has_order || !base::from_text(is_time ? size.substr(0, size.find('[')) : size, field.size)) fail(unsupported);
  field.is_big_endian = code[0] == '>';
  if (code[1] == 'S' || code[1] == 'a' || code[1] == 'U' || code[1] == 'V') {
    if (field.size > kLongestNpyText) fail(fmt::format("{} is longer than {}", type, kLongestNpyText));
    field.kind = code[1] == 'U' ? NpyField::Kind::kUtf32 : NpyField::Kind::kBytes;
    if (code[1] == 'U') field.size *= 4;
    if (code[1] == 'V') field.components = 0;
    return field;
  }
  static constexpr NumberTypeName kNames[] = {
      {"i1", NumberType::kInt8},    {"u1", NumberType::kUint8},  {"b1", NumberType::kUint8},
      {"i2", NumberType::kInt16},   {"u2", NumberType::kUint16}, {"i4", NumberType::kInt32},
      {"u4", NumberType::kUint32},  {"i8", NumberType::kInt64},  {"u8", NumberType::kUint64},
      {"f4", NumberType::kFloat32}, {"f8", NumberType::kFloat64}};
  const std::optional<NumberType> known = number_type(kNames, std::string_view(code).substr(1));
  if (known)
    field.type = *known;
  else if (kWithoutColumn.find(code[1]) != std::string_view::npos && field.size <= kLongestNumber)
    field.components = 0;
  else
    fail(unsupported);
  return field;
}

/// Parses one field of a record: (name, type) or (name, type, shape); a name may be (title, name).
void parse_field(const json& source, NpyHeader& header) {
  if (!source.is_array() || source.size() < 2 || source.size() > 3)
    throw NpyFault{"a field is not (name, type) or (name, type, shape)"};
  const json& name = source[0].is_array() && source[0].size() == 2 ? source[0][1] : source[0];
  if (!name.is_string()) throw NpyFault{"the name of a field is not a string"};
  const std::string shown = quoted_word(text_of(name));
  if (!source[1].is_string()) throw NpyFault{fmt::format("field {} is a record; save its fields separately", shown)};
  NpyField field = parse_type(text_of(source[1]), fmt::format("field {}: ", shown));
  field.name = text_of(name);
  std::uint64_t count = 1;
  if (source.size() == 3) {
    if (!source[2].is_array()) throw NpyFault{fmt::format("the shape of field {} is not a tuple", shown)};
    for (const json& length : source[2]) {
      if (!length.is_number_unsigned()) throw NpyFault{fmt::format("the shape of field {} is not integers", shown)};
      const std::uint64_t number = length;
      if (number > kMaxColumns || (count *= number) > kMaxColumns)
        throw NpyFault{fmt::format("field {} has more than {} components", shown, kMaxColumns)};
    }
  }
  field.offset = header.item_size;
  header.item_size += field.size * count;
  field.components *= count;
  if (field.components > 0) header.fields.push_back(std::move(field));
}

void parse_description(const json& source, NpyHeader& header) {
  if (source.is_string()) {
    header.fields.push_back(parse_type(text_of(source)));
    if (header.fields[0].components == 0)
      throw NpyFault{header.fields[0].kind == NpyField::Kind::kBytes
                         ? "its items are raw bytes (dtype void)"
                         : fmt::format("the type {} is not supported; convert the array to numbers, e.g. with "
                                       "`astype('f8')`",
                                       quoted_word(text_of(source)))};
    header.item_size = header.fields[0].size;
    return;
  }
  if (!source.is_array()) throw NpyFault{"`descr` is neither a type nor a list of fields"};
  header.is_structured = true;
  std::uint64_t columns = 0;
  for (const json& field : source) {
    const std::size_t fields = header.fields.size();
    parse_field(field, header);
    if (header.fields.size() > fields) columns += header.fields.back().components;
    if (columns > kMaxColumns) throw NpyFault{fmt::format("it has more than {} components", kMaxColumns)};
  }
}

void parse_shape(const json& source, NpyHeader& header) {
  if (!source.is_array()) throw NpyFault{"`shape` is not a tuple"};
  if (source.size() > kMaxDimensions) throw NpyFault{fmt::format("it has more than {} dimensions", kMaxDimensions)};
  for (const json& length : source) {
    if (!length.is_number_unsigned()) throw NpyFault{"`shape` is not a tuple of integers"};
    header.shape.push_back(length);
  }
}

std::uint64_t length_bytes(std::string_view head) { return head[kNpySignature.size()] == 1 ? 2 : 4; }

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

bool has_npy_signature(std::string_view head) { return head.starts_with(kNpySignature); }

std::uint64_t npy_header_end(std::string_view head) {
  constexpr std::uint64_t kLengthAt = 8;  // after signature and version
  if (head.size() < kLengthAt + 4) return 0;
  const char* const at = head.data() + kLengthAt;
  const std::uint64_t length =
      length_bytes(head) == 2 ? load<std::uint16_t>(at, false) : load<std::uint32_t>(at, false);
  return kLengthAt + length_bytes(head) + length;
}

std::string parse_npy_header(std::string_view head, NpyHeader& header) {
  header.begin = npy_header_end(head);
  if (header.begin == 0) return "the file ends within the header";
  const int version = head[kNpySignature.size()];
  if (version < 1 || version > 3) return fmt::format("version {} of the format; supported: 1 to 3", version);
  if (header.begin > kLongestNpyHeader)
    return fmt::format("the header exceeds the limit of {} bytes", kLongestNpyHeader);
  if (header.begin > head.size()) return "the file ends within the header";
  const std::size_t text = 8 + length_bytes(head);
  try {
    const json source = json::parse(
        json_text_of(head.substr(text, static_cast<std::size_t>(header.begin) - text), version < 3), nullptr, false);
    if (source.is_discarded()) return "the header is malformed";
    const auto member = [&](const char* key) { return source.is_object() ? source.value(key, json()) : json(); };
    const json order = member("fortran_order");
    if (member("descr").is_null() || member("shape").is_null() || !order.is_boolean())
      return "the header needs `descr`, `fortran_order` and `shape`";
    header.is_fortran_order = order;
    parse_shape(member("shape"), header);
    parse_description(member("descr"), header);
  } catch (const NpyFault& fault) {
    return fault.text;
  }
  return {};
}

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
    if (columns[c].type() == ColumnType::kText) {
      out[c] = {columns[c].name, read_texts(bytes, rows, columns[c], faults)};
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
    std::vector<Column> read = read_records(bytes, {columns[c].begin, columns[c].stride, rows}, fields, faults);
    for (std::size_t k = 0; k < targets.size(); ++k) out[targets[k]] = std::move(read[k]);
  }
  return out;
}

}  // namespace orrery::data
