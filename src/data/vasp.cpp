// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/dictionary.h"
#include "data/frames.h"
#include "data/readers.h"

// Structures of VASP: POSCAR, CONTCAR, and XDATCAR, which has many.
namespace orrery::data {
namespace {

const std::array<std::string, 3> kCartesian = {"x", "y", "z"}, kFractions = {"fract_x", "fract_y", "fract_z"};
const std::string kElement = "element", kType = "type";

std::vector<double> finite_numbers(std::string_view line) {
  std::vector<double> out;
  for (const std::string_view word : words_of(line)) {
    double number = 0;
    if (!parse_number(word, number) || !std::isfinite(number)) break;
    out.push_back(number);
  }
  return out;
}

bool begins_with(std::string_view line, std::string_view letters) {
  const std::string_view text = trimmed(line);
  return !text.empty() && letters.find(text[0]) != std::string_view::npos;
}

bool are_counts(std::string_view line) {
  const auto words = words_of(line);
  std::int64_t count = 0;
  return !words.empty() &&
         std::all_of(words.begin(), words.end(), [&](auto word) { return parse_integer(word, count) && count >= 0; });
}

/// The line before the atoms of each structure of an XDATCAR.
bool is_configuration(std::string_view line) { return base::lower(trimmed(line)).starts_with("direct configuration"); }

/// What the lines before the atoms say beside their description.
struct VaspCell {
  double scale = 1;                                             ///< of Cartesian coordinates
  std::vector<std::pair<std::string, std::size_t>> kinds = {};  ///< names, and numbers of atoms
};

/// Reads the lines before the atoms of a structure.
class VaspHeader {
 public:
  VaspHeader(const ByteSource& bytes, TextCursor& cursor) : bytes_(bytes), cursor_(cursor), faults_(bytes.file()) {}

  TextFrame read() {
    std::string line = next();
    // An XDATCAR of a cell that does not change has its lines once.
    if (is_configuration(line)) {
      TextCursor first(bytes_);
      std::swap(first, cursor_);
      next();
      read_cell_and_counts();
      cursor_ = first;
    } else {
      frame_.info.title = trimmed(line);
      read_cell_and_counts();
      line = next();
      if (begins_with(line, "Ss")) line = next();  // selective dynamics: each row ends in three flags
    }
    const bool is_cartesian = begins_with(line, "CcKk");
    if (!is_cartesian && !begins_with(line, "Dd")) faults_.fail(cursor_.line() - 1, "expected `Direct` or `Cartesian`");
    const std::size_t number = line.find('=');
    if (double step = 0; number != std::string::npos && parse_number(trimmed(line.substr(number + 1)), step))
      frame_.info.step = step;
    frame_.layout.begin = cursor_.offset();
    frame_.layout.first_line = cursor_.line();
    frame_.layout.rows = frame_.info.rows;
    frame_.layout.allows_more = true;
    for (const std::string& name : is_cartesian ? kCartesian : kFractions)
      frame_.layout.columns.push_back({name, ColumnType::kFloat64});
    frame_.info.columns = frame_.layout.columns;
    if (!is_cartesian)
      for (const std::string& name : kCartesian) frame_.info.columns.push_back({name, ColumnType::kFloat64});
    frame_.info.columns.push_back({kElement, ColumnType::kText});
    frame_.info.names_as_types = kType;
    frame_.info.roles.position = kCartesian;
    frame_.info.roles.element = kElement;
    frame_.info.is_unit_cell = true;
    return std::move(frame_);
  }

  VaspCell cell() const { return cell_; }

 private:
  std::string next() {
    std::string line;
    if (!cursor_.next(line)) faults_.fail(cursor_.line(), "truncated: the file ends within the header of a structure");
    return line;
  }

  std::vector<double> next_numbers(const char* what) {
    std::vector<double> out = finite_numbers(next());
    if (out.empty()) faults_.fail(cursor_.line() - 1, fmt::format("expected {}", what));
    return out;
  }

  void read_cell_and_counts() {
    std::vector<double> scale = next_numbers("the scaling factor");
    const std::uint64_t scale_line = cursor_.line() - 1;
    scale.resize(scale.size() < 3 ? 1 : 3);
    Box box;
    for (Vec3d& edge : box.edges) {
      const std::vector<double> v = next_numbers("a vector of the cell");
      if (v.size() < 3) faults_.fail(cursor_.line() - 1, "a vector of the cell has three numbers");
      edge = {v[0], v[1], v[2]};
    }
    const double volume = std::abs(math::dot(box.edges[0], math::cross(box.edges[1], box.edges[2])));
    double& factor = cell_.scale;
    factor = scale[0];
    if (factor < 0) factor = std::cbrt(-factor / volume);  // the volume of the cell
    if (scale.size() == 3 && (scale[1] != scale[0] || scale[2] != scale[0]))
      faults_.fail(scale_line, "three different scaling factors are not supported", "multiply the numbers by them");
    if (!(volume > 0 && factor > 0 && std::isfinite(factor * volume)))
      faults_.fail(scale_line, "the cell has no volume: the scaling factor or the vectors are wrong");
    for (Vec3d& edge : box.edges) edge = edge * factor;
    frame_.info.box = box;
    read_counts();
  }

  void read_counts() {
    const std::string symbols = next();
    if (are_counts(symbols))
      faults_.fail(cursor_.line() - 1, "the file does not name its elements, as those of VASP 4",
                   "insert a line with a symbol for each number before this line, e.g. `Si O`");
    const std::string counts = next();
    frame_.count_line = cursor_.line() - 1;
    const auto names = words_of(symbols), numbers = words_of(counts);
    if (!are_counts(counts) || names.size() != numbers.size())
      faults_.fail(frame_.count_line, fmt::format("expected {} numbers of atoms, one for each of `{}`", names.size(),
                                                  trimmed(symbols).substr(0, 60)));
    for (std::size_t i = 0; i < names.size(); ++i) {
      constexpr std::int64_t kMaxCount = std::int64_t{1} << 40;  // so that the sum fits
      std::int64_t count = 0;
      if (!parse_integer(numbers[i], count) || count > kMaxCount)
        faults_.fail(frame_.count_line, fmt::format("{} atoms are too many", numbers[i]));
      // VASP appends the name of the potential, and since 6.4 its hash: Fe_pv/6ec0bd8e.
      cell_.kinds.emplace_back(names[i].substr(0, names[i].find_first_of("_/")), static_cast<std::size_t>(count));
      frame_.info.rows += static_cast<std::uint64_t>(count);
    }
  }

  const ByteSource& bytes_;
  TextCursor& cursor_;
  Faults faults_;
  TextFrame frame_;
  VaspCell cell_;
};

class Vasp final : public TextFrames {
 public:
  Vasp(const Bytes& bytes, const OpenOptions& options) : TextFrames(bytes, options) {
    constexpr std::uint64_t kHeaderLines = 7;
    TextCursor cursor(*bytes);
    cursor.skip(kHeaderLines);
    std::string line;
    is_trajectory_ = cursor.next(line) && is_configuration(line);
  }

  // What follows the atoms of a POSCAR are velocities and the state of the thermostat.
  int frame_count() override { return is_trajectory_ ? TextFrames::frame_count() : 1; }
  bool has_frame(int number) override { return (number == 0 || is_trajectory_) && TextFrames::has_frame(number); }

  Table read(int number, const std::vector<std::string>& columns) override {
    TextFrame frame = this->frame(number);
    std::vector<std::string> numbers = columns;
    std::erase_if(numbers, [](const std::string& name) { return name == kElement || name == kType; });
    const bool is_cartesian = frame.layout.columns[0].name == kCartesian[0];
    frame.layout.wanted = is_cartesian ? numbers : with_sources(numbers, kCartesian, kFractions);
    Table table = read_rows(frame);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (is_cartesian && base::contains(numbers, kCartesian[axis]))
        for (double& x : std::get<std::vector<double>>(table.find(kCartesian[axis])->values)) x *= cell_.scale;
      else if (base::contains(numbers, kCartesian[axis]))
        table.columns.push_back({kCartesian[axis], unscaled(table, kFractions, *frame.info.box, axis)});
    for (const std::string& name : columns)
      if (!base::contains(numbers, name)) table.columns.push_back({name, names_of_atoms()});
    return in_order(std::move(table), columns);
  }

 private:
  TextFrame header(TextCursor cursor) override {
    VaspHeader header(bytes(), cursor);
    TextFrame out = header.read();
    cell_ = header.cell();
    return out;
  }

  std::uint64_t skip_header(TextCursor& cursor) const override { return VaspHeader(bytes(), cursor).read().info.rows; }

  bool begins_frame(std::string_view line) const override { return !is_trajectory_ || finite_numbers(line).size() < 3; }

  Words names_of_atoms() const {
    WordColumn out;
    for (const auto& [name, count] : cell_.kinds)
      for (std::size_t i = 0; i < count; ++i) out.add(name);
    return out.take();
  }

  bool is_trajectory_ = false;
  VaspCell cell_;  ///< of the latest header
};

/// The format has no signature, and its files have no extension: a scaling factor, three vectors, names, numbers.
bool is_vasp(const Signature& signature) {
  std::string_view text = signature.head;
  std::array<std::string_view, 8> lines;
  for (std::string_view& line : lines) {
    line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  const auto count = [](std::string_view line) { return finite_numbers(line).size(); };
  const auto is_count = [&](std::string_view line) { return words_of(line).size() == 1 || words_of(line).size() == 3; };
  if (count(lines[1]) == 0 || !is_count(lines[1])) return false;
  for (std::size_t i = 2; i < 5; ++i)
    if (count(lines[i]) != 3) return false;
  const bool has_names = count(lines[5]) == 0 && are_counts(lines[6]);
  const bool is_of_vasp_4 = are_counts(lines[5]) && begins_with(lines[6], "SsDdCcKk");
  return has_names || is_of_vasp_4;
}

}  // namespace

const FormatReader kVasp = {"VASP", is_vasp, open_as<Vasp>};

}  // namespace orrery::data
