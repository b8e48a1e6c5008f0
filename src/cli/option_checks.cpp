// SPDX-License-Identifier: Apache-2.0
#include "cli/option_checks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"

namespace orrery::cli {
namespace {

/// Parses the whole text, not only its beginning.
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
    const bool is_number = !word.empty() && word[0] >= '0' && word[0] <= '9';  // do not suggest 16 for 12
    const std::string remedy = is_number ? "" : base::did_you_mean(word, names);
    return fmt::format("unknown value `{}`; {}", word, remedy.empty() ? "use one of " + base::joined(names) : remedy);
  };
}

Check whole_number(std::uint64_t from, std::uint64_t to) {
  return [from, to](std::string& text) -> std::string {
    std::uint64_t value = 0;
    if (parse(text, value) && value >= from && value <= to) {
      text = std::to_string(value);  // CLI11 would read 010 as eight
      return {};
    }
    return fmt::format("must be an integer from {} to {}, not `{}`", from, to, text);
  };
}

int integer_of(const std::string& text) {
  int value = 0;
  parse(text, value);
  return value;
}

Check real_number(double from, double to) {
  return [from, to](std::string& text) -> std::string {
    double value = 0;
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
    if (parse(plus ? text.substr(1) : text, value) && value >= from && value <= to) return {};
    return fmt::format("must be a number from {:g} to {:g}, not `{}`", from, to, text);
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
    return fmt::format("must be a size with a unit, e.g. 512M or 1.5G, not `{}`", text);
  };
}

namespace {

/// The message for a number without a unit; `next_unit` is the index of the largest unit that may follow.
std::string missing_unit(const std::string& text, std::size_t next_unit) {
  if (next_unit == 0) return fmt::format("`{0}` has no unit; write {0}s, {0}m or {0}h", text);
  if (next_unit == 1) return fmt::format("`{0}` has no final unit; write {0}m or {0}s", text);
  return fmt::format("`{0}` has no final unit; write {0}s", text);
}

/// Parses times such as "1h30m": numbers with units, each unit at most once, in descending order.
///
/// Result     an error message, or an empty string
std::string parse_duration(const std::string& text, double& seconds) {
  constexpr std::string_view kUnits = "hms";
  constexpr double kSeconds[] = {3600, 60, 1};
  const std::string wrong = fmt::format("must be a time such as 90s, 5m, 1.5h or 1h30m, not `{}`", text);
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
  if (seconds < kShortestTime) return fmt::format("must be at least {:g}s, not `{}`", kShortestTime, text);
  if (!(seconds <= kLongestTime)) return fmt::format("must be at most {:g}h, not `{}`", kLongestTime / 3600, text);
  return {};
}

}  // namespace

Check duration() {
  return [](std::string& text) -> std::string {
    double seconds = 0;
    if (std::string wrong = parse_duration(text, seconds); !wrong.empty()) return wrong;
    text = fmt::format("{:.17g}", seconds);
    return {};
  };
}

}  // namespace orrery::cli
