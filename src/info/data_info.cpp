// SPDX-License-Identifier: Apache-2.0
#include "info/data_info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "formats/open.h"
#include "points/derived.h"

namespace orrery::info {
namespace {

/// Fallback if the available memory is unknown: that of a small machine.
constexpr std::uint64_t kUnknownMemory = std::uint64_t{4} << 30;

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

}  // namespace

DataInfo data_info(const DataInfoRequest& request) {
  data::OpenOptions options;
  options.component = request.component;
  options.limit_memory(base::available_memory().value_or(0));
  const std::unique_ptr<data::DataFile> file = formats::open(request.file, options);
  DataInfo info;
  info.file = request.file;
  info.format = file->format;
  info.frames = file->frame_count();
  info.frame = request.frame;
  if (request.frame < 1 || request.frame > info.frames)
    throw base::Error(base::ErrorKind::kUsage,
                      fmt::format("--frame {}: {} has {}{}", request.frame, request.file.string(), info.frames,
                                  info.frames == 1 ? " frame" : " frames"));
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

}  // namespace orrery::info
