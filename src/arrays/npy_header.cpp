// SPDX-License-Identifier: Apache-2.0
#include "arrays/npy_header.h"

#include <charconv>
#include <cstddef>

#include <fmt/core.h>

#include "arrays/python_literal.h"
#include "data/byte_source.h"

#include "data/customary.h"
#include "data/quoted_word.h"

namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

using Kind = PythonLiteral::Kind;
using namespace std::string_view_literals;

constexpr std::string_view kNpySignature = "\x93NUMPY"sv;
/// NumPy's own limit.
constexpr std::size_t kMaxDimensions = 64;

/// Parses the type of an item, e.g. `<f4`.
///
/// Result     an empty string, or what is wrong; a field of padding has size 0 components
std::string parse_type(const std::string& code, NpyField& field) {
  const std::string type = "the type " + quoted_word(code);
  const std::string unsupported = type + " is not supported; convert the array to numbers, e.g. with `astype('f8')`";
  if (code.size() < 3 || std::string_view("<>|=").find(code[0]) == std::string_view::npos) {
    if (code == "|O" || code == "O") return "it contains Python objects; convert them, e.g. with `astype('f8')`";
    return unsupported;
  }
  if (code[1] == 'O') return "it contains Python objects; convert them, e.g. with `astype('f8')`";
  const char* const last = code.data() + code.size();
  const auto [end, error] = std::from_chars(code.data() + 2, last, field.size);
  if (error != std::errc() || end != last) return unsupported;
  field.is_big_endian = code[0] == '>';
  if (code[1] == 'S' || code[1] == 'a' || code[1] == 'U' || code[1] == 'V') {
    if (field.size > kLongestNpyText) return fmt::format("{} is longer than {}", type, kLongestNpyText);
    field.kind = code[1] == 'U' ? NpyField::Kind::kUtf32 : NpyField::Kind::kBytes;
    if (code[1] == 'U') field.size *= 4;
    if (code[1] == 'V') field.components = 0;
    return {};
  }
  struct Name {
    std::string_view code;
    NumberType type;
  };
  static constexpr Name kNames[] = {
      {"i1", NumberType::kInt8},    {"u1", NumberType::kUint8},  {"b1", NumberType::kUint8},
      {"i2", NumberType::kInt16},   {"u2", NumberType::kUint16}, {"i4", NumberType::kInt32},
      {"u4", NumberType::kUint32},  {"i8", NumberType::kInt64},  {"u8", NumberType::kUint64},
      {"f4", NumberType::kFloat32}, {"f8", NumberType::kFloat64}};
  for (const Name& known : kNames) {
    if (known.code != std::string_view(code).substr(1)) continue;
    field.type = known.type;
    return {};
  }
  return unsupported;
}

/// Parses one field of a record: (name, type) or (name, type, shape); a name may be (title, name).
std::string parse_field(const PythonLiteral& source, NpyHeader& header) {
  if (!source.is(Kind::kSequence) || source.items.size() < 2 || source.items.size() > 3)
    return "a field is not (name, type) or (name, type, shape)";
  const PythonLiteral& first = source.items[0];
  const PythonLiteral& name = first.is(Kind::kSequence) && first.items.size() == 2 ? first.items[1] : first;
  if (!name.is(Kind::kText)) return "the name of a field is not a string";
  NpyField field;
  field.name = name.text;
  if (!source.items[1].is(Kind::kText))
    return fmt::format("field {} is a record; save its fields separately", quoted_word(field.name));
  if (const std::string fault = parse_type(source.items[1].text, field); !fault.empty())
    return fmt::format("field {}: {}", quoted_word(field.name), fault);
  const bool is_padding = field.components == 0;
  std::uint64_t count = 1;
  if (source.items.size() == 3) {
    if (!source.items[2].is(Kind::kSequence))
      return fmt::format("the shape of field {} is not a tuple", quoted_word(field.name));
    for (const PythonLiteral& length : source.items[2].items) {
      if (!length.is(Kind::kInteger))
        return fmt::format("the shape of field {} is not integers", quoted_word(field.name));
      if (length.integer > kMaxColumns || (count *= length.integer) > kMaxColumns)
        return fmt::format("field {} has more than {} components", quoted_word(field.name), kMaxColumns);
    }
  }
  field.offset = header.item_size;
  header.item_size += field.size * count;
  if (is_padding || count == 0) return {};
  field.components = count;
  header.fields.push_back(std::move(field));
  return {};
}

std::string parse_description(const PythonLiteral& source, NpyHeader& header) {
  if (source.is(Kind::kText)) {
    NpyField field;
    if (std::string fault = parse_type(source.text, field); !fault.empty()) return fault;
    if (field.components == 0) return "its items are raw bytes (dtype void)";
    header.item_size = field.size;
    header.fields.push_back(field);
    return {};
  }
  if (!source.is(Kind::kSequence)) return "`descr` is neither a type nor a list of fields";
  header.is_structured = true;
  std::uint64_t columns = 0;
  for (const PythonLiteral& field : source.items) {
    const std::size_t fields = header.fields.size();
    if (std::string fault = parse_field(field, header); !fault.empty()) return fault;
    if (header.fields.size() > fields) columns += header.fields.back().components;
    if (columns > kMaxColumns) return fmt::format("it has more than {} components", kMaxColumns);
  }
  return {};
}

std::string parse_shape(const PythonLiteral& source, NpyHeader& header) {
  if (!source.is(Kind::kSequence)) return "`shape` is not a tuple";
  if (source.items.size() > kMaxDimensions) return fmt::format("it has more than {} dimensions", kMaxDimensions);
  for (const PythonLiteral& length : source.items) {
    if (!length.is(Kind::kInteger)) return "`shape` is not a tuple of integers";
    header.shape.push_back(length.integer);
  }
  return {};
}

std::uint64_t length_bytes(std::string_view head) { return head[kNpySignature.size()] == 1 ? 2 : 4; }

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
  PythonLiteral source;
  if (const std::string fault =
          parse_python_literal(head.substr(text, static_cast<std::size_t>(header.begin) - text), source);
      !fault.empty())
    return "the header is malformed: " + fault;
  const PythonLiteral* const description = source.find("descr");
  const PythonLiteral* const order = source.find("fortran_order");
  const PythonLiteral* const shape = source.find("shape");
  if (description == nullptr || order == nullptr || shape == nullptr || !order->is(Kind::kBool))
    return "the header needs `descr`, `fortran_order` and `shape`";
  header.is_fortran_order = order->integer == 1;
  if (std::string fault = parse_shape(*shape, header); !fault.empty()) return fault;
  return parse_description(*description, header);
}

}  // namespace orrery::arrays
