// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "base/file_name.h"
#include "base/text.h"
#include "info/data_info.h"
#include "job/statistics.h"
#include "points/derived.h"

namespace orrery::info {
namespace {

/// Maximum lengths of strings from a file, bytes; longer ones are shortened.
constexpr std::size_t kLongestText = 32;
constexpr std::size_t kLongestTitle = 200;
/// Number of assemblies that are printed as text.
constexpr std::size_t kMaxAssemblies = 8;

std::string shortened(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return base::printable(text);
  return base::printable(base::utf8_prefix(text, bytes)) + "...";
}

std::string number_text(double value) {
  std::string out;
  base::append(out, "%.10g", value);
  return out;
}

std::string number_text(const std::optional<ColumnSummary::Number>& number, data::ColumnType type) {
  if (!number) return "-";
  if (const auto* const integer = std::get_if<std::int64_t>(&*number)) return std::to_string(*integer);
  std::string out;
  base::append(out, type == data::ColumnType::kFloat32 ? "%.7g" : "%.10g", std::get<double>(*number));
  return out;
}

std::string vector_text(const data::Vec3d& v) {
  return fmt::format("({}, {}, {})", number_text(v.x), number_text(v.y), number_text(v.z));
}

std::string box_text(const data::Box& box) {
  std::vector<std::string> periodic;
  for (std::size_t i = 0; i < box.periodic.size(); ++i)
    if (box.periodic[i]) periodic.emplace_back(1, "abc"[i]);
  return fmt::format("origin {}, edges a {}, b {}, c {}{}", vector_text(box.origin), vector_text(box.edges[0]),
                     vector_text(box.edges[1]), vector_text(box.edges[2]),
                     periodic.empty() ? ", not periodic" : ", periodic along " + base::joined(periodic));
}

std::size_t copies_of(const data::Assembly& assembly) {
  std::size_t copies = 0;
  for (const data::AssemblyPart& part : assembly.parts) copies += part.transforms.size();
  return copies;
}

std::string assemblies_text(const std::vector<data::Assembly>& assemblies) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min(assemblies.size(), kMaxAssemblies); ++i) {
    const std::size_t copies = copies_of(assemblies[i]);
    out.push_back(fmt::format("{} ({}{}", assemblies[i].name, copies, copies == 1 ? " copy)" : " copies)"));
  }
  if (assemblies.size() > kMaxAssemblies) out.push_back(fmt::format("{} more", assemblies.size() - kMaxAssemblies));
  return base::joined(out);
}

std::vector<std::string> list_of(const std::array<std::string, 3>& names) { return {names.begin(), names.end()}; }

std::string roles_text(const data::Roles& roles) {
  std::string out = "position " + base::joined(list_of(roles.position));
  const auto add = [&](const char* role, const std::string& column) {
    if (!column.empty()) out += fmt::format("; {} {}", role, column);
  };
  add("radius", roles.radius.empty() || roles.radius_scale == 1
                    ? roles.radius
                    : fmt::format("{} times {}", roles.radius, number_text(roles.radius_scale)));
  add("element", roles.element);
  add("type", roles.type);
  add("id", roles.id);
  add("chain", roles.chain);
  if (!roles.rgb[0].empty())
    add("rgb", fmt::format("{} (0 to {})", base::joined(list_of(roles.rgb)), number_text(roles.rgb_maximum)));
  if (!roles.image[0].empty()) add("image", base::joined(list_of(roles.image)));
  return out;
}

std::string texts_text(const ColumnSummary& summary) {
  std::vector<std::string> texts;
  for (const std::string& text : summary.texts) texts.push_back(text.empty() ? "\"\"" : shortened(text, kLongestText));
  return fmt::format("{} distinct: {}{}", summary.distinct, base::joined(texts),
                     summary.distinct > summary.texts.size() ? ", ..." : "");
}

/// A table of the columns; every line is indented.
std::string columns_text(const std::vector<ColumnSummary>& columns) {
  using Row = std::array<std::string, 5>;
  std::vector<Row> rows = {{"name", "type", "minimum", "maximum", "NaN"}};
  for (const ColumnSummary& c : columns) {
    const std::string name = shortened(c.column.name, kLongestText);
    if (c.column.type == data::ColumnType::kText)
      rows.push_back({name, data::type_name(c.column.type), texts_text(c), "", ""});
    else
      rows.push_back(
          {name, data::type_name(c.column.type), number_text(c.minimum, c.column.type),
           number_text(c.maximum, c.column.type),
           std::to_string(c.nan_count) + (c.infinite_count > 0 ? fmt::format(", {} infinite", c.infinite_count) : "")});
  }
  std::array<std::size_t, 4> widths{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < widths.size(); ++i)
      if (i < 2 || !row.back().empty()) widths[i] = std::max(widths[i], row[i].size());
  std::string out;
  for (const Row& row : rows) {
    std::string line = out.empty() ? "columns     " : "            ";
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] +
              (i < widths.size() && row[i].size() <= widths[i] ? std::string(widths[i] - row[i].size() + 2, ' ') : "");
    out += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return out;
}

nlohmann::json json_of(const data::Vec3d& v) { return {v.x, v.y, v.z}; }

nlohmann::json json_of(const std::optional<ColumnSummary::Number>& number) {
  if (!number) return nullptr;
  return std::visit([](auto value) { return nlohmann::json(value); }, *number);
}

nlohmann::json json_or_null(const std::string& name) { return name.empty() ? nlohmann::json() : nlohmann::json(name); }
nlohmann::json json_or_null(const std::array<std::string, 3>& names) {
  return names[0].empty() ? nlohmann::json() : nlohmann::json(names);
}

nlohmann::json json_of(const data::Roles& roles) {
  using nlohmann::json;
  json out = {{"position", roles.position},
              {"radius", nullptr},
              {"element", json_or_null(roles.element)},
              {"type", json_or_null(roles.type)},
              {"id", json_or_null(roles.id)},
              {"chain", json_or_null(roles.chain)},
              {"rgb", nullptr},
              {"image", json_or_null(roles.image)}};
  if (!roles.radius.empty()) out["radius"] = {{"column", roles.radius}, {"scale", roles.radius_scale}};
  if (!roles.rgb[0].empty()) out["rgb"] = {{"columns", roles.rgb}, {"maximum", roles.rgb_maximum}};
  return out;
}

nlohmann::json json_of(const ColumnSummary& summary) {
  nlohmann::json out = {{"name", summary.column.name}, {"type", data::type_name(summary.column.type)}};
  if (summary.column.type == data::ColumnType::kText) {
    out["distinct"] = summary.distinct;
    out["values"] = summary.texts;
  } else {
    out["minimum"] = json_of(summary.minimum);
    out["maximum"] = json_of(summary.maximum);
    out["nan"] = summary.nan_count;
    out["infinite"] = summary.infinite_count;
  }
  return out;
}

}  // namespace

std::string data_info_text(const DataInfo& info) {
  const data::FrameInfo& frame = info.described;
  std::string out = fmt::format("file        {}\nformat      {}\nframe       {} of {}",
                                base::printable(info.file.string()), info.format, info.frame, info.frames);
  if (frame.step) out += ", step " + number_text(*frame.step);
  out += '\n';
  if (!frame.title.empty()) out += fmt::format("title       {}\n", shortened(frame.title, kLongestTitle));
  out += fmt::format("rows        {}\n", frame.rows);
  if (frame.box) out += fmt::format("box         {}\n", box_text(*frame.box));
  if (!frame.assemblies.empty())
    out += fmt::format("assemblies  {}\n", base::printable(assemblies_text(frame.assemblies)));
  out += fmt::format("roles       {}\n", base::printable(roles_text(frame.roles)));
  for (const data::ColumnInfo& column : frame.columns)
    if (column.is_derived)
      out += fmt::format("computed    {}\n", base::printable(column.name + ", from " +
                                                             base::joined(points::sources_of(frame, column.name))));
  return out + columns_text(info.columns);
}

std::string data_info_json(const DataInfo& info) {
  using nlohmann::json;
  const data::FrameInfo& frame = info.described;
  json assemblies = json::array(), columns = json::array(), computed = json::array(), box;
  for (const data::Assembly& a : frame.assemblies) assemblies.push_back({{"name", a.name}, {"copies", copies_of(a)}});
  for (const ColumnSummary& c : info.columns) columns.push_back(json_of(c));
  for (const data::ColumnInfo& c : frame.columns)
    if (c.is_derived) computed.push_back({{"name", c.name}, {"columns", points::sources_of(frame, c.name)}});
  if (frame.box)
    box = {{"origin", json_of(frame.box->origin)},
           {"edges", {json_of(frame.box->edges[0]), json_of(frame.box->edges[1]), json_of(frame.box->edges[2])}},
           {"periodic", frame.box->periodic}};
  return job::json_text({{"schema", "orrery.data/1"},
                         {"file", info.file.string()},
                         {"format", info.format},
                         {"frames", info.frames},
                         {"frame", info.frame},
                         {"step", frame.step ? json(*frame.step) : json()},
                         {"title", frame.title},
                         {"rows", frame.rows},
                         {"box", box},
                         {"assemblies", assemblies},
                         {"roles", json_of(frame.roles)},
                         {"computed", computed},
                         {"columns", columns}});
}

}  // namespace orrery::info
