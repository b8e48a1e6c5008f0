// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
  NumberType count_type = NumberType::kUint8;  ///< type of the list length
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
    properties.push_back({std::string(words.back()), *type, is_list, *count_type});
  }

  Faults& faults_;
  std::uint64_t line_ = 0;
  PlyHeader header_;
};

bool is_white_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Reads values in sequence from the data after the header. In an ASCII file, each row is one line.
///
/// Cost       2 MiB of memory
class PlyCursor {
 public:
  /// `begin`    offset of the first data byte, `line` its line number
  PlyCursor(const ByteSource& bytes, std::uint64_t begin, PlyEncoding encoding, std::uint64_t line)
      : bytes_(&bytes),
        next_(std::min(begin, bytes.size())),
        buffer_(2 * kMaxLineBytes),
        line_(line),
        ascii_(encoding == PlyEncoding::kAscii),
        is_big_endian_(encoding == PlyEncoding::kBigEndian) {
    fill();
  }

  /// Advances to the next row; skips blank lines.
  ///
  /// Errors     base::Error: kIo; kBadData for a line that is too long
  void begin_row() {
    if (!ascii_) return;
    for (row_line_ = line_; bytes_left() > 0; row_line_ = line_) {
      find_row_end();
      skip_blanks();
      if (at_ < row_end_) return;
      step_over_line_end();
    }
    row_end_ = end_;
  }

  /// Ends a row; false if the row has unread values left.
  bool end_row() {
    if (!ascii_) return true;
    skip_blanks();
    if (at_ < row_end_) return false;
    step_over_line_end();
    return true;
  }

  /// The line number of the row; 0 in a binary file.
  std::uint64_t line() const { return row_line_; }

  /// Reads a value; false at the end of the row or the data, or if an ASCII value is not a number.
  bool take(NumberType type, double& value) {
    if (ascii_) return take_word(value);
    const std::size_t size = size_of(type);
    if (bytes_left() < size) return false;
    if (static_cast<std::size_t>(end_ - at_) < size) fill();
    value =
        with_type(type, [&](auto number) { return static_cast<double>(load<decltype(number)>(at_, is_big_endian_)); });
    at_ += size;
    return true;
  }

  /// Skips a value or a list; false as for take(), and if the length of the list is invalid.
  bool skip(const PlyProperty& property) {
    double value = 0;
    if (!property.is_list) return take(property.type, value);
    if (!take(property.count_type, value)) return false;
    is_bad_length_ = !(value >= 0) || value != std::floor(value);
    if (is_bad_length_) return false;
    if (!ascii_) {
      const std::size_t size = size_of(property.type);
      if (value > static_cast<double>(bytes_left() / size)) return false;
      skip_bytes(static_cast<std::uint64_t>(value) * size);
      return true;
    }
    for (double i = 0; i < value; ++i) {
      double ignored = 0;
      if (!take(property.type, ignored)) return false;  // stops at the end of the row, regardless of the length
    }
    return true;
  }

  /// Skips bytes of a binary file.
  ///
  /// Domain     bytes <= bytes_left()
  void skip_bytes(std::uint64_t bytes) {
    const std::uint64_t some = std::min(bytes, static_cast<std::uint64_t>(end_ - at_));
    at_ += some;
    next_ += bytes - some;
  }

  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_) + bytes_->size() - next_; }

  /// Returns why the last take or skip failed.
  std::string fault() const {
    if (is_bad_length_) return "the length of the list is not a non-negative integer";
    if (ascii_ && at_ < row_end_) return fmt::format("`{}` is not a number", word());
    return ascii_ && bytes_left() > 0 ? "unexpected end of line; a row must be one line" : "unexpected end of file";
  }

  /// Returns the next word in the row, truncated if it is long.
  std::string word() const {
    constexpr std::ptrdiff_t kLongestShown = 40;
    const char* const most = at_ + std::min(kLongestShown, row_end_ - at_);
    return {at_, std::find_if(at_, most, is_white_space)};
  }

 private:
  /// Moves the unread bytes to the front of the buffer, and reads more.
  void fill() {
    const auto left = static_cast<std::size_t>(end_ - at_);
    if (left > 0) std::memmove(buffer_.data(), at_, left);
    const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_.size() - left, bytes_->size() - next_));
    bytes_->read(next_, more, buffer_.data() + left);
    next_ += more;
    at_ = buffer_.data();
    end_ = row_end_ = at_ + left + more;
  }

  void find_row_end() {
    const auto found = [&] { return std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_)); };
    const void* newline = found();
    while (newline == nullptr && next_ < bytes_->size()) {
      if (static_cast<std::size_t>(end_ - at_) > kMaxLineBytes) fail_as_too_long(*bytes_, line_);
      fill();
      newline = found();
    }
    row_end_ = newline != nullptr ? static_cast<const char*>(newline) : end_;
  }

  void skip_blanks() {
    while (at_ < row_end_ && is_white_space(*at_)) ++at_;
  }

  void step_over_line_end() {
    at_ = row_end_;
    if (at_ == end_) return;
    ++at_;
    ++line_;
  }

  bool take_word(double& value) {
    skip_blanks();
    const char* const end = std::find_if(at_, row_end_, is_white_space);
    if (!parse_number({at_, end}, value)) return false;
    at_ = end;
    return true;
  }

  const ByteSource* bytes_;
  std::uint64_t next_;  ///< offset of the first byte behind the buffer
  std::vector<char> buffer_;
  const char* at_ = nullptr;
  const char* end_ = nullptr;  ///< of the bytes in the buffer
  const char* row_end_ = nullptr;
  std::uint64_t line_, row_line_ = 0;
  bool ascii_, is_big_endian_, is_bad_length_ = false;
};

/// Reads one row. Errors refer to its line; in a binary file, to that of the element. Calls `take(property, index)` for
/// each property, which returns false if the value is invalid.
///
/// `name()`   name of the row, for messages
template <class Name, class Take>
void read_row(Faults& faults, const PlyElement& element, PlyCursor& cursor, Name name, Take take) {
  const auto fail = [&](const std::string& text) {
    faults.fail(cursor.line() > 0 ? cursor.line() : element.line, name() + text);
  };
  cursor.begin_row();
  for (std::size_t k = 0; k < element.properties.size(); ++k)
    if (!take(element.properties[k], k)) fail(", `" + element.properties[k].name + "`: " + cursor.fault());
  if (!cursor.end_row()) fail(": unexpected `" + cursor.word() + "` after the last value that the header declares");
}

/// Returns the minimum size of an element's row, in bytes; exact in a binary file if the element has no lists. Used to
/// check counts before memory is allocated.
std::uint64_t min_bytes(const PlyElement& element, PlyEncoding encoding) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties)
    bytes += encoding == PlyEncoding::kAscii ? 2 : p.is_list ? size_of(p.count_type) : size_of(p.type);
  return bytes;
}

/// Throws an error at the line of an element if fewer bytes follow than its rows need.
void check_count(Faults& faults, const PlyElement& element, const PlyHeader& header, std::uint64_t bytes_left) {
  const std::uint64_t each = std::max<std::uint64_t>(1, min_bytes(element, header.encoding));
  // The last ASCII word need not be followed by a space.
  const std::uint64_t bytes = bytes_left + (header.encoding == PlyEncoding::kAscii ? 1 : 0);
  if (element.count > bytes / each)
    faults.fail(element.line,
                fmt::format("the header declares {} rows of `{}`, but only {} bytes follow; the file is truncated, or "
                            "the count is wrong",
                            element.count, element.name, bytes_left));
}

/// Skips an element other than `vertex`.
void skip_element(Faults& faults, const PlyElement& element, const PlyHeader& header, PlyCursor& cursor) {
  if (element.properties.empty()) return;
  if (header.encoding != PlyEncoding::kAscii && !element.has_list())
    return cursor.skip_bytes(element.count * min_bytes(element, header.encoding));
  for (std::uint64_t i = 0; i < element.count; ++i)
    read_row(
        faults, element, cursor, [&] { return fmt::format("row {} of `{}`", i + 1, element.name); },
        [&](const PlyProperty& property, std::size_t) { return cursor.skip(property); });
}

/// Throws an error, at the line of the last element with rows, if data follow the last row that the header declares.
void check_end(Faults& faults, const PlyHeader& header, PlyCursor& cursor) {
  cursor.begin_row();
  if (cursor.bytes_left() == 0) return;
  const auto last = std::find_if(header.elements.rbegin(), header.elements.rend(),
                                 [](const PlyElement& element) { return element.count > 0; });
  const PlyElement& element = last != header.elements.rend() ? *last : header.elements.back();
  faults.fail(element.line,
              fmt::format("{} bytes follow the last row that the header declares; the counts are wrong, or the "
                          "file is damaged",
                          cursor.bytes_left()));
}

bool is_float(NumberType type) { return type == NumberType::kFloat32 || type == NumberType::kFloat64; }

/// The columns of a `vertex` element: all properties but lists.
class PlyFile final : public SingleFrame {
 public:
  explicit PlyFile(const Bytes& bytes) : SingleFrame(bytes) {
    Faults faults(bytes->file());
    header_ = PlyHeaderReader(faults).read(bytes->text(0, kLongestHeader + 1));
    const PlyElement* const vertex = find_named(header_.elements, "vertex");
    if (vertex == nullptr) faults.fail(0, "there is no element `vertex`");
    vertex_ = static_cast<std::size_t>(vertex - header_.elements.data());
    std::uint64_t left = bytes->size() - header_.bytes;
    for (const PlyElement& element : header_.elements) {
      check_count(faults, element, header_, left);
      left -= std::min(left, element.count * min_bytes(element, header_.encoding));
    }
    describe_columns(faults);
  }

  Table read(int, const std::vector<std::string>& names) override {
    Faults faults(bytes_->file());
    Table table{static_cast<std::size_t>(info_.rows), !has_plain_rows() ? read_rows(names, faults)
                                                      : is_ascii()      ? read_lines(names, faults)
                                                                        : read_binary(names, faults)};
    faults.raise_if_any();
    return table;
  }

 private:
  const PlyElement& vertex() const { return header_.elements[vertex_]; }
  bool is_ascii() const { return header_.encoding == PlyEncoding::kAscii; }
  /// Numbers of an ASCII file are read as float64 or int64.
  ColumnType type_of(const PlyProperty& property) const {
    if (!is_ascii()) return column_type(property.type);
    return is_float(property.type) ? ColumnType::kFloat64 : ColumnType::kInt64;
  }

  void describe_columns(Faults& faults) {
    std::vector<ColumnInfo> declared;  // full intensity depends on the declared type
    for (const PlyProperty& property : vertex().properties)
      if (!property.is_list) {
        declared.push_back({property.name, column_type(property.type)});
        info_.columns.push_back({property.name, type_of(property)});
      }
    info_.rows = vertex().count;
    info_.may_be_of_scene = info_.may_be_hollow = true;
    info_.roles = required_roles(declared, faults);
  }

  /// Returns whether the vertices can be read without following lists or lines of other elements.
  bool has_plain_rows() const {
    if (vertex().has_list()) return false;
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      const PlyElement& element = header_.elements[e];
      if (e != vertex_ && element.count > 0 && (is_ascii() || (e < vertex_ && element.has_list()))) return false;
    }
    return true;
  }

  std::vector<Column> read_binary(const std::vector<std::string>& names, Faults& faults) const {
    RecordLayout layout;
    layout.begin = header_.bytes;
    for (std::size_t e = 0; e < vertex_; ++e)
      layout.begin += header_.elements[e].count * min_bytes(header_.elements[e], header_.encoding);
    layout.stride = min_bytes(vertex(), header_.encoding);
    layout.rows = vertex().count;
    check_rest(layout.begin + layout.rows * layout.stride, faults);
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

  /// Checks that the elements after the vertices are complete.
  void check_rest(std::uint64_t at, Faults& faults) const {
    std::size_t e = vertex_ + 1;
    for (; e < header_.elements.size() && !header_.elements[e].has_list(); ++e)
      at += header_.elements[e].count * min_bytes(header_.elements[e], header_.encoding);
    PlyCursor cursor(*bytes_, at, header_.encoding, 0);
    for (; e < header_.elements.size(); ++e) {
      check_count(faults, header_.elements[e], header_, cursor.bytes_left());
      skip_element(faults, header_.elements[e], header_, cursor);
    }
    check_end(faults, header_, cursor);
  }

  /// Reads an ASCII file that contains only vertices.
  std::vector<Column> read_lines(const std::vector<std::string>& names, Faults& faults) const {
    TextLayout layout;
    layout.begin = header_.bytes;
    layout.first_line = header_.lines + 1;
    layout.columns = info_.columns;
    layout.wanted = names;
    Table table = read_text_rows(*bytes_, layout, faults).table;
    if (table.rows != vertex().count)
      faults.fail(
          vertex().line,
          fmt::format(
              "the header declares {} rows of `vertex`, but there are {}; the file is truncated, or the count is wrong",
              vertex().count, table.rows));
    return std::move(table.columns);
  }

  /// Reads all rows one by one, with lists and with other elements between them.
  std::vector<Column> read_rows(const std::vector<std::string>& names, Faults& faults) const {
    PlyCursor cursor(*bytes_, header_.bytes, header_.encoding, header_.lines + 1);
    Table table = empty_table(names);
    std::vector<Column*> targets;  // of the properties; null unless they are wanted
    for (const PlyProperty& property : vertex().properties) targets.push_back(table.find(property.name));
    for (const PlyElement& element : header_.elements) {
      check_count(faults, element, header_, cursor.bytes_left());
      if (&element != &vertex()) {
        skip_element(faults, element, header_, cursor);
        continue;
      }
      for (Column& column : table.columns)
        std::visit(
            [&](auto& values) {
              if constexpr (requires { values.reserve(0); }) values.reserve(static_cast<std::size_t>(element.count));
            },
            column.values);
      for (std::uint64_t i = 0; i < element.count; ++i) {
        const auto name = [&] { return fmt::format("vertex {} of {}", i + 1, element.count); };
        read_row(faults, element, cursor, name, [&](const PlyProperty& property, std::size_t k) {
          double value = 0;
          if (property.is_list) return cursor.skip(property);
          if (!cursor.take(property.type, value)) return false;
          if (targets[k] != nullptr && !append(targets[k]->values, value))
            faults.fail(cursor.line(), fmt::format("{}, `{}`: not a 64-bit integer", name(), property.name));
          return true;
        });
      }
    }
    check_end(faults, header_, cursor);
    return std::move(table.columns);
  }

  /// Appends a number to a column; false if the column has integers and the number is not one.
  static bool append(Values& values, double number) {
    return std::visit(
        [number](auto& column) {
          if constexpr (requires { column.push_back({}); }) {
            using T = typename std::decay_t<decltype(column)>::value_type;
            if constexpr (std::is_same_v<T, std::int64_t>) {
              constexpr double kBound = 9223372036854775808.0;  // 2^63
              if (!(number >= -kBound && number < kBound) || number != std::floor(number)) return false;
            }
            column.push_back(static_cast<T>(number));
          }
          return true;
        },
        values);
  }

  PlyHeader header_;
  std::size_t vertex_ = 0;  ///< index of the element
};

bool is_ply(const Signature& signature) {
  return signature.head.starts_with("ply\n") || signature.head.starts_with("ply\r\n");
}

}  // namespace

const FormatReader kPly = {"PLY", is_ply, open_as<PlyFile>};

}  // namespace orrery::data
