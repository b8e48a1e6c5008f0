// SPDX-License-Identifier: Apache-2.0
#include "cli/option_checks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <cstdio>
#include <functional>
#include <string_view>
#include <utility>

#include "base/suggestion.h"

namespace orrery::cli {
namespace {

std::string text_of(double value) {
  char out[32];
  std::snprintf(out, sizeof(out), "%g", value);
  return out;
}

/// All of the text, not only how it begins.
template <class Number>
bool parse(const std::string& text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stopped == end;
}

}  // namespace

Check one_of(std::vector<std::string> names) {
  return [names = std::move(names)](std::string& word) -> std::string {
    if (std::find(names.begin(), names.end(), word) != names.end()) return {};
    const bool is_number = !word.empty() && word[0] >= '0' && word[0] <= '9';  // 12 is not meant to be 16
    const std::string remedy = is_number ? "" : base::did_you_mean(word, names);
    return "there is no `" + word + "`; " + (remedy.empty() ? "there are " + base::joined(names) : remedy);
  };
}

Check whole_number(std::uint64_t from, std::uint64_t to) {
  return [from, to](std::string& text) -> std::string {
    std::uint64_t value = 0;
    if (parse(text, value) && value >= from && value <= to) {
      text = std::to_string(value);  // the library would take 010 for eight
      return {};
    }
    return "must be a whole number from " + std::to_string(from) + " to " + std::to_string(to) + ", not `" + text + "`";
  };
}

Check real_number(double from, double to) {
  return [from, to](std::string& text) -> std::string {
    double value = 0;
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
    if (parse(plus ? text.substr(1) : text, value) && value >= from && value <= to) return {};
    return "must be a number from " + text_of(from) + " to " + text_of(to) + ", not `" + text + "`";
  };
}

Check byte_size() {
  return [](std::string& text) -> std::string {
    constexpr std::string_view kUnits = "KMGT";
    const std::size_t unit = text.empty() ? std::string::npos : kUnits.find(text.back());
    double value = 0;
    if (unit != std::string::npos && parse(text.substr(0, text.size() - 1), value)) {
      value = std::ldexp(value, 10 * (static_cast<int>(unit) + 1));
      if (value >= 1 && value < 0x1p63) {
        text = std::to_string(static_cast<std::uint64_t>(value));
        return {};
      }
    }
    return "must be a size with its unit, as 512M or 1.5G, not `" + text + "`";
  };
}

Check duration() {
  return [](std::string& text) -> std::string {
    constexpr std::string_view kUnits = "smh";
    const std::size_t unit = text.empty() ? std::string::npos : kUnits.find(text.back());
    double value = 0;
    if (unit != std::string::npos && parse(text.substr(0, text.size() - 1), value)) {
      value *= unit == 0 ? 1 : unit == 1 ? 60 : 3600;
      if (value >= 0.01 && value <= kLongestTime) {
        std::ostringstream seconds;
        seconds.precision(17);
        seconds << value;
        text = seconds.str();
        return {};
      }
    }
    return "must be a time with its unit, as 90s, 5m or 1.5h, not `" + text + "`";
  };
}

}  // namespace orrery::cli
