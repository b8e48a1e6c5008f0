// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace orrery::image {

/// One raw attribute of an EXR file.
struct ExrAttribute {
  std::string type;
  std::string bytes;

  /// The value as an array of numbers.
  template <class Number>
  std::vector<Number> numbers() const {
    std::vector<Number> out(bytes.size() / sizeof(Number));
    std::memcpy(out.data(), bytes.data(), out.size() * sizeof(Number));
    return out;
  }
};

/// Parses the header of a single-part EXR file by the file format itself. OpenImageIO would translate the names back.
inline std::map<std::string, ExrAttribute> exr_header(const std::string& file) {
  std::map<std::string, ExrAttribute> out;
  std::size_t at = 8;  // magic number, version and flags
  const auto text = [&] {
    const std::string word(file.c_str() + at);
    at += word.size() + 1;
    return word;
  };
  while (at < file.size() && file[at] != '\0') {
    const std::string name = text();
    ExrAttribute attribute;
    attribute.type = text();
    std::int32_t size = 0;
    std::memcpy(&size, file.data() + at, sizeof(size));
    at += sizeof(size);
    attribute.bytes = file.substr(at, static_cast<std::size_t>(size));
    at += static_cast<std::size_t>(size);
    out[name] = attribute;
  }
  return out;
}

}  // namespace orrery::image
