// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orrery::arrays {

/// A value of Python's syntax, as NumPy writes it in the header of an array.
struct PythonLiteral {
  enum class Kind { kText, kInteger, kBool, kSequence, kDict };

  Kind kind = Kind::kText;
  std::string text;
  std::uint64_t integer = 0;         ///< for a kBool, 0 or 1
  std::vector<PythonLiteral> items;  ///< elements of a list or tuple; keys and values of a dict alternate

  bool is(Kind k) const { return kind == k; }
  /// Returns the value of a key of a dict; null if there is none.
  const PythonLiteral* find(std::string_view key) const;
};

/// Parses strings, non-negative integers, True, False, lists, tuples and dicts, up to 16 levels deep.
///
/// Result     an empty string, or what is wrong
std::string parse_python_literal(std::string_view source, PythonLiteral& out);

}  // namespace orrery::arrays
