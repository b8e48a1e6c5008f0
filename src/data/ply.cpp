// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/frames.h"
#include "data/readers.h"
#include "data/records.h"

// Reference  turk1994
namespace orrery::data {

namespace {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::kFloat32;
  bool is_list = false;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t line = 0;  ///< line of its declaration
  std::vector<PlyProperty> properties;

  bool has_list() const {
    return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
  }
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  ///< length of the header; the data follow
  std::uint64_t lines = 0;
};

/// Maximum length of a header, bytes: room for ten thousand properties. Avoids scanning a whole file that has no
/// end_header.
inline constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

constexpr NumberTypeName kTypeNames[] = {
    {"char", NumberType::kInt8},      {"int8", NumberType::kInt8},       {"uchar", NumberType::kUint8},
    {"uint8", NumberType::kUint8},    {"short", NumberType::kInt16},     {"int16", NumberType::kInt16},
    {"ushort", NumberType::kUint16},  {"uint16", NumberType::kUint16},   {"int", NumberType::kInt32},
    {"int32", NumberType::kInt32},    {"uint", NumberType::kUint32},     {"uint32", NumberType::kUint32},
    {"float", NumberType::kFloat32},  {"float32", NumberType::kFloat32}, {"double", NumberType::kFloat64},
    {"float64", NumberType::kFloat64}};

/// Reads the header of a file. Its first line is `ply`, see is_ply().
class PlyHeaderReader {
 public:
  explicit PlyHeaderReader(Faults& faults) : faults_(faults) {}

  PlyHeader read(std::string_view file) {
    const std::string_view head = file.substr(0, kLongestHeader);
    std::size_t at = 0;
    bool has_format = false;
    for (line_ = 1;; ++line_) {
      const std::size_t end = head.find('\n', at);
      if (end == std::string_view::npos)
        fail(file.size() == head.size() ? "the header has no end_header"
                                        : fmt::format("the header exceeds the limit of {} bytes", kLongestHeader));
      const Parts words = words_of(head.substr(at, end - at));
      at = end + 1;
      if (line_ == 1 || words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "format") {
        if (has_format) fail("duplicate format line");
        has_format = true;
        read_format(words);
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else if (words[0] == "end_header") {
        if (!has_format) fail("the header has no format line");
        header_.bytes = at;
        header_.lines = line_;
        return std::move(header_);
      } else {
        fail("unknown keyword in the header");
      }
    }
  }

 private:
  using Parts = std::vector<std::string_view>;

  [[noreturn]] void fail(const std::string& text) { faults_.fail(line_, text); }

  void read_format(const Parts& words) {
    if (words.size() != 3) fail("a format line must be `format ENCODING 1.0`");
    if (words[2] != "1.0") fail(fmt::format("unsupported format version `{}`; supported is 1.0", words[2]));
    constexpr std::string_view kEncodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const auto* const encoding = std::find(std::begin(kEncodings), std::end(kEncodings), words[1]);
    if (encoding == std::end(kEncodings))
      fail("unknown encoding; allowed are ascii, binary_little_endian, binary_big_endian");
    header_.encoding = static_cast<PlyEncoding>(encoding - std::begin(kEncodings));
  }

  void read_element(const Parts& words) {
    std::uint64_t count = 0;
    if (words.size() != 3) fail("an element line must be `element NAME COUNT`");
    if (!base::from_text(words[2], count)) fail("the count of an element must be a non-negative integer");
    if (find_named(header_.elements, words[1]) != nullptr) fail(fmt::format("duplicate element `{}`", words[1]));
    header_.elements.push_back({std::string(words[1]), count, line_, {}});
  }

  void read_property(const Parts& words) {
    if (header_.elements.empty()) fail("property before the first element");
    std::vector<PlyProperty>& properties = header_.elements.back().properties;
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3) fail("a property line must be `property TYPE NAME`");
    const auto count_type = number_type(kTypeNames, words[is_list ? 2 : 1]);
    const auto type = number_type(kTypeNames, words[words.size() - 2]);
    if (is_list && !count_type) fail("unknown type of the list length");
    if (!type) fail("unknown type; allowed are char .. double, int8 .. float64");
    if (find_named(properties, words.back()) != nullptr) fail(fmt::format("duplicate property `{}`", words.back()));
    if (properties.size() == kMaxColumns) fail(fmt::format("more than {} properties of an element", kMaxColumns));
    properties.push_back({std::string(words.back()), *type, is_list});
  }

  Faults& faults_;
  std::uint64_t line_ = 0;
  PlyHeader header_;
};

/// Returns the size of an element's row in a binary file, and the minimum in ASCII, bytes. Used to check counts before
/// memory is allocated.
///
/// Domain     an element without lists
std::uint64_t row_bytes(const PlyElement& element, PlyEncoding encoding) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties) bytes += encoding == PlyEncoding::kAscii ? 2 : size_of(p.type);
  return bytes;
}

/// Throws an error at the line of an element if fewer bytes follow than its rows need.
void check_count(Faults& faults, const PlyElement& element, PlyEncoding encoding, std::uint64_t bytes_left) {
  const std::uint64_t each = std::max<std::uint64_t>(1, row_bytes(element, encoding));
  // The last ASCII word need not be followed by a space.
  const std::uint64_t bytes = bytes_left + (encoding == PlyEncoding::kAscii ? 1 : 0);
  if (element.count > bytes / each)
    faults.fail(element.line,
                fmt::format("the header declares {} rows of `{}`, but only {} bytes follow; the file is truncated, or "
                            "the count is wrong",
                            element.count, element.name, bytes_left));
}

bool is_float(NumberType type) { return type == NumberType::kFloat32 || type == NumberType::kFloat64; }

/// The properties of the element `vertex`. What follows the vertices, such as faces, is not read.
class PlyFile final : public SingleFrame {
 public:
  explicit PlyFile(const Bytes& bytes) : SingleFrame(bytes) {
    Faults faults(bytes->file());
    header_ = PlyHeaderReader(faults).read(bytes->text(0, kLongestHeader + 1));
    const PlyElement* const vertex = find_named(header_.elements, "vertex");
    if (vertex == nullptr) faults.fail(0, "there is no element `vertex`");
    vertex_ = static_cast<std::size_t>(vertex - header_.elements.data());
    begin_ = {header_.bytes, header_.lines + 1};
    for (std::size_t e = 0; e <= vertex_; ++e) {
      const PlyElement& element = header_.elements[e];
      if (element.has_list() && !is_ascii_before(e))
        faults.fail(element.line, fmt::format("lists in `{}` are not supported", element.name),
                    "write the vertices first, without lists; lists after them are not read");
      check_count(faults, element, header_.encoding, bytes->size() - begin_.offset);
      if (e < vertex_) skip(element);
    }
    describe_columns(faults);
  }

  Table read(int, const std::vector<std::string>& names) override {
    Faults faults(bytes_->file());
    Table table{static_cast<std::size_t>(info_.rows),
                is_ascii() ? read_lines(names, faults) : read_binary(names, faults)};
    faults.raise_if_any();
    return table;
  }

 private:
  const PlyElement& vertex() const { return header_.elements[vertex_]; }
  bool is_ascii() const { return header_.encoding == PlyEncoding::kAscii; }
  /// Whether an element is one before the vertices in an ASCII file, whose rows are lines.
  bool is_ascii_before(std::size_t element) const { return is_ascii() && element < vertex_; }
  /// Whether nothing follows the vertices.
  bool is_last() const {
    return std::all_of(header_.elements.begin() + static_cast<std::ptrdiff_t>(vertex_) + 1, header_.elements.end(),
                       [](const PlyElement& element) { return element.count == 0; });
  }

  void skip(const PlyElement& element) {
    if (!is_ascii()) {
      begin_.offset += element.count * row_bytes(element, header_.encoding);
      return;
    }
    TextCursor cursor(*bytes_, begin_);
    cursor.skip(element.count);
    begin_ = cursor.place();
  }

  /// Numbers of an ASCII file are read as float64 or int64.
  ColumnType type_of(const PlyProperty& property) const {
    if (!is_ascii()) return column_type(property.type);
    return is_float(property.type) ? ColumnType::kFloat64 : ColumnType::kInt64;
  }

  void describe_columns(Faults& faults) {
    std::vector<ColumnInfo> declared;  // full intensity depends on the declared type
    for (const PlyProperty& property : vertex().properties) {
      declared.push_back({property.name, column_type(property.type)});
      info_.columns.push_back({property.name, type_of(property)});
    }
    info_.rows = vertex().count;
    info_.may_be_of_scene = info_.may_be_hollow = true;
    info_.roles = required_roles(declared, faults);
  }

  std::vector<Column> read_binary(const std::vector<std::string>& names, Faults& faults) const {
    const RecordLayout layout{begin_.offset, row_bytes(vertex(), header_.encoding), vertex().count};
    if (const std::uint64_t rest = bytes_->size() - layout.begin - layout.rows * layout.stride; rest > 0 && is_last())
      faults.fail(vertex().line, fmt::format("{} bytes follow the last row that the header declares; the counts are "
                                             "wrong, or the file is damaged",
                                             rest));
    std::vector<RecordField> fields;
    for (const std::string& name : names) {
      RecordField& field = fields.emplace_back();
      field = {name, {}, 0, header_.encoding == PlyEncoding::kBigEndian};
      for (const PlyProperty& property : vertex().properties) {
        field.type = property.type;
        if (property.name == name) break;
        field.offset += size_of(property.type);
      }
    }
    return read_records(*bytes_, layout, fields, faults);
  }

  std::vector<Column> read_lines(const std::vector<std::string>& names, Faults& faults) const {
    TextLayout layout;
    layout.begin = begin_.offset;
    layout.first_line = begin_.line;
    layout.columns = info_.columns;
    layout.wanted = names;
    if (!is_last()) layout.rows = vertex().count;
    Table table = read_text_rows(*bytes_, layout, faults).table;
    if (table.rows != vertex().count)
      faults.fail(
          vertex().line,
          fmt::format(
              "the header declares {} rows of `vertex`, but there are {}; the file is truncated, or the count is wrong",
              vertex().count, table.rows));
    return std::move(table.columns);
  }

  PlyHeader header_;
  std::size_t vertex_ = 0;   ///< index of the element
  TextCursor::Place begin_;  ///< of the vertices
};

bool is_ply(const Signature& signature) {
  return signature.head.starts_with("ply\n") || signature.head.starts_with("ply\r\n");
}

}  // namespace

const FormatReader kPly = {"PLY", is_ply, open_as<PlyFile>};

}  // namespace orrery::data
