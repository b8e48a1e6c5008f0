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

#include "base/text.h"

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

namespace {

/// `next_unit` is the largest one that may follow.
std::string missing_unit(const std::string& text, std::size_t next_unit) {
  if (next_unit == 0) return "`" + text + "` has no unit; write " + text + "s, " + text + "m or " + text + "h";
  return "`" + text + "` has no unit at its end; write " + text + (next_unit == 1 ? "m or " + text + "s" : "s");
}

/// Seconds of "1h30m" and its like: numbers with units, each unit at most once, the largest first.
///
/// Result     what is wrong, or nothing
std::string parse_duration(const std::string& text, double& seconds) {
  constexpr std::string_view kUnits = "hms";
  constexpr double kSeconds[] = {3600, 60, 1};
  const std::string wrong = "must be a time such as 90s, 5m, 1.5h or 1h30m, not `" + text + "`";
  seconds = 0;
  std::size_t next_unit = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find_first_not_of("0123456789.", begin);
    double value = 0;
    if (!parse(text.substr(begin, end - begin), value)) return wrong;
    if (end == std::string::npos) return next_unit < kUnits.size() ? missing_unit(text, next_unit) : wrong;
    const std::size_t unit = kUnits.find(text[end], next_unit);
    if (unit == std::string_view::npos) return wrong;
    seconds += value * kSeconds[unit];
    next_unit = unit + 1;
    begin = end + 1;
  }
  if (text.empty()) return wrong;
  if (seconds < kShortestTime) return "must be at least " + text_of(kShortestTime) + "s, not `" + text + "`";
  if (!(seconds <= kLongestTime)) return "must be at most " + text_of(kLongestTime / 3600) + "h, not `" + text + "`";
  return {};
}

}  // namespace

Check duration() {
  return [](std::string& text) -> std::string {
    double seconds = 0;
    if (std::string wrong = parse_duration(text, seconds); !wrong.empty()) return wrong;
    std::ostringstream out;
    out.precision(17);
    out << seconds;
    text = out.str();
    return {};
  };
}

}  // namespace orrery::cli
