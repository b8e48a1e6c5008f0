// SPDX-License-Identifier: Apache-2.0
#include "cli/data_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "cli/option_checks.h"
#include "plot/data_frames.h"
#include "scene/limits.h"

namespace orrery::cli {
namespace {

/// Parses numbers with a separator: "0:12", "2,2,1".
std::vector<double> numbers_of(const std::string& text, char separator, std::size_t count, const std::string& usage) {
  std::vector<double> out;
  const char *at = text.data(), *const end = at + text.size();
  while (out.size() < count) {
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    const bool is_last = out.size() + 1 == count;
    if (error != std::errc() || !std::isfinite(value) || (is_last ? stop != end : stop == end || *stop != separator))
      base::refuse(usage);
    out.push_back(value);
    at = is_last ? end : stop + 1;
  }
  return out;
}

void read_points(const DataArguments& arguments, scene::Points& points) {
  if (!arguments.frame.empty()) points.frame = integer_of(arguments.frame);
  if (!arguments.component.empty()) points.component = integer_of(arguments.component);
  if (!arguments.radius.empty()) {
    double value = 0;
    const char* const end = arguments.radius.data() + arguments.radius.size();
    const auto [stop, error] = std::from_chars(arguments.radius.data(), end, value);
    if (error == std::errc() && stop == end) {
      if (!(value > 0) || !std::isfinite(value)) base::refuse("--radius: must be above 0");
      if (points.radius.scale != 1)
        base::refuse("--radius-scale applies to radii of the data; scale the number in --radius instead");
      points.radius.value = value;
    } else {
      points.radius.column = arguments.radius;
    }
  }
  if (!arguments.range.empty()) {
    const auto ends =
        numbers_of(arguments.range, ':', 2,
                   fmt::format("--range: `{}` is not a range; write LOW:HIGH, e.g. 0:12", arguments.range));
    if (std::max(std::abs(ends[0]), std::abs(ends[1])) > scene::kLargestValue)
      base::refuse("--range: the numbers must be from -1e+300 to 1e+300");
    if (!(ends[0] < ends[1])) base::refuse("--range: the first number must be less than the second");
    points.color.range = scene::Interval{ends[0], ends[1]};
  }
  if (!arguments.replicate.empty()) {
    const auto counts =
        numbers_of(arguments.replicate, ',', 3,
                   fmt::format("--replicate: `{}` must be three numbers of copies, e.g. 2,2,1", arguments.replicate));
    for (const double n : counts)
      if (!(n >= 1 && n <= scene::kMaxCopies && n == std::floor(n)))
        base::refuse(
            fmt::format("--replicate: the numbers of copies must be integers from 1 to {}", scene::kMaxCopies));
    points.replicate = {counts[0], counts[1], counts[2]};
  }
}

std::pair<int, double> slice_of(const std::string& text) {
  const std::string usage = fmt::format("--slice: `{}` is not a plane; write AXIS=POSITION, e.g. z=10", text);
  if (text.size() < 3 || text[0] < 'x' || text[0] > 'z' || text[1] != '=') base::refuse(usage);
  return {text[0] - 'x', numbers_of(text.substr(2), '=', 1, usage)[0]};
}

}  // namespace

void add_data_file(Command& command, plot::DataOptions& data) {
  command.add_option("FILE", data.file, "Data file: LAMMPS, XYZ, PDB, mmCIF, PLY, CSV, NPY, NPZ, LAS, GSD, HDF5, VTK")
      ->required()
      ->type_name("FILE");
}

void add_data_options(Command& command, DataArguments& arguments, plot::DataOptions& data) {
  const OptionGroup group(command, "Data options");
  scene::Points& points = data.points;
  command.add_option("--frame", arguments.frame, "Frame of the file, from 1; default: 1")
      ->check(whole_number(1, 2'000'000'000))
      ->type_name("N");
  command
      .add_option("--frames", arguments.frames, "Frames of the file: all, or e.g. 1-48; name outputs like out.####.png")
      ->type_name("RANGE");
  command
      .add_option("--select", arguments.select,
                  "Use only the rows that match, e.g. 'type == 2 && z > 0'; if repeated, all must match")
      ->type_name("CONDITION")
      ->repeatable();
  command
      .add_option("--slice", arguments.slice,
                  "Slice plane: remove the spheres in front of it, e.g. z=10; can be repeated")
      ->type_name("AXIS=POSITION")
      ->repeatable();
  command.add_option("--component", arguments.component, "HDF5: particle type, N of PartTypeN")
      ->check(whole_number(0, 1000))
      ->type_name("N");
  command.add_option("--assembly", points.assembly, "PDB, mmCIF: biological assembly, e.g. 1")->type_name("NAME");
  command.add_option("--replicate", arguments.replicate, "Number of periodic boxes along each box edge, e.g. 2,2,1")
      ->type_name("A,B,C");
  command.add_flag("--unwrap", points.unwrap, "Unwrap coordinates with the file's periodic image flags");
  command.add_flag("--skip-bad", points.skip_bad, "Skip rows with non-finite coordinates or radii");
}

void add_look_options(Command& command, DataArguments& arguments, plot::DataOptions& data) {
  const OptionGroup group(command, "Look options");
  scene::Points& points = data.points;
  command.add_option("--radius", arguments.radius, "Radius: a number, or a column of radii; default: from the file")
      ->type_name("X|COLUMN");
  command
      .add_option("--radius-scale", points.radius.scale,
                  "Scale factor for radii of the data and for the default radius, e.g. 0.5 for a column of diameters")
      ->check(real_number(1e-30, 1e30))
      ->type_name("X");
  command
      .add_option("--element-radii", points.radius.element,
                  "Radii by chemical element: vdw, covalent or ball (a quarter of vdw)")
      ->check(one_of({"vdw", "covalent", "ball"}))
      ->type_name("TABLE");
  command
      .add_option("--color-by", data.color_by,
                  "Colour by a column, or by element, type or rgb; none: one colour; default: from the file")
      ->type_name("COLUMN");
  arguments.map = command.add_option("--map", points.color.map, "Colour map, e.g. viridis, fast, coolwarm, or a file")
                      ->type_name("MAP");
  command
      .add_option("--range", arguments.range,
                  "Values at both ends of the colour map; default: minimum and maximum over all frames")
      ->type_name("LOW:HIGH");
}

void read_data_options(const DataArguments& arguments, plot::DataOptions& data) {
  if (!arguments.frames.empty() && !arguments.frame.empty()) base::refuse("--frame and --frames exclude each other");
  data.all_frames = arguments.frames == "all";
  if (!arguments.frames.empty() && !data.all_frames) data.frames = base::parse_frames(arguments.frames);
  data.has_map = arguments.map->count() > 0;
  read_points(arguments, data.points);
  data.points.select = plot::all_of(arguments.select);
  for (const std::string& plane : arguments.slice) data.slices.push_back(slice_of(plane));
}

}  // namespace orrery::cli
