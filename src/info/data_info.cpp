// SPDX-License-Identifier: Apache-2.0
#include "info/data_info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/text.h"
#include "data/data_file.h"
#include "job/report_text.h"
#include "points/color_map.h"
#include "points/rows.h"

namespace orrery::info {
namespace {

using nlohmann::json;

/// Fallback if the available memory is unknown: that of a small machine.
constexpr std::uint64_t kUnknownMemory = std::uint64_t{4} << 30;

/// Maximum lengths of strings from a file, bytes; longer ones are shortened.
constexpr std::size_t kLongestText = 32;
constexpr std::size_t kLongestTitle = 200;
/// Number of assemblies that are printed as text.
constexpr std::size_t kMaxAssemblies = 8;

void summarize(const data::Words& words, ColumnSummary& out) {
  std::vector<std::uint8_t> occurs(words.words.size());
  for (const std::uint32_t index : words.index) {
    if (occurs[index] != 0) continue;
    occurs[index] = 1;
    ++out.distinct;
    if (out.texts.size() < ColumnSummary::kMaxTexts) out.texts.push_back(words.words[index]);
  }
}

template <class Numbers>
void summarize(const Numbers& values, ColumnSummary& out) {
  using T = std::decay_t<decltype(values[0])>;
  using Wide = std::conditional_t<std::is_floating_point_v<T>, double, std::int64_t>;
  std::optional<std::pair<T, T>> range;
  for (std::size_t row = 0; row < values.size(); ++row) {
    const T value = values[row];
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) {
        ++(std::isnan(value) ? out.nan_count : out.infinite_count);
        continue;
      }
    }
    if (!range) range = {value, value};
    range->first = std::min(range->first, value);
    range->second = std::max(range->second, value);
  }
  if (!range) return;
  out.minimum = static_cast<Wide>(range->first);
  out.maximum = static_cast<Wide>(range->second);
}

/// Reads columns and adds their summaries.
void add_summaries(data::DataFile& file, int frame, const std::vector<std::string>& names,
                   std::vector<ColumnSummary>& out) {
  const data::Table table = file.read(frame, names);
  for (ColumnSummary& summary : out)
    if (std::find(names.begin(), names.end(), summary.column.name) != names.end())
      if (const data::Column* const column = table.find(summary.column.name); column != nullptr)
        std::visit([&](const auto& values) { summarize(values, summary); }, column->values);
}

std::string shortened(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return base::printable(text);
  return base::printable(base::utf8_prefix(text, bytes)) + "...";
}

std::string number_text(double value) { return fmt::format("{:.10g}", value); }

std::string number_text(const std::optional<ColumnSummary::Number>& number, data::ColumnType type) {
  if (!number) return "-";
  if (const auto* const integer = std::get_if<std::int64_t>(&*number)) return std::to_string(*integer);
  return fmt::format("{:.{}g}", std::get<double>(*number), type == data::ColumnType::kFloat32 ? 7 : 10);
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
    out.push_back(fmt::format("{} ({} {})", assemblies[i].name, copies, copies == 1 ? "copy" : "copies"));
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

json json_of(const data::Vec3d& v) { return {v.x, v.y, v.z}; }

json json_of(const std::optional<ColumnSummary::Number>& number) {
  if (!number) return nullptr;
  return std::visit([](auto value) { return json(value); }, *number);
}

json json_or_null(const std::string& name) { return name.empty() ? json() : json(name); }
json json_or_null(const std::array<std::string, 3>& names) { return names[0].empty() ? json() : json(names); }

json json_of(const data::Roles& roles) {
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

json json_of(const ColumnSummary& summary) {
  json out = {{"name", summary.column.name}, {"type", data::type_name(summary.column.type)}};
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

/// Opens a file that has the requested frame.
std::unique_ptr<data::DataFile> opened(const DataInfoRequest& request) {
  data::OpenOptions options;
  options.component = request.component;
  options.topology = request.topology;
  options.limit_memory(base::available_memory().value_or(0));
  std::unique_ptr<data::DataFile> file = data::open(request.file, options);
  if (request.frame < 1 || !file->has_frame(request.frame - 1))
    base::refuse(fmt::format("--frame {}: {} has {}", request.frame, request.file.string(),
                             base::counted(static_cast<std::uint64_t>(file->frame_count()), "frame")));
  return file;
}

/// The most frequent values, and their numbers.
json classes_of(std::vector<std::pair<std::string, std::uint64_t>> out) {
  constexpr std::size_t kMostClasses = 200;
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  out.resize(std::min(out.size(), kMostClasses));
  return out;
}

/// Adds what column_values_json() tells of a column of text.
void add_values(const data::Words& words, json& out) {
  std::vector<std::pair<std::string, std::uint64_t>> counts;
  for (const std::string& word : words.words) counts.emplace_back(word, 0);
  for (const std::uint32_t index : words.index) ++counts[index].second;
  out["distinct"] = counts.size();
  out["classes"] = classes_of(std::move(counts));
}

/// Adds what column_values_json() tells of a column of numbers.
void add_values(const data::Column& column, std::size_t rows, bool is_log, json& out) {
  constexpr std::size_t kBins = 64, kMostDistinct = 1000;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::uint64_t nan_count = 0;
  std::map<double, std::uint64_t> counts;
  const auto is_shown = [is_log](double v) { return std::isfinite(v) && (v > 0 || !is_log); };
  points::for_each_number(column, points::Rows(rows), [&](std::size_t, double v) {
    nan_count += std::isnan(v) ? 1 : 0;
    if (counts.size() <= kMostDistinct && std::isfinite(v)) ++counts[v];
    if (!is_shown(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  });
  out["nan"] = nan_count;
  if (low > high) return;
  std::vector<std::uint64_t> bins(kBins);
  const points::ValueScale scale(low, high, is_log);
  points::for_each_number(column, points::Rows(rows), [&](std::size_t, double v) {
    if (is_shown(v)) ++bins[std::min(static_cast<std::size_t>(scale.share_of(v) * kBins), kBins - 1)];
  });
  out.update({{"low", low}, {"high", high}, {"bins", bins}});
  if (counts.size() > kMostDistinct) return;
  std::vector<std::pair<std::string, std::uint64_t>> texts;
  for (const auto& [value, count] : counts) texts.emplace_back(fmt::format("{}", value), count);
  out["distinct"] = texts.size();
  out["classes"] = classes_of(std::move(texts));
}

}  // namespace

std::string column_values_json(const DataInfoRequest& request, const std::string& column, bool is_log) {
  const std::unique_ptr<data::DataFile> file = opened(request);
  data::FrameInfo described = file->describe(request.frame - 1);
  points::add_derived_columns(described);
  const data::ColumnInfo* const known = data::find_named(described.columns, column);
  if (known == nullptr) base::refuse(fmt::format("{} has no column `{}`", request.file.string(), column));
  const std::vector<std::string> sources =
      known->is_derived ? points::sources_of(described, column) : std::vector{column};
  data::Table table = file->read(request.frame - 1, sources);
  if (known->is_derived) points::compute_speed(sources, table);
  json out = {{"name", column}};
  if (const auto* const words = std::get_if<data::Words>(&table.find(column)->values))
    add_values(*words, out);
  else
    add_values(*table.find(column), table.rows, is_log, out);
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

DataInfo data_info(const DataInfoRequest& request) {
  const std::unique_ptr<data::DataFile> file = opened(request);
  DataInfo info;
  info.file = request.file;
  info.format = file->format;
  info.frames = file->frame_count();
  info.frame = request.frame;
  info.described = file->describe(request.frame - 1);
  for (const data::ColumnInfo& column : info.described.columns) info.columns.push_back({column});
  points::add_derived_columns(info.described);
  const std::uint64_t limit =
      request.table_bytes > 0 ? request.table_bytes : base::available_memory().value_or(kUnknownMemory) / 4;
  std::vector<std::string> names;
  std::uint64_t bytes = 0;
  const auto read = [&] {
    if (!names.empty()) add_summaries(*file, request.frame - 1, names, info.columns);
    names.clear();
    bytes = 0;
  };
  for (std::size_t i = 0; i < info.columns.size(); ++i) {
    const data::ColumnInfo& column = info.columns[i].column;
    const std::uint64_t more = info.described.rows * bytes_per_value(column.type);
    if (bytes + more > limit) read();
    names.push_back(column.name);
    bytes += more;
  }
  read();
  return info;
}

std::string data_info_text(const DataInfo& info) {
  using base::printable;
  using job::add_row;
  const data::FrameInfo& frame = info.described;
  std::string out;
  add_row(out, "file", "{}", printable(info.file.string()));
  add_row(out, "format", "{}", info.format);
  add_row(out, "frame", "{} of {}{}", info.frame, info.frames, frame.step ? ", step " + number_text(*frame.step) : "");
  if (!frame.title.empty()) add_row(out, "title", "{}", shortened(frame.title, kLongestTitle));
  add_row(out, "rows", "{}", frame.rows);
  if (frame.box) add_row(out, "box", "{}", box_text(*frame.box));
  if (!frame.assemblies.empty()) add_row(out, "assemblies", "{}", printable(assemblies_text(frame.assemblies)));
  add_row(out, "roles", "{}", printable(roles_text(frame.roles)));
  for (const std::string& warning : frame.warnings) add_row(out, "warning", "{}", printable(warning));
  for (const data::ColumnInfo& column : frame.columns)
    if (column.is_derived)
      add_row(out, "computed", "{}",
              printable(column.name + ", from " + base::joined(points::sources_of(frame, column.name))));
  return out + columns_text(info.columns);
}

std::string data_info_json(const DataInfo& info) {
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
                         {"step", job::json_or_null(frame.step)},
                         {"title", frame.title},
                         {"rows", frame.rows},
                         {"warnings", frame.warnings},
                         {"box", box},
                         {"assemblies", assemblies},
                         {"roles", json_of(frame.roles)},
                         {"computed", computed},
                         {"columns", columns}});
}

}  // namespace orrery::info
