// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/frames.h"
#include "data/readers.h"

namespace orrery::data {

namespace {

/// Layout of a text table, determined from its first lines.
struct CsvShape {
  char separator = ',';             ///< ' ': any number of spaces and tabs
  std::uint64_t begin = 0;          ///< offset of the first row of values
  std::uint64_t first_line = 1;     ///< its line number
  bool has_header = false;          ///< otherwise the columns are named column1, column2 ..
  std::vector<ColumnInfo> columns;  ///< kFloat64, kInt64 or kText
};

/// A value of a row, without surrounding quotes and spaces.
struct CsvValue {
  std::string text;
  bool is_quoted = false;
};

/// Sets the types of columns. A column is numeric if all of its values are numbers or missing. It is int64 if all are
/// integers and float64 cannot represent some of them. A column whose values are all quoted is text, unless this holds
/// for every column.
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

/// Positions given by equatorial coordinates.
struct Equatorial {
  std::array<std::string, 3> sources;  ///< columns: right ascension and declination in degrees, distance
  bool is_parallax = false;            ///< parallaxes in milliarcseconds instead of distances, which are in parsecs
  std::array<std::string, 3> xyz;      ///< computed columns
};

std::optional<Equatorial> equatorial(const std::vector<ColumnInfo>& columns) {
  const auto find = [&](std::initializer_list<const char*> names) { return number_column(columns, names); };
  Equatorial out;
  out.sources = {find({"ra"}), find({"dec"}), find({"distance", "dist", "sy_dist"})};
  out.is_parallax = out.sources[2].empty();
  if (out.is_parallax) out.sources[2] = find({"parallax"});
  return base::contains({out.sources.begin(), out.sources.end()}, "") ? std::nullopt : std::optional(out);
}

/// Whether a row has the names of coordinates. Others of its values may be numbers: "x,y,z,2020".
bool name_coordinates(const std::vector<CsvValue>& row) {
  std::vector<ColumnInfo> columns;
  for (const CsvValue& value : row) columns.push_back({value.text, ColumnType::kFloat64});
  return !customary_roles(columns).position[0].empty() || equatorial(columns).has_value();
}

/// Examines up to 1000 rows after the leading comments, which begin with #, % or //; comments between rows are those of
/// is_comment().
///
/// - The separator is the first of tab, semicolon, comma and space that splits all of these rows into the same number
///   of values, at least two.
/// - The first row is the header if none of its values is a number, or if it names coordinates; otherwise, the last
///   comment is the header if it has as many words as the rows have values.
/// - Column types are determined by set_types() from the examined rows.
///
/// Errors     base::Error: kBadData for a line that is too long; kIo
CsvShape csv_shape(const ByteSource& bytes) {
  const Sample sample = read_sample(bytes);
  CsvShape shape;
  if (sample.lines.empty()) return shape;
  shape.separator = separator_of(sample.lines);
  Rows rows;
  for (const Line& line : sample.lines) rows.push_back(split_row(line.text, shape.separator));
  std::vector<CsvValue> names = rows[0];
  const bool is_first_row = std::none_of(names.begin(), names.end(), is_number) || name_coordinates(names);
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

/// The position of a star; the z axis points to the celestial north pole, the x axis to the vernal equinox.
std::array<double, 3> position(double ra_deg, double dec_deg, double distance) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double ra = ra_deg * kRadians, dec = dec_deg * kRadians, in_plane = distance * std::cos(dec);
  return {in_plane * std::cos(ra), in_plane * std::sin(ra), distance * std::sin(dec)};
}

/// Full intensity of colours in a text file, which has no types: the smallest customary value that no colour exceeds.
double full_intensity(const std::vector<ColumnInfo>& columns, const std::vector<ColumnSurvey>& surveys,
                      const std::array<std::string, 3>& rgb) {
  double largest = 0;
  for (std::size_t i = 0; i < surveys.size(); ++i)
    if (std::find(rgb.begin(), rgb.end(), columns[i].name) != rgb.end())
      largest = std::max(largest, surveys[i].largest);
  return largest > 255 ? 65535 : largest > 1 ? 255 : 1;
}

constexpr const char* kDecimalPoints = "write numbers with decimal points instead of decimal commas";

/// Returns whether a word is a number but for its decimal comma.
bool has_decimal_comma(std::string word) {
  const std::size_t comma = word.find(',');
  double ignored = 0;
  if (comma == std::string::npos) return false;
  word[comma] = '.';
  return parse_number(word, ignored);
}

class CsvFile final : public SingleFrame {
 public:
  explicit CsvFile(const Bytes& bytes) : SingleFrame(bytes), shape_(csv_shape(*bytes)) {
    Faults faults(bytes->file());
    if (shape_.columns.empty()) faults.fail(0, "the file has no rows");
    if (shape_.columns.size() > kMaxColumns)
      faults.fail(shape_.first_line, fmt::format("there are more than {} columns", kMaxColumns));
    TextLayout all = layout({});
    all.surveys = true;
    const TextTable survey = read_text_rows(*bytes, all, faults);
    info_.rows = survey.table.rows;
    set_types(shape_.columns, survey.surveys);
    require_numbers(survey.surveys, faults);
    info_.columns = shape_.columns;
    info_.roles = customary_roles(info_.columns);
    if (info_.roles.position[0].empty()) find_positions(faults);
    if (!info_.roles.rgb[0].empty())
      info_.roles.rgb_maximum = full_intensity(shape_.columns, survey.surveys, info_.roles.rgb);
    info_.names_as_types = info_.roles.element;
  }

  Table read(int, const std::vector<std::string>& names) override {
    Faults faults(bytes_->file());
    const std::vector<std::string> wanted =
        equatorial_ ? with_sources(names, equatorial_->xyz, equatorial_->sources) : names;
    Table table = read_text_rows(*bytes_, layout(wanted), faults).table;
    if (wanted == names) return table;
    add_positions(table);
    return in_order(std::move(table), names);
  }

 private:
  /// A word in a column of coordinates is an error. It must not turn radii or colours into strings either, which would
  /// be replaced by defaults: these columns remain numbers, so that it is an error when they are read.
  void require_numbers(const std::vector<ColumnSurvey>& surveys, Faults& faults) {
    std::vector<ColumnInfo> as_numbers = shape_.columns;
    for (ColumnInfo& column : as_numbers) column.type = ColumnType::kFloat64;
    const Roles roles = customary_roles(as_numbers);
    std::vector<std::string> coordinates(roles.position.begin(), roles.position.end());
    if (const auto stars = equatorial(as_numbers); stars && roles.position[0].empty())
      coordinates = {stars->sources.begin(), stars->sources.end()};
    for (std::size_t i = 0; i < surveys.size(); ++i) {
      const ColumnSurvey& survey = surveys[i];
      const std::string& name = shape_.columns[i].name;
      const bool has_comma = has_decimal_comma(survey.first_word);
      if (survey.first_word_line == 0) continue;
      if (base::contains(coordinates, name))
        faults.add(survey.first_word_line, fmt::format("column {}: '{}' is not a number", name, survey.first_word),
                   has_comma ? kDecimalPoints : "correct it, or leave it empty");
      const bool is_look =
          name == roles.radius || std::find(roles.rgb.begin(), roles.rgb.end(), name) != roles.rgb.end();
      if (is_look && (survey.has_numbers || has_comma)) shape_.columns[i].type = ColumnType::kFloat64;
    }
    faults.raise_if_any();
  }

  /// Positions in columns of other names, or computed from equatorial coordinates.
  void find_positions(Faults& faults) {
    equatorial_ = equatorial(info_.columns);
    if (equatorial_) {
      constexpr const char* kCoordinates[] = {"x", "y", "z"};
      UniqueNames names(info_.columns);
      for (std::size_t i = 0; i < 3; ++i) {
        equatorial_->xyz[i] = names.add(kCoordinates[i]);
        info_.columns.push_back({equatorial_->xyz[i], ColumnType::kFloat64});
      }
      info_.roles.position = equatorial_->xyz;
    } else if (!shape_.has_header && info_.columns.size() >= 3 &&
               std::all_of(info_.columns.begin(), info_.columns.begin() + 3,
                           [](const ColumnInfo& c) { return c.type == ColumnType::kFloat64; })) {
      info_.roles.position = {info_.columns[0].name, info_.columns[1].name, info_.columns[2].name};
    } else {
      // A row of such numbers is taken for the header.
      const bool has_commas = std::any_of(info_.columns.begin(), info_.columns.end(),
                                          [](const ColumnInfo& c) { return has_decimal_comma(c.name); });
      faults.fail(shape_.first_line,
                  "there are neither columns x, y and z of numbers nor ra, dec and distance (or parallax); the columns "
                  "are: " +
                      listed(info_.columns),
                  has_commas          ? kDecimalPoints
                  : shape_.has_header ? "name the coordinates x, y and z in the header"
                                      : "add a header line with the names of the columns");
    }
  }

  TextLayout layout(const std::vector<std::string>& names) const {
    TextLayout layout;
    layout.begin = shape_.begin;
    layout.first_line = shape_.first_line;
    layout.separator = shape_.separator;
    layout.allows_missing = true;
    layout.allows_comments = true;
    layout.columns = shape_.columns;
    layout.wanted = names;
    return layout;
  }

  void add_positions(Table& table) const {
    std::array<std::vector<double>, 3> xyz;
    for (auto& axis : xyz) axis.resize(table.rows);
    const auto& [ra_name, dec_name, distance_name] = equatorial_->sources;
    const Column &ra = *table.find(ra_name), &dec = *table.find(dec_name), &distance = *table.find(distance_name);
    for (std::size_t row = 0; row < table.rows; ++row) {
      double d = distance.number(row);
      if (equatorial_->is_parallax) d = d > 0 ? 1000 / d : std::numeric_limits<double>::quiet_NaN();
      const auto p = position(ra.number(row), dec.number(row), d);
      for (std::size_t i = 0; i < 3; ++i) xyz[i][row] = p[i];
    }
    for (std::size_t i = 0; i < 3; ++i) table.columns.push_back({equatorial_->xyz[i], std::move(xyz[i])});
  }

  CsvShape shape_;
  std::optional<Equatorial> equatorial_;
};

bool has_csv_extension(const Signature& signature) {
  return signature.extension == ".csv" || signature.extension == ".tsv" || signature.extension == ".tab";
}

bool is_csv(const Signature& signature) {
  // Any text file whose lines consist of numbers, or which has a header with names of coordinates.
  if (signature.head.find('\0') != std::string::npos) return false;
  const std::size_t end = signature.head.rfind('\n');  // the last line may be incomplete
  const CsvShape shape = csv_shape(*ByteSource::of_memory({}, std::string_view(signature.head).substr(0, end)));
  if (shape.has_header)
    return !customary_roles(shape.columns).position[0].empty() || equatorial(shape.columns).has_value();
  return shape.columns.size() >= 3 && std::all_of(shape.columns.begin(), shape.columns.end(),
                                                  [](const ColumnInfo& c) { return c.type == ColumnType::kFloat64; });
}

}  // namespace

const FormatReader kCsv = {"CSV", is_csv, open_as<CsvFile>};
const FormatReader kNamedCsv = {"CSV", has_csv_extension, open_as<CsvFile>};

}  // namespace orrery::data
