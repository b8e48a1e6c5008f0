// SPDX-License-Identifier: Apache-2.0
#include "rows/csv_shape.h"

#include <algorithm>
#include <array>

#include "data/byte_source.h"
#include "data/customary.h"
#include "data/text_cursor.h"
#include "data/text_lines.h"
#include "data/text_rows.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// Maximum number of rows and bytes to examine: lines may be long.
constexpr std::size_t kSampleRows = 1000;
constexpr std::uint64_t kSampleBytes = std::uint64_t{4} << 20;

struct Line {
  std::string text;
  std::uint64_t offset = 0, end = 0, number = 0;
};

struct Sample {
  std::string comment;      ///< the last one, without its sign
  std::vector<Line> lines;  ///< lines that are neither comments nor blank
};

Sample read_sample(const ByteSource& bytes) {
  TextCursor cursor(bytes);
  Sample sample;
  std::uint64_t begin = 0;
  for (Line line; sample.lines.size() <= kSampleRows; line.text.clear()) {
    line.offset = cursor.offset();
    line.number = cursor.line();
    if (!sample.lines.empty() && line.offset > begin + kSampleBytes) break;
    if (!cursor.next(line.text)) break;
    line.end = cursor.offset();
    const std::string_view text = trimmed(line.text);
    if (text.empty()) continue;
    // Above the rows, names may follow the comment sign immediately; CloudCompare writes two slashes.
    if (sample.lines.empty() && (text[0] == '#' || text[0] == '%' || text.starts_with("//"))) {
      sample.comment = trimmed(text.substr(std::min(text.find_first_not_of("#%/"), text.size())));
      continue;
    }
    if (is_comment(line.text.c_str())) continue;
    if (sample.lines.empty()) begin = line.offset;
    sample.lines.push_back(line);
  }
  return sample;
}

bool divides_equally(const std::vector<Line>& lines, char separator) {
  const std::size_t count = split_row(lines[0].text, separator).size();
  return count > 1 && std::all_of(lines.begin(), lines.end(),
                                  [&](const Line& line) { return split_row(line.text, separator).size() == count; });
}

char separator_of(const std::vector<Line>& lines) {
  constexpr std::array<char, 4> kSeparators = {'\t', ';', ',', ' '};
  for (const char separator : kSeparators)
    if (divides_equally(lines, separator)) return separator;
  // The reader will report the rows that differ.
  return *std::max_element(kSeparators.begin(), kSeparators.end(), [&](char a, char b) {
    return split_row(lines[0].text, a).size() < split_row(lines[0].text, b).size();
  });
}

using Rows = std::vector<std::vector<CsvValue>>;

bool is_number(const CsvValue& value) {
  double ignored = 0;
  return parse_number(value.text, ignored);
}

}  // namespace

CsvShape csv_shape(const ByteSource& bytes) {
  const Sample sample = read_sample(bytes);
  CsvShape shape;
  if (sample.lines.empty()) return shape;
  shape.separator = separator_of(sample.lines);
  Rows rows;
  for (const Line& line : sample.lines) rows.push_back(split_row(line.text, shape.separator));
  std::vector<CsvValue> names = rows[0];
  const bool is_first_row = std::none_of(names.begin(), names.end(), is_number);
  if (is_first_row) {
    rows.erase(rows.begin());
  } else {
    names = split_row(sample.comment, shape.separator);
    if (names.size() != rows[0].size()) names = split_row(sample.comment, ' ');
  }
  shape.has_header = is_first_row || names.size() == rows[0].size();
  if (!shape.has_header) names.assign(rows[0].size(), {});
  const Line& first = sample.lines[0];
  shape.first_line = first.number + (is_first_row ? 1 : 0);
  shape.begin = is_first_row ? first.end : first.offset;
  UniqueNames unique_names;
  for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), kMaxColumns + 1); ++i) {
    const std::string name = names[i].text.empty() ? "column" + std::to_string(i + 1) : names[i].text;
    shape.columns.push_back({unique_names.add(name), ColumnType::kFloat64});
  }
  std::vector<ColumnSurvey> surveys(shape.columns.size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < std::min(row.size(), surveys.size()); ++i)
      surveys[i].add(row[i].text, row[i].is_quoted, shape.first_line);
  set_types(shape.columns, surveys);
  return shape;
}

void set_types(std::vector<ColumnInfo>& columns, const std::vector<ColumnSurvey>& surveys) {
  // Some programs quote all values, others only strings.
  const bool may_quote_numbers =
      std::all_of(surveys.begin(), surveys.end(), [](const ColumnSurvey& survey) { return survey.is_quoted; });
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool is_string =
        !surveys[i].is_number() || (surveys[i].has_numbers && surveys[i].is_quoted && !may_quote_numbers);
    columns[i].type = is_string                       ? ColumnType::kText
                      : surveys[i].is_large_integer() ? ColumnType::kInt64
                                                      : ColumnType::kFloat64;
  }
}

std::vector<CsvValue> split_row(std::string_view line, char separator) {
  std::vector<CsvValue> out;
  if (separator == ' ') {
    for (const std::string_view word : words_of(line)) out.push_back({std::string(word), false});
    return out;
  }
  for (std::size_t at = 0;;) {
    // A value is quoted if a quote is its first character that is not blank.
    std::size_t begin = std::min(line.find_first_not_of(separator == '\t' ? " " : " \t", at), line.size());
    CsvValue value;
    if (begin < line.size() && line[begin] == '"') {
      value.is_quoted = true;
      for (++begin; begin < line.size(); ++begin) {
        if (line[begin] == '"' && (begin + 1 == line.size() || line[begin + 1] != '"')) break;
        if (line[begin] == '"') ++begin;
        value.text += line[begin];
      }
      at = line.find(separator, std::min(begin, line.size()));
    } else {
      at = line.find(separator, begin);
      value.text = trimmed(line.substr(begin, at - begin));
    }
    out.push_back(std::move(value));
    if (at == std::string_view::npos) return out;
    ++at;
  }
}

}  // namespace orrery::rows
