// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

// What commands print: reports as text, of which most rows have a label, and the same as JSON.
namespace orrery::job {

/// Appends a row to a report.
template <class... Values>
void add_row(std::string& report, std::string_view label, fmt::format_string<Values...> format, Values&&... values) {
  report += fmt::format("{:<11} {}\n", label, fmt::format(format, std::forward<Values>(values)...));
}

/// Null for an empty value.
template <class Value>
nlohmann::json json_or_null(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

/// Formats a value as indented JSON with a final newline. Bytes that are not UTF-8, possible in file names, become
/// replacement characters; numbers that are not finite, null.
inline std::string json_text(const nlohmann::json& value) {
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace orrery::job
