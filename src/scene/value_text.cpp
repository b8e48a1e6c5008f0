// SPDX-License-Identifier: Apache-2.0
#include "scene/value_text.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace orrery::scene {

std::string number_text(double value) {
  if (value == 0 && std::signbit(value)) return "-0.0";  // TOML reads "-0" as the integer 0, which has no sign
  char buffer[32];
  // Above this, the shortest text may have only digits, which TOML reads as a 64-bit integer.
  constexpr double kLongestDigits = 1e15;
  const auto end = std::abs(value) < kLongestDigits
                       ? std::to_chars(buffer, buffer + sizeof(buffer), value).ptr
                       : std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::scientific).ptr;
  return {buffer, end};
}

std::string vector_text(math::Vec3d v) {
  std::string out = "[";
  out.append(number_text(v.x)).append(", ").append(number_text(v.y)).append(", ").append(number_text(v.z));
  return out.append("]");
}

std::string string_text(const std::string& value) {
  std::string out = "\"";
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\u%04x", byte);
      out += escape;
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string list_text(const std::vector<std::string>& values) {
  std::string out = "[";
  for (const std::string& value : values) out += (out.size() > 1 ? ", " : "") + string_text(value);
  return out + "]";
}

std::string unquoted(const std::string& text) {
  return text.size() >= 2 && text.front() == '"' ? text.substr(1, text.size() - 2) : text;
}

}  // namespace orrery::scene
