// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "data/table.h"
#include "points/selection.h"
#include "scene/scene.h"

namespace orrery::points {

struct Copy;
class KeyFaults;
class Rows;

/// A label of a points table, and the condition on the particles that it labels.
struct LabelRule {
  Selection condition;
  std::string text;
};

/// Splits "CONDITION: TEXT" at the first colon that a space follows: ranges in conditions contain colons, too.
///
/// Errors     base::Error(kUsage)
std::pair<std::string, std::string> parse_label(const std::string& text);

/// Parses scene::Points::labels. Reports those that are not valid.
std::vector<LabelRule> label_rules(const data::FrameInfo& info, const scene::Points& points, KeyFaults& faults);

/// Places each label at the middle of the selected rows that match. Reports labels that match none, and omits them.
///
/// `first`    the first copy of the particles
/// Domain     `centers` are those of the rows
std::vector<scene::Label> placed_labels(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                                        const std::vector<LabelRule>& rules, const Copy& first,
                                        const scene::Points& points, KeyFaults& faults);

}  // namespace orrery::points
