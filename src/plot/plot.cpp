// SPDX-License-Identifier: Apache-2.0
#include "plot/plot.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/frames.h"
#include "base/text.h"
#include "data/data_file.h"
#include "plot/scene_text.h"
#include "plot/view.h"
#include "points/derived.h"
#include "points/load_points.h"
#include "points/spacing.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::plot {
namespace {

using scene::number_text;

/// Colour map of numbers, and of types.
constexpr const char* kMap = "fast";
constexpr const char* kCategoricalMap = "tab10";

/// A points table of the scene as its author would write it, completed step by step.
class PlotMaker {
 public:
  PlotMaker(const PlotOptions& options, const std::filesystem::path& folder) : options_(options), folder_(folder) {
    out_.points = options.points;
    out_.points.material_column = "";  // the scene of a plot has one material
    out_.points.file = folder.empty() ? options.file : std::filesystem::proximate(options.file, folder);
    is_sequence_ = base::with_frame(options.file.string(), 1) != options.file.string();
  }

  PlotScene run() {
    open_data();
    choose_frames();
    choose_radius();
    choose_color();
    const std::string up_name = options_.up.empty() ? (info_.z_up ? "z" : "y") : options_.up;
    if (options_.up.empty())
      chose("up " + up_name, info_.z_up ? "customary for simulations and scans" : "customary for molecules");
    const math::Vec3d up = axis_of(up_name);
    const ViewAxes axes = view_axes(options_.look_from, up_name);
    if (options_.slice) slice(axes);
    ViewExtent extent(axes);
    visit_frames(extent, up);
    if (extent.is_empty()) out_.warnings.push_back("there is nothing to see: no frame has spheres");
    const scene::Camera camera = extent.camera(static_cast<double>(options_.width) / options_.height);
    chose("view " + options_.look_from + ", " + number_text(rounded(*camera.width)) + " wide",
          out_.frames.size() > 1 ? "fitted to the spheres of all frames" : "fitted to the spheres");
    out_.text = scene_text({options_, out_.points, camera, up, extent.center(), lowest_, extent.radius()});
    return std::move(out_);
  }

 private:
  /// A number as it is worth printing.
  static double rounded(double x) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g", x);
    return std::strtod(text, nullptr);
  }

  void chose(const std::string& what, const std::string& why) { out_.choices.push_back(what + ": " + why); }

  std::filesystem::path file_of(int frame) const { return base::with_frame(options_.file.string(), frame); }

  void open_data() {
    data::OpenOptions open_options;
    open_options.component = out_.points.component;
    const int first = options_.frames.empty() ? 1 : options_.frames.front();
    file_ = data::open(file_of(first), open_options);
    const int frame = out_.points.frame ? *out_.points.frame : is_sequence_ ? 1 : first;
    const bool exists = frame == 1 || (frame > 1 && frame <= file_->frame_count());  // load() reports the others
    info_ = file_->describe(exists ? frame - 1 : 0);
    points::add_derived_columns(info_);
    const std::string which = exists && frame > 1 ? " in frame " + std::to_string(frame) : "";
    chose(data::format_name(file_->format()), std::to_string(info_.rows) + " particles" + which);
  }

  void choose_frames() {
    out_.frames = options_.frames;
    if (!options_.all_frames) return;
    if (is_sequence_)
      throw base::Error(base::ErrorKind::kUsage,
                        "--frames: `all` are the frames of one file; for a sequence of files, write "
                        "a range, e.g. 1-48");
    const int count = file_->frame_count();
    out_.frames.resize(static_cast<std::size_t>(count));
    std::iota(out_.frames.begin(), out_.frames.end(), 1);
    chose("frames 1-" + std::to_string(count), "all of the file");
  }

  /// Loads the spheres of a frame by the keys so far.
  scene::Points load(int frame) {
    points::LoadRequest request;
    request.file = file_of(frame);
    request.folder = folder_;
    request.key = "points[0]";
    request.frame = frame;
    request.is_sequence = is_sequence_;
    request.memory_limit = options_.memory_limit;
    scene::Points points = out_.points;
    std::vector<base::Diagnostic> errors;
    for (const scene::SceneDiagnostic& d : points::load_points(request, points)) {
      const std::string key = d.key.size() > request.key.size() ? d.key.substr(request.key.size() + 1) + ": " : "";
      if (d.severity == base::Severity::kError)
        errors.push_back(base::file_diagnostic(d.severity, request.file.string(), key + d.text));
    }
    if (!errors.empty())
      throw base::Error(base::ErrorKind::kBadData, "cannot plot " + request.file.string(), std::move(errors));
    return points;
  }

  std::vector<int> visited_frames() const { return out_.frames.empty() ? std::vector<int>{1} : out_.frames; }

  /// The median distance between neighbours in the first frame where particles have neighbours; 0: in none.
  double spacing() {
    const math::Vec3d replicate = std::exchange(out_.points.replicate, {1, 1, 1});
    double distance = 0;
    for (const int frame : visited_frames())
      if (distance == 0) distance = points::median_neighbor_distance(load(frame).centers);
    out_.points.replicate = replicate;
    return distance;
  }

  void choose_radius() {
    scene::PointsRadius& radius = out_.points.radius;
    if (radius.value || !radius.column.empty() || !radius.element.empty() || !radius.types.empty()) return;
    if (!info_.roles.radius.empty()) {
      chose("radius by " + info_.roles.radius,
            info_.roles.radius_scale == 1 ? "a column of radii" : "a column of diameters, halved");
    } else if (!info_.roles.element.empty()) {
      radius.element = "vdw";
      chose("radius vdw", "van der Waals radii of the elements");
    } else {
      radius.value = 1;
      const double distance = spacing();
      if (distance > 0) radius.value = rounded(distance / 2);
      chose("radius " + number_text(*radius.value),
            distance > 0 ? "half the median distance to the nearest neighbour" : "no particle has a neighbour");
    }
  }

  void choose_color() {
    scene::PointsColor& color = out_.points.color;
    const data::Roles& roles = info_.roles;
    std::string by = options_.color_by;
    std::string why;
    if (by.empty()) {
      by = !roles.rgb[0].empty() ? "rgb" : !roles.element.empty() ? "element" : !roles.type.empty() ? "type" : "none";
      why = by == "rgb" ? "the file's own" : by == "none" ? "light grey" : "the file has no colours";
      chose(by == "none" ? "no colour" : "colour by " + by, why);
    }
    if (by == "rgb" && !has_column("rgb")) {
      color.rgb = true;
    } else if (by == "element" && options_.points.color.column.empty() && !options_.has_map) {
      color.element = "jmol";
    } else if (by == "type") {
      color.column = roles.type.empty() ? "type" : roles.type;
      if (!options_.has_map) color.map = kCategoricalMap;
    } else if (by != "none") {
      color.column = by == "element" && !roles.element.empty() ? roles.element : by;
      if (options_.has_map) return;
      color.map = is_text(color.column) ? kCategoricalMap : kMap;
      chose("map " + color.map,
            is_text(color.column) ? "colours for categories" : "no dark colours, which shading would hide");
    }
  }

  bool has_column(const std::string& name) const {
    return std::any_of(info_.columns.begin(), info_.columns.end(), [&](const auto& c) { return c.name == name; });
  }
  bool is_text(const std::string& name) const {
    return std::any_of(info_.columns.begin(), info_.columns.end(),
                       [&](const auto& c) { return c.name == name && c.type == data::ColumnType::kText; });
  }

  /// Removes the spheres on the camera's side of a plane.
  void slice(const ViewAxes& axes) {
    const auto [axis, place] = *options_.slice;
    const double back[3] = {axes.back.x, axes.back.y, axes.back.z};
    const bool is_before = back[axis] > 0;
    out_.points.clip[static_cast<std::size_t>(axis)] =
        is_before ? scene::Interval{-scene::kLargestLength, place} : scene::Interval{place, scene::kLargestLength};
  }

  /// Reads all frames once: the view contains all of them, and one range of the colour map holds for all, or a film
  /// would flicker.
  void visit_frames(ViewExtent& extent, const math::Vec3d& up) {
    const bool needs_range = !out_.points.color.column.empty() && !out_.points.color.range;
    std::optional<scene::Interval> range;
    const std::vector<int> frames = visited_frames();
    for (const int frame : frames) {
      const scene::Points points = load(frame);
      extent.add(points);
      for (std::size_t i = 0; i < points.centers.size(); ++i)
        lowest_ = std::min(lowest_, math::dot(points.centers[i], up) - std::abs(points.radii[i]));
      if (points.centers.empty()) continue;
      if (out_.points.palette.empty()) {
        out_.points.palette = points.palette;
        out_.points.palette_rec709 = points.palette_rec709;
        out_.points.color_names = points.color_names;
        out_.points.colors = points.colors;
      }
      if (!points.color_range) continue;
      if (!range) range = points.color_range;
      range->low = std::min(range->low, points.color_range->low);
      range->high = std::max(range->high, points.color_range->high);
    }
    out_.points.color_range = out_.points.color.range ? out_.points.color.range : range;
    if (!needs_range || !range) return;
    if (range->low < range->high) out_.points.color.range = range;
    chose("range " + number_text(range->low) + ":" + number_text(range->high),
          frames.size() > 1 ? "minimum and maximum over all frames" : "minimum and maximum");
  }

  const PlotOptions& options_;
  std::filesystem::path folder_;
  bool is_sequence_ = false;
  std::unique_ptr<data::DataFile> file_;
  data::FrameInfo info_;
  double lowest_ = std::numeric_limits<double>::infinity();  ///< of all spheres along the up axis, scene units
  PlotScene out_;
};

}  // namespace

PlotScene make_plot(const PlotOptions& options, const std::filesystem::path& folder) {
  return PlotMaker(options, folder).run();
}

}  // namespace orrery::plot
