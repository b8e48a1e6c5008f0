// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "data/byte_source.h"
#include "data/customary.h"
#include "data/faults.h"
#include "data/single_frame.h"
#include "data/text_rows.h"
#include "rows/csv_shape.h"
#include "rows/readers.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// Positions given by equatorial coordinates.
struct Equatorial {
  std::string ra, dec, distance;  ///< names of columns; degrees
  bool is_parallax = false;       ///< `distance` is a parallax in milliarcseconds; the distance is in parsecs
  std::array<std::string, 3> xyz;
};

std::optional<Equatorial> equatorial(const std::vector<ColumnInfo>& columns) {
  const auto find = [&](std::initializer_list<const char*> names) { return number_column(columns, names); };
  Equatorial out;
  out.ra = find({"ra"});
  out.dec = find({"dec"});
  out.distance = find({"distance", "dist", "sy_dist"});
  if (out.distance.empty()) {
    out.distance = find({"parallax"});
    out.is_parallax = true;
  }
  if (out.ra.empty() || out.dec.empty() || out.distance.empty()) return std::nullopt;
  return out;
}

/// The position of a star; the z axis points to the celestial north pole, the x axis to the vernal equinox.
std::array<double, 3> position(double ra_deg, double dec_deg, double distance) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double ra = ra_deg * kRadians, dec = dec_deg * kRadians, in_plane = distance * std::cos(dec);
  return {in_plane * std::cos(ra), in_plane * std::sin(ra), distance * std::sin(dec)};
}

double distance_pc(double parallax_mas) {
  return parallax_mas > 0 ? 1000 / parallax_mas : std::numeric_limits<double>::quiet_NaN();
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
  explicit CsvFile(const Bytes& bytes) : SingleFrame(data::Format::kCsv, bytes), shape_(csv_shape(*bytes)) {
    Faults faults(bytes->file());
    if (shape_.columns.empty()) faults.fail(0, "the file has no rows");
    if (shape_.columns.size() > kMaxColumns)
      faults.fail(shape_.first_line, fmt::format("there are more than {} columns", kMaxColumns));
    TextLayout all = layout({});
    all.surveys = true;
    const TextTable survey = read_text_rows(*bytes, all, faults);
    info_.rows = survey.rows;
    set_types(shape_.columns, survey.surveys);
    require_numbers(survey.surveys, faults);
    info_.columns = shape_.columns;
    info_.roles = customary_roles(info_.columns);
    if (info_.roles.position[0].empty()) find_positions(faults);
    if (!info_.roles.rgb[0].empty())
      info_.roles.rgb_maximum = full_intensity(shape_.columns, survey.surveys, info_.roles.rgb);
    settle_names();
  }

  Table read(int, const std::vector<std::string>& names) override {
    std::vector<std::string> wanted = names;
    if (equatorial_)
      for (const std::string& axis : equatorial_->xyz)
        if (std::find(names.begin(), names.end(), axis) != names.end())
          wanted.insert(wanted.end(), {equatorial_->ra, equatorial_->dec, equatorial_->distance});
    Faults faults(bytes_->file());
    TextTable text = read_text_rows(*bytes_, layout(wanted), faults);
    Table table;
    table.rows = static_cast<std::size_t>(text.rows);
    for (std::size_t i = 0; i < shape_.columns.size(); ++i)
      table.columns.push_back({shape_.columns[i].name, std::move(text.values[i])});
    if (wanted.size() > names.size()) add_positions(table);
    return in_order(std::move(table), names);
  }

 private:
  /// One word must not turn coordinates, radii or colours into strings, which would be replaced by defaults. In a
  /// column of coordinates it is an error; the others remain numbers, so that it is one when they are read.
  void require_numbers(const std::vector<ColumnSurvey>& surveys, Faults& faults) {
    std::vector<ColumnInfo> as_numbers = shape_.columns;
    for (ColumnInfo& column : as_numbers) column.type = ColumnType::kFloat64;
    const Roles roles = customary_roles(as_numbers);
    std::vector<std::string> coordinates(roles.position.begin(), roles.position.end());
    if (const auto stars = equatorial(as_numbers); stars && roles.position[0].empty())
      coordinates = {stars->ra, stars->dec, stars->distance};
    for (std::size_t i = 0; i < surveys.size(); ++i) {
      const ColumnSurvey& survey = surveys[i];
      const std::string& name = shape_.columns[i].name;
      const bool has_comma = has_decimal_comma(survey.first_word);
      if (survey.first_word_line == 0 || !(survey.has_numbers || has_comma)) continue;
      if (std::find(coordinates.begin(), coordinates.end(), name) != coordinates.end())
        faults.add(survey.first_word_line, fmt::format("column {}: '{}' is not a number", name, survey.first_word),
                   has_comma ? kDecimalPoints : "correct it, or leave it empty");
      if (name == roles.radius || std::find(roles.rgb.begin(), roles.rgb.end(), name) != roles.rgb.end())
        shape_.columns[i].type = ColumnType::kFloat64;
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
    for (const ColumnInfo& column : shape_.columns)
      layout.columns.push_back({column.type, std::find(names.begin(), names.end(), column.name) != names.end()});
    return layout;
  }

  void add_positions(Table& table) const {
    std::array<std::vector<double>, 3> xyz;
    for (auto& axis : xyz) axis.resize(table.rows);
    const Column &ra = *table.find(equatorial_->ra), &dec = *table.find(equatorial_->dec),
                 &distance = *table.find(equatorial_->distance);
    for (std::size_t row = 0; row < table.rows; ++row) {
      const double d = distance.number(row);
      const auto p = position(ra.number(row), dec.number(row), equatorial_->is_parallax ? distance_pc(d) : d);
      for (std::size_t i = 0; i < 3; ++i) xyz[i][row] = p[i];
    }
    for (std::size_t i = 0; i < 3; ++i) table.columns.push_back({equatorial_->xyz[i], std::move(xyz[i])});
  }

  static Table in_order(Table table, const std::vector<std::string>& names) {
    Table out;
    out.rows = table.rows;
    for (const std::string& name : names)
      for (Column& column : table.columns)
        if (column.name == name) {
          out.columns.push_back(std::move(column));
          break;
        }
    return out;
  }

  CsvShape shape_;
  std::optional<Equatorial> equatorial_;
};

}  // namespace

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

std::unique_ptr<DataFile> open_csv(const Bytes& bytes, const OpenOptions&) { return std::make_unique<CsvFile>(bytes); }

}  // namespace orrery::rows
