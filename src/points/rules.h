// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "points/rows.h"
#include "points/selection.h"

/// Values by condition: "type == 2: 0.3". All keys and options with conditions are lists of these rules, of which the
/// last that matches a particle decides.
namespace orrery::points {

/// The colon that ends an expression.
enum class Colon { kFirst, kLast };

/// Returns the place of the colon that ends an expression: the first one outside quotes, brackets and braces, which
/// contain ranges and strings; npos if there is none.
///
/// `which`    kLast: the last such one, before a value that has no colon: `id 2:5: 0.3`
std::size_t end_of_expression(std::string_view text, Colon which = Colon::kFirst);

/// Splits "CONDITION: VALUE" into both parts, without spaces around them. "VALUE" alone has no condition.
///
/// Errors     base::Error(kUsage) for an empty condition
std::pair<std::string, std::string> split_rule(const std::string& text, Colon which = Colon::kLast);

/// An opacity.
///
/// Errors     base::Error(kUsage) unless it is a number in 0..1
float parse_opacity(const std::string& text);

/// A radius.
///
/// Errors     base::Error(kUsage) unless it is a number above 0
double parse_radius(const std::string& text);

/// How particles are represented.
enum class Representation : std::uint8_t {
  kSpheres,
  kBallAndStick,  ///< small spheres, and bonds
  kSticks,        ///< bonds, and spheres of their radius
  kTrace,         ///< rods along the C-alpha or phosphorus atoms of a chain
  kPoints,        ///< spheres as small as bonds
};

/// The index of a name in a list.
///
/// `kind`     what the names are, "a material"
/// Errors     base::Error(kUsage)
std::uint32_t index_of_name(const std::string& name, const std::vector<std::string>& names, const char* kind);

/// Names of the representations, in the order of the enumerators.
const std::vector<std::string>& representation_names();

/// The representation with a name.
///
/// Errors     base::Error(kUsage)
Representation parse_representation(const std::string& name);

/// A value, and the condition under which a particle has it.
template <class T>
struct Rule {
  Selection condition;
  T value;
};

/// The key of a rule in a list: ".opacity.where[2]".
inline std::string rule_key(const char* key, std::size_t index) { return key + ("[" + std::to_string(index) + "]"); }

/// Parses rules. Reports those that are not valid.
///
/// `key`      of the list, ".opacity.where"
/// `parse`    value of a text; throws base::Error
/// `which`    kFirst: values may have colons, and conditions are needed
template <class Parse, class T = std::invoke_result_t<Parse, const std::string&>>
std::vector<Rule<T>> rules_of(const data::FrameInfo& info, const std::vector<std::string>& texts, const char* key,
                              const Parse& parse, KeyFaults& faults, Colon which = Colon::kLast) {
  std::vector<Rule<T>> out;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    try {
      const auto [condition, value] = split_rule(texts[i], which);
      if (condition.empty() && which == Colon::kFirst)
        base::refuse("`" + texts[i] + "` has no condition; write CONDITION: VALUE");
      out.push_back({parse_selection(condition, info.columns, info.roles.position), parse(value)});
    } catch (const base::Error& error) {
      faults.error(rule_key(key, i), fault_text(error));
    }
  }
  return out;
}

/// Calls `set(i, value)` for the rows that match rules, in the order of the rules. Reports rules that match none.
///
/// `texts`, `key`   as rules_of() takes them
template <class T, class F>
void apply_rules(const data::Table& table, const Rows& rows, const std::vector<Rule<T>>& rules,
                 const std::vector<std::string>& texts, const char* key, KeyFaults& faults, F set) {
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const std::vector<std::uint8_t> mask = rules[r].condition.evaluate(table);
    bool matches = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (mask[rows[i]] == 0) continue;
      matches = true;
      set(i, rules[r].value);
    }
    if (!matches && rows.size() > 0)
      faults.warning(rule_key(key, r), "`" + texts[r] + "` matches none of the particles that are drawn");
  }
}

}  // namespace orrery::points
