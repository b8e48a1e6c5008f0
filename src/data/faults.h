// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace orrery::data {

/// Collects the errors in a data file. Only the first ten of many similar ones are kept.
class Faults {
 public:
  explicit Faults(const std::filesystem::path& file) : file_(file.string()) {}

  /// Adds an error.
  ///
  /// `line`     1-based; 0: a binary file, or the whole file
  void add(std::uint64_t line, const std::string& text, const std::string& remedy = {});
  /// Adds one of possibly millions of errors.
  void add_of_many(std::uint64_t line, const std::string& text);
  /// Adds an error and throws it together with the earlier ones.
  [[noreturn]] void fail(std::uint64_t line, const std::string& text, const std::string& remedy = {});
  bool has_any() const { return many_ > 0 || !diagnostics_.empty(); }
  /// Removes the errors. Returns the first one, with its line and the number of the others.
  std::string take_text();
  /// Throws base::Error(kBadData), "cannot use FILE", if there are errors.
  void raise_if_any();

 private:
  /// Errors of one kind that are listed; the others are counted.
  static constexpr std::uint64_t kMaxListed = 10;

  [[noreturn]] void raise();

  std::string file_;
  std::vector<base::Diagnostic> diagnostics_;
  std::uint64_t many_ = 0;
};

/// Quotes a word of a file for a message; a long one is truncated: `word`.
inline std::string quoted_word(std::string_view word) {
  constexpr std::size_t kLongestShown = 40;
  return "`" + std::string(word.substr(0, kLongestShown)) + (word.size() > kLongestShown ? "..." : "") + "`";
}

}  // namespace orrery::data
