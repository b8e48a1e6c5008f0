// SPDX-License-Identifier: Apache-2.0
#include "rows/lammps_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "data/customary.h"
#include "data/faults.h"
#include "data/text_rows.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

constexpr const char* kTruncatedHeader = "the file ends within the header of a frame";
constexpr const char* kTruncatedRemedy = "remove the incomplete frame at the end of the file";

class FrameReader {
 public:
  FrameReader(TextCursor& cursor, Faults& faults) : cursor_(cursor), faults_(faults) {}

  LammpsFrame read() {
    for (;;) {
      const std::string item = next_line();
      if (item.find_first_not_of(" \t") == std::string::npos) continue;
      if (!item.starts_with("ITEM:"))
        faults_.fail(item_line(), fmt::format("expected a line \"ITEM: ...\", found '{}'", item.substr(0, kMaxShown)),
                     "check the number of atoms of the previous frame, and the lines of its header");
      const std::string name = item.substr(std::min(item.find_first_not_of(" \t", 5), item.size()));
      if (name.starts_with("ATOMS")) {
        read_columns(name);
        return finished();
      }
      if (name.starts_with("TIMESTEP"))
        step_ = read_number("a time step");
      else if (name.starts_with("NUMBER OF ATOMS"))
        read_count();
      else if (name.starts_with("BOX BOUNDS"))
        read_box(name);
      else if (name.starts_with("UNITS") || name.starts_with("TIME"))
        next_line();
      else
        faults_.fail(item_line(), fmt::format("'ITEM: {}' is not an item of an atom dump", name.substr(0, kMaxShown)),
                     "supported: dumps of style atom and custom");
    }
  }

 private:
  static constexpr std::size_t kMaxShown = 60;

  std::uint64_t item_line() const { return cursor_.line() - 1; }

  std::string next_line() {
    std::string line;
    if (!cursor_.next(line)) faults_.fail(cursor_.line(), kTruncatedHeader, kTruncatedRemedy);
    return line;
  }

  std::vector<double> read_numbers(std::size_t count, const std::string& what) {
    const std::string line = next_line();
    std::vector<double> numbers;
    for (const std::string_view word : words_of(line)) {
      double number = 0;
      if (!parse_number(word, number) || !std::isfinite(number)) break;
      numbers.push_back(number);
    }
    if (numbers.size() != count || words_of(line).size() != count)
      faults_.fail(item_line(), fmt::format("expected {}, found '{}'", what, line.substr(0, kMaxShown)));
    return numbers;
  }

  double read_number(const std::string& what) { return read_numbers(1, what)[0]; }

  void read_count() {
    const std::string line = next_line();
    const auto words = words_of(line);
    std::int64_t count = 0;
    if (words.size() != 1 || !parse_integer(words[0], count) || count < 0)
      faults_.fail(item_line(), fmt::format("expected a number of atoms, found '{}'", line.substr(0, kMaxShown)));
    rows_ = static_cast<std::uint64_t>(count);
    frame_.rows_line = item_line();
  }

  void read_box(const std::string& name) {
    const bool is_general = name.find(" abc") != std::string::npos;
    const bool is_tilted = name.find(" xy xz yz") != std::string::npos;
    const std::size_t count = is_general ? 4 : is_tilted ? 3 : 2;
    std::array<std::vector<double>, 3> v;
    for (auto& row : v) row = read_numbers(count, std::to_string(count) + " numbers of the box");
    if (is_general) {
      Box box;
      for (std::size_t i = 0; i < 3; ++i) box.edges[i] = {v[i][0], v[i][1], v[i][2]};
      box.origin = {v[0][3], v[1][3], v[2][3]};
      frame_.box = box;
    } else {
      const double xy = is_tilted ? v[0][2] : 0;
      const double xz = is_tilted ? v[1][2] : 0;
      const double yz = is_tilted ? v[2][2] : 0;
      // The file has the bounds of the tilted box.
      const Vec3d low{v[0][0] - std::min({0.0, xy, xz, xy + xz}), v[1][0] - std::min(0.0, yz), v[2][0]};
      const Vec3d high{v[0][1] - std::max({0.0, xy, xz, xy + xz}), v[1][1] - std::max(0.0, yz), v[2][1]};
      if (!(low.x <= high.x && low.y <= high.y && low.z <= high.z))
        faults_.fail(item_line(), "a lower bound of the box exceeds the upper bound");
      frame_.box = lammps_box(low, high, xy, xz, yz);
    }
    const auto words = words_of(name);
    // Old files have no boundary flags.
    std::vector<std::string_view> flags;
    for (const std::string_view word : words)
      if (word.size() == 2 && word.find_first_not_of("pfsm") == std::string_view::npos) flags.push_back(word);
    if (flags.size() == 3)
      for (std::size_t i = 0; i < 3; ++i) frame_.box->periodic[i] = flags[i][0] == 'p';
  }

  void read_columns(const std::string& name) {
    const auto words = words_of(name);
    if (words.size() > kMaxColumns)
      faults_.fail(item_line(), fmt::format("there are more than {} columns", kMaxColumns));
    UniqueNames names;
    for (std::size_t i = 1; i < words.size(); ++i) frame_.columns.push_back(names.add(std::string(words[i])));
  }

  LammpsFrame finished() {
    const char* const missing = !step_ ? "TIMESTEP" : !rows_ ? "NUMBER OF ATOMS" : nullptr;
    if (missing != nullptr)
      faults_.fail(item_line(), fmt::format("the frame has no item \"{}\" before its atoms", missing));
    frame_.step = *step_;
    frame_.rows = *rows_;
    return frame_;
  }

  TextCursor& cursor_;
  Faults& faults_;
  LammpsFrame frame_;
  std::optional<double> step_;
  std::optional<std::uint64_t> rows_;
};

}  // namespace

LammpsFrame read_lammps_frame(TextCursor& cursor, Faults& faults) { return FrameReader(cursor, faults).read(); }

Box lammps_box(const Vec3d& low, const Vec3d& high, double xy, double xz, double yz) {
  Box box;
  box.origin = low;
  box.edges = {Vec3d{high.x - low.x, 0, 0}, Vec3d{xy, high.y - low.y, 0}, Vec3d{xz, yz, high.z - low.z}};
  return box;
}

}  // namespace orrery::rows
