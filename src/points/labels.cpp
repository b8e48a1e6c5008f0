// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include "base/error.h"
#include "data/text_lines.h"
#include "math/scalar.h"
#include "math/vec3.h"
#include "points/copies.h"
#include "points/sources.h"

namespace orrery::points {

namespace {

/// Splits "CONDITION: TEXT".
std::pair<std::string, std::string> parse_label(const std::string& text) {
  const std::size_t colon = end_of_expression(text);
  const std::string_view label =
      colon == std::string::npos ? std::string_view() : data::trimmed(std::string_view(text).substr(colon + 1));
  if (colon == 0 || label.empty())
    base::refuse(fmt::format("`{}` is not a label; write CONDITION: TEXT, e.g. 'id == 5: Fe'", text));
  return {text.substr(0, colon), std::string(label)};
}

}  // namespace

std::size_t end_of_expression(std::string_view text) {
  constexpr std::string_view kQuotes = "\"'`", kOpening = "[{(", kClosing = "]})";
  int depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == ':' && depth <= 0) return at;
    if (kOpening.find(text[at]) != std::string_view::npos) ++depth;
    if (kClosing.find(text[at]) != std::string_view::npos) --depth;
    if (kQuotes.find(text[at]) != std::string_view::npos) at = std::min(text.find(text[at], at + 1), text.size());
  }
  return std::string_view::npos;
}

std::vector<LabelRule> label_rules(const data::FrameInfo& info, const scene::PointsKeys& points, KeyFaults& faults) {
  std::vector<LabelRule> out;
  for (std::size_t i = 0; i < points.labels.size(); ++i) {
    const std::string key = fmt::format(".labels[{}]", i);
    try {
      const auto [condition, text] = parse_label(points.labels[i]);
      out.push_back({parse_selection(condition, info.columns), text});
    } catch (const base::Error& error) {
      faults.error(key, fault_text(error));
    }
  }
  return out;
}

std::vector<scene::Label> placed_labels(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                                        const std::vector<LabelRule>& rules, const Copy& first,
                                        const scene::PointsKeys& points, KeyFaults& faults) {
  std::vector<scene::Label> out;
  const data::Transform placement = transform_of(points.transform);
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const std::vector<std::uint8_t> mask = rules[r].condition.evaluate(table);
    data::Vec3d low{math::kInfinity, math::kInfinity, math::kInfinity}, high = low * -1.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (mask[rows[i]] == 0) continue;
      const data::Vec3d c = centers[i];
      low = math::least(low, c);
      high = math::greatest(high, c);
    }
    if (low.x <= high.x)
      out.push_back({applied(placement, applied(first.transform, (low + high) * 0.5)), rules[r].text});
    else
      faults.warning(fmt::format(".labels[{}]", r),
                     fmt::format("`{}` matches none of the particles that are drawn", points.labels[r]));
  }
  return out;
}

}  // namespace orrery::points
