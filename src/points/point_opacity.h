// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "data/table.h"
#include "points/selection.h"
#include "scene/scene.h"

namespace orrery::points {

class KeyFaults;
class Rows;

/// An opacity, and the condition under which a sphere has it; empty: always.
struct OpacityRule {
  std::string condition;
  double opacity = 1;
};

/// Parses an element of scene::PointsOpacity::where: a selection, a colon, a number in 0..1; or the number alone. The
/// last colon counts, because selections contain colons, too.
///
/// Errors     base::Error(kUsage): what is wrong with the text, which it names, and the remedy
OpacityRule parse_opacity_rule(const std::string& text);

/// How the opacities of a file's spheres are determined.
struct OpacitySource {
  /// A rule with its condition.
  struct Rule {
    Selection condition;
    float opacity;
  };
  std::string column;               ///< of opacities or of types; empty: none
  std::vector<std::string> needed;  ///< columns to read, of the conditions, too
  std::vector<Rule> rules;

  /// Whether spheres have opacities of their own.
  bool is_set() const { return !column.empty() || !rules.empty(); }
};

/// Determines the source of the opacities. Reports unknown columns, rules that are not valid, and mutually exclusive
/// keys.
OpacitySource opacity_source(const data::FrameInfo& info, const scene::PointsOpacity& opacity, KeyFaults& faults);

/// Returns the opacities of the rows, as scene::Points::opacities. Reports values of a column outside 0..1 in rows that
/// match no rule.
///
/// Domain     a table with the source's columns, and a source that is set
std::vector<float> opacities_of(const data::Table& table, const Rows& rows, const OpacitySource& source,
                                const scene::Points& points, KeyFaults& faults);

}  // namespace orrery::points
