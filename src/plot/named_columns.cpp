// SPDX-License-Identifier: Apache-2.0
#include "plot/named_columns.h"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "data/columns.h"
#include "plot/plot.h"
#include "points/rows.h"

namespace orrery::plot {

std::string outline_column(const PlotOptions& options, const data::FrameInfo& info) {
  const bool is_of_style = options.outline_by.empty() && options.style == Style::kIllustration;
  return is_of_style && data::has_column(info.columns, "chain") ? "chain" : options.outline_by;
}

std::vector<std::string> texts_with_columns(const PlotOptions& options, const data::FrameInfo& info) {
  const scene::PointsKeys& points = options.points;
  std::vector<std::string> out = {options.color_by,     options.center,        options.fit,
                                  points.select,        points.color.column,   points.color.carbon,
                                  points.radius.column, points.opacity.column, outline_column(options, info)};
  for (const auto& list :
       {points.labels, points.opacity.where, points.radius.where, points.color.where, points.representation,
        points.material_where, points.cryptomatte, points.vectors.columns, points.motion.columns})
    out.insert(out.end(), list.begin(), list.end());
  return out;
}

std::vector<std::string> expected_columns(const PlotOptions& options, data::FrameInfo info) {
  points::add_derived_columns(info);
  const data::Roles& roles = info.roles;
  const std::vector<std::string> texts = texts_with_columns(options, info);
  const auto is_named = [&](const std::string& column) {
    return std::any_of(texts.begin(), texts.end(),
                       [&](const std::string& text) { return text.find(column) != std::string::npos; });
  };
  std::vector<std::string> wanted = {roles.id, roles.element, roles.type, roles.radius, roles.chain};
  const auto mentions_residues = [](const std::string& text) {
    return text.find("res") != std::string::npos || text.find("trace") != std::string::npos;
  };
  if (std::any_of(texts.begin(), texts.end(), mentions_residues))
    wanted.insert(wanted.end(), {"name", "chain", "segment", "residue", "residue_number"});
  for (const auto& triple :
       {roles.position, roles.rgb, options.points.unwrap ? roles.image : std::array<std::string, 3>()})
    wanted.insert(wanted.end(), triple.begin(), triple.end());
  if (options.points.motion.frame_time)
    for (const std::string& column : points::velocity_of(info)) wanted.push_back(column);
  for (const data::ColumnInfo& column : info.columns)
    if (column.is_derived && is_named(column.name))
      for (const std::string& source : points::sources_of(info, column.name)) wanted.push_back(source);
  std::vector<std::string> out;
  for (const data::ColumnInfo& column : info.columns)
    if (!column.is_derived && (base::contains(wanted, column.name) || is_named(column.name)))
      out.push_back(column.name);
  return out;
}

void require_utf8(const std::string& text) {
  for (std::size_t at = 0, length = 1; at < text.size(); at += std::max<std::size_t>(length, 1)) {
    length = base::printable_length(text, at);
    if (length == 0 && static_cast<unsigned char>(text[at]) >= 0x80)
      base::refuse(fmt::format("`{}` is not valid UTF-8, and a scene cannot name it; rename the file or the column",
                               base::printable(text)));
  }
}

}  // namespace orrery::plot
