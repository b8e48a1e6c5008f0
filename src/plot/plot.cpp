// SPDX-License-Identifier: Apache-2.0
#include "plot/plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "data/data_file.h"
#include "display/look_up.h"
#include "plot/data_frames.h"
#include "plot/loaded_frame.h"
#include "plot/scene_text.h"
#include "plot/view.h"
#include "points/color_map.h"
#include "points/spacing.h"
#include "scene/value_text.h"

namespace orrery::plot {
namespace {

using scene::number_text;

/// Scenes are TOML, which is UTF-8.
void require_utf8(const std::string& text) {
  for (std::size_t at = 0, length = 1; at < text.size(); at += std::max<std::size_t>(length, 1)) {
    length = base::printable_length(text, at);
    if (length == 0 && static_cast<unsigned char>(text[at]) >= 0x80)
      base::refuse(fmt::format("`{}` is not valid UTF-8, and a scene cannot name it; rename the file or the column",
                               base::printable(text)));
  }
}

/// A points table of the scene as its author would write it, completed step by step.
class PlotMaker {
 public:
  PlotMaker(const PlotOptions& options, const std::filesystem::path& folder)
      : options_(options), data_(options, folder), info_(data_.info()) {
    out_.points = options.points;
    out_.points.material_column = "";  // the scene of a plot has one material
    out_.points.file = folder.empty() ? options.file : std::filesystem::proximate(options.file, folder);
    // A colour map in a file is relative to the user's folder; in the scene it is relative to the scene's.
    if (std::string& map = out_.points.color.map; options_.has_map && map.find_first_of("./") != std::string::npos)
      map = std::filesystem::proximate(map, folder.empty() ? "." : folder).string();
    out_.frames = data_.numbers();
    const scene::Points& points = out_.points;
    for (const std::string& text : {points.file.string(), options.color_by, points.color.column, points.color.map,
                                    points.radius.column, points.select, points.assembly})
      require_utf8(text);
  }

  const std::vector<int>& frames() const { return out_.frames; }

  PlotScene run() {
    const int frame = data_.described_frame();
    const std::string which = frame > 1 ? fmt::format(" in frame {}", frame) : "";
    chose(data::format_name(data_.format()), fmt::format("{} particles{}", info_.rows, which));
    choose_frame();
    // Determining the radius from the spacing requires reading the file, so the colour options are checked first.
    const std::vector<std::string> color_choices = choose_color();
    choose_radius();
    out_.choices.insert(out_.choices.end(), color_choices.begin(), color_choices.end());
    const std::string up_name = options_.up.empty() ? (info_.z_up ? "z" : "y") : options_.up;
    if (options_.up.empty())
      chose("up " + up_name, info_.z_up ? "customary for simulations and scans" : "customary for molecules");
    const math::Vec3d up = axis_of(up_name);
    const ViewAxes axes = view_axes(options_.look_from, up_name);
    if (options_.slice) slice(*options_.slice, axes, out_.points);
    ViewExtent extent(axes);
    visit_frames(extent, up);
    if (extent.is_empty()) out_.warnings.push_back("nothing to render: " + empty_scene_reason());
    const double aspect = static_cast<double>(options_.width) / options_.height;
    const scene::Camera camera = extent.camera(aspect);
    chose(fmt::format("view {}, {} wide", options_.look_from, number_text(rounded(*camera.width))),
          out_.frames.size() > 1 ? "fitted to the spheres of all frames" : "fitted to the spheres");
    choose_display_view();
    PlotParts parts{options_, out_.points, camera, out_.view, extent.center(), extent.radius(), {}};
    if (options_.ground && !extent.is_empty()) {
      parts.ground = ground_below(lowest_, up, extent);
      if (hides_view(*parts.ground, camera, aspect)) {
        parts.ground.reset();
        chose("no ground",
              fmt::format("it would hide the spheres from {}; look from further above", options_.look_from));
      }
    }
    if (!options_.has_style) chose("style studio", "white light from all directions");
    if (!options_.has_size)
      chose(fmt::format("size {} x {}", options_.width, options_.height), "--width and --height change it");
    out_.text = scene_text(parts);
    return std::move(out_);
  }

 private:
  /// Formats a number with a sensible number of digits.
  static double rounded(double x) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g", x);
    return std::strtod(text, nullptr);
  }

  void chose(const std::string& what, const std::string& why) {
    out_.choices.push_back(fmt::format("{}: {}", what, why));
  }

  /// A still image of a file with several frames: which one it shows.
  void choose_frame() {
    if (options_.all_frames) chose(fmt::format("frames 1-{}", out_.frames.size()), "all of the file");
    if (!out_.frames.empty() || options_.points.frame) return;
    const std::optional<int> count = data_.frame_count();
    if (count && *count > 1)
      chose(fmt::format("frame 1 of {}", *count), "the first; --frames all renders all of them");
    else if (!count)
      chose("frame 1", "the first; --frame N selects another");
  }

  /// Describes what has no spheres, and what to do.
  std::string empty_scene_reason() const {
    if (out_.frames.size() > 1) return fmt::format("none of the {} frames has spheres", out_.frames.size());
    const std::optional<int> count = data_.frame_count();
    if (count == 1 || data_.is_sequence())
      return std::string(options_.points.select.empty() ? "the file" : "the selection") + " has no spheres";
    return fmt::format("frame {}{} has no spheres; --frame N selects another, --frames all renders all",
                       data_.described_frame(), count ? fmt::format(" of {}", *count) : "");
  }

  scene::Points load(int frame) const { return data_.load(frame, out_.points).points; }

  /// The median distance between neighbours in the first frame where particles have neighbours; 0: in none.
  double spacing() {
    const math::Vec3d replicate = std::exchange(out_.points.replicate, {1, 1, 1});
    double distance = 0;
    for (const int frame : data_.all())
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
      if (distance > 0) radius.value = distance / 2;
      radius.value = rounded(*radius.value * radius.scale);
      chose("radius " + number_text(*radius.value),
            std::string(distance > 0 ? "half the median distance to the nearest neighbour"
                                     : "no particle has a neighbour") +
                (radius.scale == 1 ? "" : "; scaled by " + number_text(radius.scale)));
    }
  }

  /// Result     the choices, to be printed after those of the radius
  std::vector<std::string> choose_color() {
    scene::PointsColor& color = out_.points.color;
    const data::Roles& roles = info_.roles;
    std::string by = options_.color_by;
    std::string why;
    std::vector<std::string> out;
    if (by.empty()) {
      by = !roles.rgb[0].empty() ? "rgb" : !roles.element.empty() ? "element" : !roles.type.empty() ? "type" : "none";
      why = by == "rgb" ? "the file's own" : by == "none" ? "light grey" : "the file has no colours";
      out.push_back(fmt::format("{}: {}", by == "none" ? "no colour" : "colour by " + by, why));
    }
    if (set_color(options_, by, info_, color))
      out.push_back(fmt::format("map {}: {}", color.map,
                                points::find_color_map(color.map)->is_categorical
                                    ? "colours for categories"
                                    : "no dark colours, which shading would hide"));
    return out;
  }

  /// A view without tone mapping, which preserves the colours of the colour map.
  void choose_display_view() {
    out_.view = options_.display.view;
    if (!out_.view.empty()) return;
    out_.view = display::view_or_default(options_.display, kPlainView);
    if (out_.view != kPlainView)
      chose("display view " + out_.view, std::string("the default; the OCIO config has no view ") + kPlainView);
  }

  /// Reads all frames once, so that the view contains all of them and a single range of the colour map avoids flicker.
  void visit_frames(ViewExtent& extent, const math::Vec3d& up) {
    const bool needs_range = !out_.points.color.column.empty() && !out_.points.color.range;
    std::optional<scene::Interval> range;
    for (const int frame : data_.all()) {
      const scene::Points points = load(frame);
      extent.add(points);
      for (std::size_t i = 0; i < points.centers.size(); ++i)
        lowest_ = std::min(lowest_, math::dot(points.centers[i], up) - std::abs(points.radii[i]));
      if (points.centers.empty()) continue;
      out_.legend.add(points);
      widen(range, points);
    }
    out_.legend.range = out_.points.color.range ? out_.points.color.range : range;
    if (out_.legend.has_conflict)
      out_.warnings.push_back(
          fmt::format("colour by {}: the frames do not have the same values, and one value has different colours in "
                      "different frames; colour by a column of integers",
                      out_.legend.title));
    if (!needs_range || !range) return;
    if (range->low < range->high) out_.points.color.range = range;
    chose(fmt::format("range {}:{}", number_text(range->low), number_text(range->high)),
          out_.frames.size() > 1 ? "minimum and maximum over all frames" : "minimum and maximum");
  }

  const PlotOptions& options_;
  DataFrames data_;
  const data::FrameInfo& info_;
  double lowest_ =
      std::numeric_limits<double>::infinity();  ///< lowest point of all spheres along the up axis, scene units
  PlotScene out_;
};

}  // namespace

PlotScene make_plot(const PlotOptions& options, const std::filesystem::path& folder,
                    const std::function<void(const std::vector<int>& frames)>& check) {
  PlotMaker maker(options, folder);
  if (check) check(maker.frames());
  return maker.run();
}

}  // namespace orrery::plot
