// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/atom_elements.h"
#include "data/atom_table.h"
#include "data/columns.h"
#include "data/dictionary.h"
#include "data/frames.h"
#include "data/readers.h"
#include "data/trajectory.h"

// Structures and trajectories of GROMACS as text, with fixed columns: residue number, residue, name and number of the
// atom, five each; position and velocity, as wide as the distance of two decimal points.
//
// Reference  gromacs-formats
namespace orrery::data {
namespace {

constexpr std::size_t kField = 5, kPositionColumn = 20;

/// The number behind a word such as "t=" in a title.
std::optional<double> number_after(std::string_view title, std::string_view word) {
  const std::size_t at = title.rfind(word);
  if (at == std::string_view::npos) return std::nullopt;
  const auto words = words_of(title.substr(at + word.size()));
  double number = 0;
  return !words.empty() && parse_number(words[0], number) && std::isfinite(number) ? std::optional(number)
                                                                                   : std::nullopt;
}

bool parse_atom_count(std::string_view line, std::int64_t& count) {
  return parse_integer(trimmed(line), count) && count >= 0;
}

/// The widths of the numbers in a row, and how many there are.
struct NumberColumns {
  std::size_t width = 8, count = 3;
};

/// Result     none if this is no row
std::optional<NumberColumns> columns_in(std::string_view row) {
  std::vector<std::size_t> points;
  for (std::size_t i = kPositionColumn; i < row.size(); ++i)
    if (row[i] == '.') points.push_back(i);
  if (points.size() < 3 || points[2] - points[1] != points[1] - points[0]) return std::nullopt;
  return NumberColumns{points[1] - points[0], points.size() < 6 ? std::size_t{3} : 6};
}

class Gro final : public TextFrames {
 public:
  Gro(const Bytes& bytes, const OpenOptions& options) : TextFrames(bytes, options), limit_(options.memory_limit) {}

  FrameInfo describe(int number) override {
    load(number);
    return info_;
  }

  Table read(int number, const std::vector<std::string>& columns) override {
    load(number);
    return copied_columns(table_, columns);
  }

  std::uint64_t memory() const override {
    std::uint64_t out = TextFrames::memory();
    for (const Column& column : table_.columns) out += table_.rows * bytes_per_value(column.type());
    return out;
  }

 private:
  TextFrame header(TextCursor cursor) override {
    TextFrame out;
    std::string title;
    TextCursor(cursor).next(title);
    out.info.title = title;
    out.info.step = number_after(title, "step=");
    if (const auto time = number_after(title, "t=")) out.info.header.emplace_back("time", *time);
    out.layout.rows = out.info.rows = skip_header(cursor) - 1;
    out.count_line = cursor.line() - 1;
    out.layout.begin = cursor.offset();
    out.layout.first_line = cursor.line();
    out.layout.columns.resize(kPositionColumn / kField + 3);
    return out;
  }

  /// Result     of the rows, and one line for the box after them
  std::uint64_t skip_header(TextCursor& cursor) const override {
    std::string title, line;
    cursor.next(title);
    std::int64_t count = 0;
    if (!cursor.next(line) || !parse_atom_count(line, count))
      Faults(bytes().file())
          .fail(cursor.line() - 1, fmt::format("expected a number of atoms, found {}", quoted_word(line)),
                "check the number of atoms of the previous frame");
    return static_cast<std::uint64_t>(count) + 1;
  }

  bool begins_frame(std::string_view) const override { return true; }

  /// Reads all columns of a frame.
  void load(int number) {
    if (number == loaded_) return;
    loaded_ = -1;
    table_ = {};
    const TextFrame found = frame(number);
    const auto rows = static_cast<std::size_t>(found.info.rows);
    constexpr double kBytesPerRow = 7 * sizeof(float) + 3 * sizeof(std::uint32_t);
    require_parse_memory(bytes().file(), rows, kBytesPerRow, bytes().memory(), limit_);
    info_ = found.info;
    TextCursor cursor(bytes(), {found.layout.begin, found.layout.first_line});
    Faults faults(bytes().file());
    std::string line;
    std::optional<NumberColumns> numbers;
    std::vector<std::vector<float>> values(6);
    std::vector<std::int32_t> residue_numbers;
    WordColumn residues, names, elements;
    AtomElements deduced(true);  // names are aligned without regard to the element
    for (std::size_t row = 0; row < rows; ++row) {
      if (!cursor.next(line))
        faults.fail(cursor.line(), fmt::format("truncated: the file ends after {} of {} atoms", row, rows));
      if (!numbers) numbers = columns_in(line);
      if (!numbers) faults.fail(cursor.line() - 1, "expected an atom, with decimal points at equal distances");
      const std::string_view residue = field(line, 1), name = field(line, 2);
      residue_numbers.push_back(base::number_of<std::int32_t>(field(line, 0)).value_or(0));
      residues.add(residue);
      names.add(name);
      elements.add(deduced.element_of(name, residue));
      for (std::size_t i = 0; i < numbers->count; ++i) {
        const std::size_t at = std::min(kPositionColumn + i * numbers->width, line.size());
        const auto value = base::number_of<double>(trimmed(std::string_view(line).substr(at, numbers->width)));
        if (!value) faults.add_of_many(cursor.line() - 1, "malformed positions or velocities");
        values[i].push_back(static_cast<float>(value.value_or(0)) * kAngstromPerNm);
      }
    }
    faults.raise_if_any();
    info_.box = box_after(cursor, faults);
    constexpr const char* kNumbers[] = {"x", "y", "z", "velocity[1]", "velocity[2]", "velocity[3]"};
    table_.rows = rows;
    for (std::size_t i = 0; i < (numbers ? numbers->count : 3); ++i)
      table_.columns.push_back({kNumbers[i], std::move(values[i])});
    table_.columns.push_back({"element", elements.take()});
    table_.columns.push_back({"name", names.take()});
    table_.columns.push_back({"residue", residues.take()});
    table_.columns.push_back({"residue_number", std::move(residue_numbers)});
    for (const Column& column : table_.columns) info_.columns.push_back({column.name, column.type()});
    info_.roles.position = {"x", "y", "z"};
    info_.roles.element = "element";
    if (const std::string warning = deduced.warning(); !warning.empty()) info_.warnings.push_back(warning);
    loaded_ = number;
  }

  /// Reads the line after the atoms: the diagonal of the three vectors and, of a box that is not a cuboid, the rest.
  std::optional<Box> box_after(TextCursor& cursor, Faults& faults) const {
    std::string line;
    if (!cursor.next(line)) faults.fail(cursor.line(), "truncated: the line of the box is missing");
    std::array<double, 9> v{};
    const auto words = words_of(line);
    for (std::size_t i = 0; i < std::min(words.size(), v.size()); ++i) {
      if (!parse_number(words[i], v[i]) || !std::isfinite(v[i]))
        faults.fail(cursor.line() - 1, fmt::format("{} is not a length of the box", quoted_word(words[i])),
                    "check the number of atoms");
      v[i] = static_cast<double>(static_cast<float>(v[i]) * kAngstromPerNm);
    }
    if (v[0] == 0 && v[1] == 0 && v[2] == 0) return std::nullopt;
    return Box{.edges = {Vec3d{v[0], v[3], v[4]}, Vec3d{v[5], v[1], v[6]}, Vec3d{v[7], v[8], v[2]}}};
  }

  static std::string_view field(std::string_view line, std::size_t number) {
    return trimmed(line.substr(std::min(number * kField, line.size()), kField));
  }

  std::uint64_t limit_;  ///< see OpenOptions
  int loaded_ = -1;      ///< frame in `table_` and `info_`
  Table table_;
  FrameInfo info_;
};

bool is_gro(const Signature& signature) {
  std::string_view text = signature.head;
  std::array<std::string_view, 3> lines;
  for (std::string_view& line : lines) {
    line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  std::int64_t count = 0;
  if (!parse_atom_count(lines[1], count)) return false;
  return signature.extension == ".gro" ||
         (columns_in(lines[2]) && parse_integer(trimmed(lines[2].substr(0, kField)), count));
}

}  // namespace

const FormatReader kGro = {"GRO", is_gro, open_as<Gro>};

}  // namespace orrery::data
