// SPDX-License-Identifier: Apache-2.0
#include "rows/ply_header.h"

#include <algorithm>
#include <charconv>

#include <fmt/core.h>

#include "data/byte_source.h"

#include "data/customary.h"
#include "data/text_cursor.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

bool parse_type(std::string_view word, NumberType& type) {
  struct Name {
    std::string_view name;
    NumberType type;
  };
  static constexpr Name kNames[] = {
      {"char", NumberType::kInt8},      {"int8", NumberType::kInt8},       {"uchar", NumberType::kUint8},
      {"uint8", NumberType::kUint8},    {"short", NumberType::kInt16},     {"int16", NumberType::kInt16},
      {"ushort", NumberType::kUint16},  {"uint16", NumberType::kUint16},   {"int", NumberType::kInt32},
      {"int32", NumberType::kInt32},    {"uint", NumberType::kUint32},     {"uint32", NumberType::kUint32},
      {"float", NumberType::kFloat32},  {"float32", NumberType::kFloat32}, {"double", NumberType::kFloat64},
      {"float64", NumberType::kFloat64}};
  for (const Name& known : kNames) {
    if (known.name != word) continue;
    type = known.type;
    return true;
  }
  return false;
}

template <class Named>
bool is_named(const std::vector<Named>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const Named& n) { return n.name == name; });
}

std::string parse_format(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (words.size() != 3) return "a format line must be `format ENCODING 1.0`";
  if (words[2] != "1.0") return fmt::format("unsupported format version `{}`; supported is 1.0", words[2]);
  if (words[1] == "ascii") {
    header.encoding = PlyEncoding::kAscii;
  } else if (words[1] == "binary_little_endian") {
    header.encoding = PlyEncoding::kLittleEndian;
  } else if (words[1] == "binary_big_endian") {
    header.encoding = PlyEncoding::kBigEndian;
  } else {
    return "unknown encoding; allowed are ascii, binary_little_endian, binary_big_endian";
  }
  return {};
}

std::string parse_element(const std::vector<std::string_view>& words, int line, PlyHeader& header) {
  PlyElement element;
  element.line = line;
  if (words.size() != 3) return "an element line must be `element NAME COUNT`";
  element.name = words[1];
  const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
  if (error != std::errc() || end != words[2].data() + words[2].size())
    return "the count of an element must be a non-negative integer";
  if (is_named(header.elements, element.name)) return fmt::format("duplicate element `{}`", element.name);
  header.elements.push_back(element);
  return {};
}

std::string parse_property(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (header.elements.empty()) return "property before the first element";
  PlyProperty property;
  property.is_list = words.size() == 5 && words[1] == "list";
  if (!property.is_list && words.size() != 3) return "a property line must be `property TYPE NAME`";
  if (property.is_list && !parse_type(words[2], property.count_type)) return "unknown type of the list length";
  if (!parse_type(words[words.size() - 2], property.type))
    return "unknown type; allowed are char .. double, int8 .. float64";
  property.name = words.back();
  if (is_named(header.elements.back().properties, property.name))
    return fmt::format("duplicate property `{}`", property.name);
  if (header.elements.back().properties.size() == kMaxColumns)
    return fmt::format("more than {} properties of an element", kMaxColumns);
  header.elements.back().properties.push_back(property);
  return {};
}

}  // namespace

std::string parse_ply_header(std::string_view file, PlyHeader& header, int& line) {
  constexpr const char* kNoPly = "not a PLY file: the first line is not `ply`";
  const std::string_view head = file.substr(0, kLongestHeader);
  std::size_t at = 0;
  bool has_format = false;
  for (line = 1;; ++line) {
    const std::size_t end = head.find('\n', at);
    if (end == std::string_view::npos) {
      if (line == 1) return kNoPly;
      if (file.size() == head.size()) return "the header has no end_header";
      return fmt::format("the header exceeds the limit of {} bytes", kLongestHeader);
    }
    const auto words = words_of(head.substr(at, end - at));
    at = end + 1;
    std::string fault;
    if (line == 1) {
      if (words.size() != 1 || words[0] != "ply") return kNoPly;
    } else if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
      continue;
    } else if (words[0] == "format") {
      fault = has_format ? "duplicate format line" : parse_format(words, header);
      has_format = true;
    } else if (words[0] == "element") {
      fault = parse_element(words, line, header);
    } else if (words[0] == "property") {
      fault = parse_property(words, header);
    } else if (words[0] == "end_header") {
      header.bytes = at;
      header.lines = line;
      return has_format ? "" : "the header has no format line";
    } else {
      fault = "unknown keyword in the header";
    }
    if (!fault.empty()) return fault;
  }
}

}  // namespace orrery::rows
