// SPDX-License-Identifier: Apache-2.0
#include "plot/convert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_name.h"
#include "base/file_set.h"
#include "base/frames.h"
#include "base/text.h"
#include "data/write_table.h"
#include "plot/appearance.h"
#include "plot/data_frames.h"
#include "plot/view.h"
#include "points/color_map.h"

namespace orrery::plot {

namespace {

using Bytes = std::vector<std::uint8_t>;

/// Rounds a display-referred value; NaN is 0.
std::uint8_t byte_of(double srgb) {
  return std::isnan(srgb) ? 0 : static_cast<std::uint8_t>(std::clamp(srgb, 0.0, 1.0) * 255 + 0.5);
}

/// Red, green and blue of the spheres, from their palette.
std::array<Bytes, 3> palette_colors(const scene::Points& points) {
  std::vector<std::array<std::uint8_t, 3>> palette;
  for (const math::Vec3d& light : points.palette) {
    const math::Vec3d srgb = points::srgb_from_linear(light);
    palette.push_back({byte_of(srgb.x), byte_of(srgb.y), byte_of(srgb.z)});
  }
  std::array<Bytes, 3> out;
  for (std::size_t channel = 0; channel < out.size(); ++channel) {
    out[channel].reserve(points.colors.size());
    for (const std::uint16_t index : points.colors) out[channel].push_back(palette[index][channel]);
  }
  return out;
}

/// Red, green and blue of the spheres in the file.
std::array<Bytes, 3> file_colors(const points::SourceRows& source) {
  std::array<Bytes, 3> out;
  for (std::size_t channel = 0; channel < out.size(); ++channel) {
    const data::Column& column = *source.table.find(source.info.roles.rgb[channel]);
    out[channel].reserve(source.rows.size());
    for (const std::uint32_t row : source.rows)
      out[channel].push_back(byte_of(column.number(row) / source.info.roles.rgb_maximum));
  }
  return out;
}

/// The numbers in the given rows.
template <class Numbers>
auto gathered(const Numbers& all, const std::vector<std::uint32_t>& rows) {
  std::vector<std::decay_t<decltype(all[0])>> out;
  out.reserve(rows.size());
  for (const std::uint32_t row : rows) out.push_back(all[row]);
  return out;
}

/// The strings in the given rows, excluding those of other rows, which the output format may not support.
data::Words gathered(const data::Words& all, const std::vector<std::uint32_t>& rows) {
  return data::words_at(all.words, gathered(all.index, rows));
}

/// Makes the table of an output. Moves the columns of the source one by one, so that few of them exist twice.
class OutputTable {
 public:
  OutputTable(scene::Points& points, points::SourceRows& source, bool has_radius) : source_(source) {
    const data::Roles& roles = source.info.roles;
    for (const std::string& axis : roles.position) source.table.find(axis)->values = {};
    table_.rows = points.centers.size();
    takes_all_ = table_.rows == source.table.rows;
    for (std::size_t i = 0; takes_all_ && i < source.rows.size(); ++i) takes_all_ = source.rows[i] == i;
    replaced_.insert(replaced_.end(), roles.position.begin(), roles.position.end());
    add("x", coordinates(points, &math::Vec3d::x));
    add("y", coordinates(points, &math::Vec3d::y));
    add("z", coordinates(points, &math::Vec3d::z));
    points.centers.clear();
    if (has_radius) {
      replaced_.push_back(roles.radius);
      add("radius", std::vector<double>(points.radii.begin(), points.radii.end()));
    }
    points.radii.clear();
    add_colors(points);
    for (const data::ColumnInfo& column : source.info.columns)
      if (!column.is_derived) add_other(column.name);
  }

  data::Table& table() { return table_; }
  /// Columns of the file whose name another column of the output has.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  static std::vector<double> coordinates(const scene::Points& points, double math::Vec3d::*component) {
    std::vector<double> out;
    out.reserve(points.centers.size());
    for (const math::Vec3d center : points.centers) out.push_back(center.*component);
    return out;
  }

  void add(const std::string& name, data::Values values) { table_.columns.push_back({name, std::move(values)}); }

  void add_colors(const scene::Points& points) {
    const data::Roles& roles = source_.info.roles;
    const bool has_own = !roles.rgb[0].empty();
    const bool uses_own = has_own && (points.color.rgb || !points.color.is_set());
    if (!uses_own && !points.color.is_set()) return;
    if (has_own) replaced_.insert(replaced_.end(), roles.rgb.begin(), roles.rgb.end());
    auto [red, green, blue] = uses_own ? file_colors(source_) : palette_colors(points);
    add("red", std::move(red));
    add("green", std::move(green));
    add("blue", std::move(blue));
  }

  void add_other(const std::string& name) {
    if (base::contains(replaced_, name)) return;
    if (table_.find(name) != nullptr) {
      left_out_.push_back(name);
      return;
    }
    data::Values values = std::exchange(source_.table.find(name)->values, {});
    if (!takes_all_)
      values = std::visit([&](const auto& all) -> data::Values { return gathered(all, source_.rows); }, values);
    add(name, std::move(values));
  }

  points::SourceRows& source_;
  data::Table table_;
  bool takes_all_ = false;             ///< the spheres are all rows, in their order
  std::vector<std::string> replaced_;  ///< columns of the file that columns of the output stand for
  std::vector<std::string> left_out_;
};

class Converter {
 public:
  explicit Converter(const ConvertOptions& options)
      : options_(options), data_(options, std::filesystem::path()), keys_(options.points) {
    keys_.material_column = "";  // not treated specially
    keys_.frame = data_.fixed_frame();
    const data::Roles& roles = data_.info().roles;
    scene::PointsRadius& radius = keys_.radius;
    has_radius_ = radius.value || !radius.column.empty() || !radius.element.empty() || !roles.radius.empty();
    if (!has_radius_) radius.value = 1;
    if (!options.color_by.empty()) set_color(options, options.color_by, data_.info(), keys_.color);
    for (const auto& plane : options.slices)
      slice(plane, view_axes(kDefaultView, data_.info().z_up ? "z" : "y"), keys_);
  }

  void run(const std::function<void(const ConvertedFile&)>& written) {
    check_outputs();
    choose_range();
    for (const int frame : data_.all()) written(convert_frame(frame));
  }

 private:
  std::filesystem::path output_of(int frame) const {
    return data_.numbers().empty() ? options_.output
                                   : std::filesystem::path(base::with_frame(options_.output.string(), frame));
  }

  void check_outputs() const {
    const std::string name = options_.output.string();
    if (data_.numbers().size() > 1 && !base::has_frame_pattern(name))
      base::refuse_one_name(name, data_.numbers().size(), "out.####.ply");
    if (data_.numbers().empty() && base::has_frame_pattern(name))
      base::refuse(name + " has a frame pattern; select frames with --frames, e.g. --frames all");
    base::FileSet files;
    for (const int frame : data_.all()) files.add_input(data_.file_of(frame), "data file");
    if (keys_.color.has_map_file()) files.add_input(keys_.color.map, "colour map");
    for (const int frame : data_.all()) files.add_output(output_of(frame), "-o");
  }

  /// One range of the colour map for all frames, as in a plot.
  void choose_range() {
    if (keys_.color.column.empty() || keys_.color.range || (data_.all().size() < 2 && !options_.range.is_set)) return;
    RangeFinder finder(options_.range);
    for (const int frame : data_.all()) data_.load(frame, keys_, nullptr, [&](double value) { finder.add(value); });
    if (!finder.is_empty()) keys_.color.range = finder.range();
  }

  ConvertedFile convert_frame(int frame) const {
    points::SourceRows source;
    LoadedFrame loaded = data_.load(frame, keys_, &source);
    OutputTable output(loaded.points, source, has_radius_);
    ConvertedFile out;
    out.file = output_of(frame);
    out.spheres = output.table().rows;
    out.warnings = std::move(loaded.warnings);
    if (!has_radius_)
      out.notes.push_back(fmt::format("no column radius: the file has no radius; --radius{} sets it",
                                      source.info.roles.element.empty() ? "" : " or --element-radii"));
    if (!output.left_out().empty())
      out.notes.push_back(fmt::format("left out {}: an earlier column has this name", base::joined(output.left_out())));
    const data::FrameHeader header = header_of(source.info);
    if (source.info.box && (!header.box || base::extension(out.file) != ".xyz"))
      out.notes.push_back(header.box ? "left out the simulation box: only .xyz has one"
                                     : "left out the simulation box: it is not that of an assembly");
    const std::vector<std::string> unwritten = data::write_table(out.file, output.table(), header);
    if (!unwritten.empty())
      out.notes.push_back(fmt::format("left out {}: the format cannot store these strings", base::joined(unwritten)));
    for (const data::Column& column : output.table().columns)
      if (!base::contains(unwritten, column.name)) out.columns.push_back(column.name);
    return out;
  }

  /// The box of all periodic images.
  data::FrameHeader header_of(const data::FrameInfo& info) const {
    data::FrameHeader out{info.box, info.step};
    if (!keys_.assembly.empty()) out.box.reset();
    const double counts[] = {keys_.replicate.x, keys_.replicate.y, keys_.replicate.z};
    for (std::size_t axis = 0; axis < 3 && out.box; ++axis) out.box->edges[axis] = out.box->edges[axis] * counts[axis];
    return out;
  }

  const ConvertOptions& options_;
  DataFrames data_;
  scene::PointsKeys keys_;
  bool has_radius_ = false;
};

}  // namespace

void convert(const ConvertOptions& options, const std::function<void(const ConvertedFile&)>& written) {
  data::require_table_format(options.output);
  Converter(options).run(written);
}

}  // namespace orrery::plot
