// SPDX-License-Identifier: Apache-2.0
#include "scene/value_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/core.h>

namespace orrery::scene {
namespace {

std::string text_of(std::int64_t value) { return std::to_string(value); }
std::string text_of(double value) { return number_text(value); }
std::string text_of(Vec3d value) { return vector_text(value); }
std::string text_of(const std::string& value) { return string_text(value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const Interval& value) { return interval_text(value); }
std::string text_of(const Window& w) { return fmt::format("[{}, {}, {}, {}]", w.x, w.y, w.width, w.height); }
std::string text_of(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + string_text(word);
  return fmt::format("[{}]", out);
}
template <class T>
std::string text_of(const std::vector<std::pair<std::string, T>>& table) {
  std::string out;
  for (const auto& [key, value] : table)
    out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", key_text(key), text_of(value));
  return out.empty() ? "{}" : fmt::format("{{ {} }}", out);
}

}  // namespace

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
  return fmt::format("[{}, {}, {}]", number_text(v.x), number_text(v.y), number_text(v.z));
}

std::string interval_text(const Interval& interval) {
  return fmt::format("[{}, {}]", number_text(interval.low), number_text(interval.high));
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

std::string key_text(const std::string& name) {
  const bool is_bare = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return is_bare ? name : string_text(name);
}

std::string value_text(const Value& value) {
  return std::visit([](const auto& v) { return text_of(v); }, value);
}

std::string unquoted(const std::string& text) {
  return text.size() >= 2 && text.front() == '"' ? text.substr(1, text.size() - 2) : text;
}

}  // namespace orrery::scene
