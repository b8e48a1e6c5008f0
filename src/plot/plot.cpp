// SPDX-License-Identifier: Apache-2.0
#include "plot/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "annotation/annotate.h"
#include "base/error.h"
#include "base/text.h"
#include "plot/appearance.h"
#include "plot/data_frames.h"
#include "plot/named_columns.h"
#include "plot/range.h"
#include "plot/scene_text.h"
#include "plot/settings.h"
#include "plot/view.h"
#include "points/rows.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::plot {
namespace {

using scene::number_text;

/// Samples per pixel of a draft, and noise of the other qualities, unless the user limits samples, noise or time.
/// Drafts and good images are denoised: of a million atoms at 1920 x 1080, noise cannot be seen with 8 samples.
constexpr int kDraftSamples = 4;
constexpr double kGoodNoise = 0.15, kFinalNoise = 0.02;

/// A colour map or a font: the name of a file in the user's folder becomes relative to the scene's; other names stay.
std::string from_scene(const std::string& name, const std::filesystem::path& scene_file) {
  if (!scene::is_file_name(name)) return name;
  const std::filesystem::path folder = scene_file.parent_path();
  return std::filesystem::proximate(name, folder.empty() ? "." : folder).string();
}

/// "3 to 5 bonds"
std::string count_text(std::size_t fewest, std::size_t most, const char* noun) {
  return (fewest == most ? "" : fmt::format("{} to ", fewest)) + base::counted(most, noun);
}

/// Makes the scene of a plot, in the order in which the choices are printed.
class PlotMaker {
 public:
  explicit PlotMaker(const PlotOptions& options)
      : options_(options),
        data_(options, options.scene_file.parent_path(),
              [&options](const data::FrameInfo& info) { return expected_columns(options, info); }),
        info_(data_.info()),
        width_(side_of(options.overrides, "image.width", 1920)),
        height_(side_of(options.overrides, "image.height", 1080)),
        vfov_(vfov_of(options)),
        is_turntable_(options.overrides.number("animation.turntable").value_or(0) != 0),
        up_name_(options.up.empty() ? (info_.z_up ? "z" : "y") : options.up),
        up_(axis_of(up_name_)),
        outline_by_(outline_column(options, info_)),
        guides_(up_) {
    const std::filesystem::path folder = options.scene_file.parent_path();
    out_.points = options.points;
    out_.points.material_column = "";  // the scene of a plot has the materials of the options
    const auto from_folder = [&](const std::filesystem::path& file) {
      return folder.empty() || file.empty() ? file : std::filesystem::proximate(file, folder);
    };
    out_.points.file = from_folder(options.file);
    out_.points.topology = from_folder(options.points.topology);
    if (std::string& map = out_.points.color.map; options_.has_map) map = from_scene(map, options.scene_file);
    if (!outline_by_.empty()) out_.points.cryptomatte = {outline_by_};
    out_.points.frame = data_.fixed_frame();
    out_.frames = data_.numbers();
    out_.up = up_;
    const scene::PointsKeys& points = out_.points;
    std::vector<std::string> texts = texts_with_columns(options, info_);
    texts.insert(texts.end(), {points.file.string(), points.topology.string(), points.color.map, points.assembly,
                               options.annotation.title, options.annotation.unit});
    for (const std::string& text : texts) require_utf8(text);
  }

  /// Checks the request, see make_plot(). An error that the first two frames cause is that of all frames.
  void check(const std::function<void(const std::vector<int>&)>& f) {
    try {
      f(data_.numbers());
    } catch (const base::Error&) {
      data_.count();
      f(data_.numbers());
      throw;
    }
  }

  PlotScene run() {
    if (vfov_ && options_.annotation.scale_bar)
      base::refuse(
          "--scale-bar: in a perspective image, the length of an object depends on its distance; omit --perspective");
    describe_data();
    for (std::string& choice : choose_appearance(options_, data_, out_.points))
      out_.choices.push_back(std::move(choice));
    out_.material = material_of_points();
    if (!options_.points.material_where.empty())  // the scene has all of them, in their order
      out_.points.material = points::index_of_name(out_.material, material_names(), "a material");
    const ViewAxes axes = choose_view();
    for (const auto& plane : options_.slices) slice(plane, axes, out_.points);
    // A camera that looks along the up axis orbits around the vertical of its image.
    const bool is_vertical = math::length(math::cross(up_, axes.back)) < kSmallestSine;
    const math::Vec3d pole = is_turntable_ && !is_vertical && look_from_ != kAuto ? up_ : axes.up;
    // The axes of an orbit are those of the view at the height of its target.
    ViewExtent extent(is_turntable_ ? ViewAxes{axes.right, pole, math::cross(axes.right, pole)} : axes);
    const std::optional<ViewExtent> fit = extent_of(options_.fit, "--fit", axes);
    const std::optional<ViewExtent> middle = extent_of(options_.center, "--center", axes);
    clip_depth(fit ? fit : middle, axes);
    visit_frames(extent);
    if (extent.is_empty()) report_empty();
    add_guides(extent);
    const math::Vec3d target = middle ? middle->center() : fit ? fit->center() : extent.center();
    if (is_turntable_ && !extent.is_empty()) extent = orbit(axes, target, pole);
    scene::Camera camera = fitted_to(fit && !is_turntable_ ? *fit : extent);
    camera.up = pole;
    camera.shutter_close = options_.shutter;
    if (middle) look_at(target, axes, camera);
    // Parallel rays begin in front of all spheres, not only of those that the camera is fitted to.
    if (fit && !vfov_)
      camera.look_from = camera.look_at + axes.back * (extent.radius() * 2 + math::length(extent.center() - target));
    magnify(camera, options_.zoom);
    report_view(camera);
    choose_depth_cue(extent, camera);
    if (!outline_by_.empty() && options_.outline_by.empty())
      chose("outlines by " + outline_by_, "of the style; --outline-by changes it");
    choose_display_view();
    scene::Scene scene;
    scene.image.width = width_;
    scene.image.height = height_;
    scene.camera = camera;
    scene.annotation = annotation_of(camera);
    if (options_.annotation.scale_bar == 0)
      chose("scale bar " + number_text(*scene.annotation.scale_bar),
            "in units of the file; --scale-bar 'LENGTH UNIT' changes it");
    scene.color.view = out_.view;
    scene.points.push_back({out_.points, {}, {}});
    scene.rods = guides_.rods();
    const Stage stage{axes,
                      up_,
                      out_.material,
                      extent.center(),
                      extent.radius(),
                      guides_.reach(),
                      choose_ground(extent, camera),
                      light_gain()};
    if (!options_.style)
      chose("style studio", "a key light from the upper left, and white light from all directions; --style changes it");
    if (!options_.overrides.sets("image.width") && !options_.overrides.sets("image.height"))
      chose(fmt::format("size {} x {}", width_, height_), "--width and --height change it");
    choose_samples(scene.render.samples);
    out_.text = scene_text(options_, stage, std::move(scene));
    // A still image is made of one frame, whose file need not stay open.
    if (!out_.loaded) out_.open_data = out_.frames.empty() ? points::handed_over(data_.open_data()) : data_.open_data();
    return std::move(out_);
  }

 private:
  /// The view along the principal axes of what is shown.
  static constexpr const char* kAuto = "auto";
  /// Minimum sine of the angle between the camera and the up axis for an orbit around that axis.
  static constexpr double kSmallestSine = 1e-6;

  void chose(const std::string& what, const std::string& why) {
    out_.choices.push_back(fmt::format("{}: {}", what, why));
  }

  /// Data of a file format for molecules, or atoms without a simulation box.
  bool is_molecule() const { return !info_.z_up || (!info_.roles.element.empty() && !info_.box); }

  /// Image width divided by its height.
  double aspect() const { return static_cast<double>(width_) / height_; }

  void describe_data() {
    const int frame = data_.described_frame();
    const std::string which = frame > 1 ? fmt::format(" in frame {}", frame) : "";
    chose(data_.format(), fmt::format("{} particles{}", info_.rows, which));
    out_.data = info_;
  }

  std::string material_of_points() {
    if (!options_.material.empty()) return options_.material;
    const scene::PointsKeys& points = out_.points;
    const bool has_rods = points.bonds.are_drawn || !points.representation.empty() || !points.vectors.columns.empty();
    if (has_rods) chose("material plastic", "highlights show the form of rods; --material changes it");
    return has_rods ? "plastic" : "matte";
  }

  /// The axes of the view. Without one, molecules are seen along their principal axes, data that are cut by a plane
  /// from its axis, and others from above and from the side.
  ViewAxes choose_view() {
    const ViewAxes near = view_axes(kDefaultView, up_name_);
    look_from_ = options_.look_from;
    if (look_from_.empty() && options_.slices.size() == 1) {
      const int axis = options_.slices[0].first;
      const double back[3] = {near.back.x, near.back.y, near.back.z};
      look_from_ = {back[axis] < 0 ? '-' : '+', "xyz"[axis]};
    }
    if (look_from_.empty() && is_molecule() && options_.up.empty() && !options_.ground) look_from_ = kAuto;
    if (look_from_.empty() || look_from_ == kAuto) {
      std::optional<LoadedFrame> other;
      const LoadedFrame& first = first_frame(other);
      const scene::PointArray& centers = first.points.centers;
      const std::size_t count = first.points.particle_count();
      if (look_from_ == kAuto) return principal_axes(centers, count, near, aspect() < 1);
      look_from_ = are_flat(centers, count, up_) ? kFlatView : shows_cell(options_, info_) ? kCellView : kDefaultView;
    }
    if (options_.up.empty())
      chose("up " + up_name_, info_.z_up ? "customary for simulations and scans; --up changes it"
                                         : "customary for molecules; --up changes it");
    return view_axes(look_from_, up_name_);
  }

  /// The first frame of the file, which decides about the view, whichever are shown. If it is shown, visit_frames()
  /// does not read it again.
  ///
  /// `other`    holds the frame if it is not shown
  const LoadedFrame& first_frame(std::optional<LoadedFrame>& other) {
    const int first = data_.is_sequence() ? data_.all().front() : 1;
    const bool is_shown = data_.fixed_frame().value_or(data_.all().front()) == first && options_.slices.empty() &&
                          options_.fit.empty() && !options_.near && !options_.far;
    if (is_shown) return first_.emplace(load_frame(data_.all().front()));
    scene::PointsKeys keys = selected(options_.fit);
    if (!data_.is_sequence()) keys.frame = first;
    return other.emplace(data_.load(first, keys));
  }

  /// Reads a frame that is shown, and the values for the range of the colour map.
  LoadedFrame load_frame(int frame) {
    if (first_) return *std::exchange(first_, std::nullopt);
    const auto on_value = needs_range() ? [&](double value) { finder_.add(value); } : std::function<void(double)>();
    return data_.load(frame, out_.points, nullptr, on_value);
  }

  bool needs_range() const { return !out_.points.color.column.empty() && !out_.points.color.range; }

  void report_view(const scene::Camera& camera) {
    chose(fmt::format("view {}, {}", look_from_,
                      vfov_ ? fmt::format("vertical field of view {}", number_text(rounded(camera.vfov)))
                            : number_text(rounded(*camera.width)) + " wide"),
          fmt::format("{}fitted to {}{}{}{}; --look-from and --zoom change it",
                      look_from_ == kAuto ? "along the principal axes of what is shown; " : "",
                      options_.fit.empty() ? "the spheres" : "those of --fit",
                      out_.frames.size() > 1 ? " of all frames" : "", is_turntable_ ? " and the whole orbit" : "",
                      options_.zoom == 1 ? "" : ", times " + number_text(options_.zoom)));
  }

  /// In sequences the range is that of all frames, so that colours do not flicker.
  void choose_depth_cue(const ViewExtent& extent, scene::Camera& camera) {
    constexpr double kExactPart = 0.1;
    // In a cut object, the light shows the depth, and the cue would only make what is in the shade grey.
    const bool is_default = (is_molecule() && options_.slices.empty()) || options_.style == Style::kIllustration;
    camera.depth_cue = options_.depth_cue.value_or(is_default ? kDepthCue : 0);
    if (camera.depth_cue == 0 || extent.is_empty()) return;
    if (out_.frames.size() > 1 || is_turntable_) {
      const scene::Interval depths = extent.depths(camera);
      camera.depth_cue_range = scene::Interval{depths.low + kExactPart * (depths.high - depths.low), depths.high};
    }
    if (!options_.depth_cue)
      chose("depth cue " + number_text(camera.depth_cue), "for molecules; --depth-cue 0 keeps the colours at the back");
  }

  /// The factor of the light. In a pile of spheres, each is in the shade of others, and half as bright as alone.
  double light_gain() {
    constexpr std::size_t kPile = 500;
    constexpr double kStops = 0.4;
    const Style style = options_.style.value_or(Style::kStudio);
    const bool is_shaded = style == Style::kStudio || style == Style::kSoft || style == Style::kIllustration;
    if (!is_shaded || options_.exact_colors || out_.points.bonds.are_drawn || largest_count_ < kPile) return 1;
    chose(fmt::format("light +{} stops", kStops), "the spheres shade each other; --exact-colors omits it");
    return std::exp2(kStops);
  }

  std::optional<Ground> choose_ground(const ViewExtent& extent, const scene::Camera& camera) {
    if (!options_.ground || extent.is_empty()) return {};
    const Ground out = ground_below(guides_.lowest(), up_, extent);
    if (!hides_view(out, camera, aspect())) return out;
    chose("no ground", fmt::format("it would hide the spheres from {}; look from further above", look_from_));
    return {};
  }

  /// Which frames are shown, printed after the number of particles. Counted after the first one has been read, so that
  /// its rows are not read twice.
  void choose_frames() {
    out_.frame_count = data_.frame_count();
    const std::optional<int> count = out_.frame_count, frame = options_.points.frame;
    const bool is_first = out_.frames.empty() && !frame;
    std::string text;
    if (options_.all_frames)
      text = fmt::format("frames 1-{}: all of the file", out_.frames.size());
    else if (out_.frames.empty() && frame && *frame < 0)
      text = fmt::format("frame {}: --frame {}", data_.described_frame(), *frame);
    else if (is_first && !count)
      text = "frame 1: the first; --frame N selects another";
    else if (is_first && *count > 1)
      text = fmt::format("frame 1 of {}: the first; --frames all renders all of them", *count);
    if (!text.empty()) out_.choices.insert(out_.choices.begin() + 1, text);
  }

  /// The options that select spheres; empty: none does.
  std::string selection() const {
    std::vector<std::string> out;
    if (!options_.points.select.empty()) out.emplace_back("--select");
    if (!options_.slices.empty()) out.emplace_back("--slice");
    if (options_.near) out.emplace_back("--near");
    if (options_.far) out.emplace_back("--far");
    if (!out_.points.representation.empty()) out.emplace_back("--representation");
    return base::joined(out);
  }

  /// Reports that there are no spheres: an error, unless the user allows it.
  void report_empty() {
    const std::size_t frames = out_.frames.size();
    const std::string options = selection();
    const std::optional<int> count = data_.frame_count();
    std::string what, remedy;
    if (frames > 1) {
      what = fmt::format("none of the {} frames has spheres{}{}", frames, options.empty() ? "" : " with ", options);
    } else if (info_.rows > 0) {
      what = fmt::format("{} leaves none of the {} particles",
                         !options.empty()                   ? options
                         : options_.points.assembly.empty() ? "--skip-bad"
                                                            : "--assembly",
                         info_.rows);
      remedy = fmt::format("`orrery info {}` lists the columns and their values",
                           base::shell_quoted(options_.file.string()));
    } else if (count == 1 || data_.is_sequence()) {
      what = "the file has no particles";
    } else {
      what = fmt::format("frame {}{} has no particles", data_.described_frame(),
                         count ? fmt::format(" of {}", *count) : "");
      remedy = "--frame N selects another, --frames all renders all";
    }
    what = "nothing to render: " + what;
    if (options_.allow_empty) return out_.warnings.push_back(what);
    throw base::Error(base::ErrorKind::kBadData, fmt::format("{}; {}{}--allow-empty renders the background alone", what,
                                                             remedy, remedy.empty() ? "" : ", "));
  }

  /// Prints how many bonds are drawn, and from what.
  void report_bonds(std::size_t fewest, std::size_t most) {
    const scene::PointsBonds& bonds = out_.points.bonds;
    if (!bonds.are_drawn) return;
    std::vector<std::string> from;
    if (bonds_from_ != "distance") from.emplace_back("those of the file");
    if (bonds_from_ != "file")
      from.push_back(bonds.length ? "closer than " + number_text(*bonds.length)
                                  : fmt::format("closer than {} times the sum of the covalent radii",
                                                number_text(bonds.factor.value_or(scene::kDefaultBondFactor))));
    chose(count_text(fewest, most, "bond"), base::joined(from));
  }

  /// The annotation, with paths relative to the scene. A scale bar without a length gets the largest of 1, 2 and 5
  /// times a power of ten that takes up to a fifth of the image.
  scene::Annotation annotation_of(const scene::Camera& camera) const {
    constexpr double kLargestShare = 0.2;
    constexpr double kOutlineShare = 1.0 / 400;  // of the height: the same figure in any resolution
    scene::Annotation out = options_.annotation;
    out.font = from_scene(out.font.string(), options_.scene_file);
    out.outline_objects = !outline_by_.empty();
    if (out.outline == 0 && (out.outline_objects || out.outline_depth > 0 || options_.style == Style::kIllustration))
      out.outline = rounded(kOutlineShare * height_);
    if (out.scale_bar == 0) {
      const double most = kLargestShare * camera.width.value_or(1), power = std::pow(10, std::floor(std::log10(most)));
      const double digit = std::floor(most / power);
      out.scale_bar = rounded((digit >= 5 ? 5 : digit >= 2 ? 2 : 1) * power);
    }
    return out;
  }

  /// The camera that sees all spheres beside the annotation.
  scene::Camera fitted_to(const ViewExtent& extent) const {
    return extent.camera(aspect(), vfov_, reserved_by_annotation(extent.camera(aspect(), vfov_)));
  }

  /// What text and bars take from the image that a camera sees.
  std::vector<Reserved> reserved_by_annotation(const scene::Camera& camera) const {
    constexpr double kGap = 0.01;  // between annotation and spheres, in heights of the image
    scene::Scene scene;
    scene.camera = camera;
    scene.annotation = annotation_of(camera);
    scene.points.emplace_back().header = header_;
    const annotation::View view{width_, height_, data_.described_frame(), options_.scene_file.parent_path(), {}};
    const double gap = kGap * height_, middle_x = width_ / 2.0, middle_y = height_ / 2.0;
    std::vector<Reserved> out;
    for (const annotation::Box& box : annotation::covered_by(annotation::drawing_of(scene, out_.legend, view)))
      out.push_back({(std::max(box.left - middle_x, middle_x - box.right) - gap) / width_,
                     (std::max(box.top - middle_y, middle_y - box.bottom) - gap) / height_});
    return out;
  }

  /// Chooses the view of the display: with a shoulder for light and shade, unless exact colours are wanted.
  void choose_display_view() {
    const display::Settings display = display_of(options_);
    out_.view = display.view;
    if (!out_.view.empty()) return;
    const Style style = options_.style.value_or(Style::kStudio);
    const bool is_exact = options_.exact_colors || style == Style::kFlat || style == Style::kAmbient;
    if (!is_exact) out_.view = display::view_or_default(display, kNeutralView);
    if (out_.view != kNeutralView) out_.view = display::view_or_default(display, kPlainView);
    if (out_.view == kNeutralView && options_.develops)
      chose("view transform " + out_.view, "bright colours are compressed; --exact-colors keeps them");
    if (out_.view == kPlainView && options_.develops)
      chose("view transform " + out_.view, "colours match the colour map");
    if (out_.view != kNeutralView && out_.view != kPlainView)
      chose("view transform " + out_.view, std::string("the default; the OCIO config has no view ") + kPlainView);
  }

  void choose_samples(int& samples) {
    if (options_.has_target || options_.overrides.sets("render.samples")) {
      if (options_.quality) base::refuse("--quality excludes --noise, --time and --samples: it sets them");
      return;
    }
    if (options_.style == Style::kFlat && !options_.quality)
      return chose("samples 100", "without shading there is hardly any noise; --samples changes it");
    const Quality quality = options_.quality.value_or(Quality::kGood);
    out_.denoise = quality != Quality::kFinal && options_.style != Style::kFlat;
    std::string what;
    if (quality == Quality::kDraft) {
      samples = kDraftSamples;
      what = fmt::format("{} samples", kDraftSamples);
    } else {
      out_.noise = quality == Quality::kGood ? kGoodNoise : kFinalNoise;
      what = fmt::format("noise {}", *out_.noise);
    }
    chose(
        "quality " + quality_names()[static_cast<std::size_t>(quality)],
        fmt::format("{}{}; --quality, --noise, --time or --samples change it", what, out_.denoise ? ", denoised" : ""));
  }

  /// The keys, but only of the particles that also meet a condition.
  scene::PointsKeys selected(const std::string& condition) const {
    scene::PointsKeys out = out_.points;
    if (!condition.empty())
      out.select = all_of(out.select.empty() ? std::vector{condition} : std::vector{out.select, condition});
    return out;
  }

  /// The extent of the particles that an option selects, in all frames; none without it.
  std::optional<ViewExtent> extent_of(const std::string& condition, const char* option, const ViewAxes& axes) {
    if (condition.empty()) return {};
    ViewExtent out(axes);
    data_.visit([&](int frame) { out.add(data_.load(frame, selected(condition)).points); });
    if (out.is_empty())
      throw base::Error(base::ErrorKind::kBadData,
                        fmt::format("{} `{}` matches none of the particles that are drawn", option, condition));
    return out;
  }

  /// Removes the particles further in front of the target, or behind it, than --near and --far say: by a condition on
  /// their coordinates.
  void clip_depth(const std::optional<ViewExtent>& target, const ViewAxes& axes) {
    if (!options_.near && !options_.far) return;
    const char* const option = options_.near ? "--near" : "--far";
    if (!target)
      base::refuse(fmt::format("{} is a distance from a target; add --fit CONDITION or --center CONDITION", option));
    const scene::PointsKeys& points = out_.points;
    if (points.unwrap || !points.assembly.empty() || !(points.replicate == math::Vec3d{1, 1, 1}))
      base::refuse(fmt::format(
          "{} excludes --assembly, --replicate and --unwrap: it selects by the coordinates of the file", option));
    const std::array<std::string, 3>& position = info_.roles.position;
    const std::string depth = fmt::format("`{}` * ({}) + `{}` * ({}) + `{}` * ({})", position[0], axes.back.x,
                                          position[1], axes.back.y, position[2], axes.back.z);
    const auto [back, front] = target->depth();
    std::vector<std::string> conditions;
    if (!points.select.empty()) conditions.push_back(points.select);
    if (options_.near) conditions.push_back(fmt::format("{} <= {}", depth, front + *options_.near));
    if (options_.far) conditions.push_back(fmt::format("{} >= {}", depth, back - *options_.far));
    out_.points.select = all_of(conditions);
  }

  /// Reads all frames once, so that the view contains all of them and a single range of the colour map avoids flicker.
  void visit_frames(ViewExtent& extent) {
    std::size_t fewest = std::numeric_limits<std::size_t>::max(), most = 0, fewest_bonds = fewest, most_bonds = 0;
    data_.visit([&](int frame) {
      LoadedFrame loaded = load_frame(frame);
      const scene::Points& points = loaded.points;
      fewest = std::min(fewest, points.particle_count());
      most = std::max(most, points.particle_count());
      // Two stubs are a bond.
      const std::size_t bonds = points.bond_pairs.size() - points.arrow_count + points.bond_stubs.size() / 2;
      fewest_bonds = std::min(fewest_bonds, bonds);
      most_bonds = std::max(most_bonds, bonds);
      bonds_from_ = points.bonds_from;
      header_ = points.header;
      extent.add(points);
      guides_.surround(points);
      if (!points.centers.empty()) out_.legend.add(points, points.palette);
      if (out_.frames.empty())
        out_.loaded = std::make_shared<points::LoadedPoints>(
            points::LoadedPoints{frame, std::move(loaded.points), std::move(loaded.diagnostics)});
    });
    out_.frames = data_.numbers();
    choose_frames();
    largest_count_ = most;
    report_count(fewest, most);
    report_bonds(fewest_bonds, most_bonds);
    if (!finder_.is_empty()) out_.legend.range = finder_.range();
    if (out_.points.color.range) out_.legend.range = out_.points.color.range;
    if (out_.legend.has_conflict)
      out_.warnings.push_back(
          fmt::format("colour by {}: the frames do not have the same values, and one value has different colours in "
                      "different frames; colour by a column of integers",
                      out_.legend.title));
    if (needs_range() && !finder_.is_empty()) {
      choose_range(*out_.legend.range, finder_.crowded());
      out_.loaded.reset();  // read without the range, so in other colours
    }
  }

  /// `crowded`  see RangeFinder
  void choose_range(const scene::Interval& range, const std::optional<scene::Interval>& crowded) {
    if (range.low < range.high) out_.points.color.range = range;
    const RangeChoice& choice = options_.range;
    const auto end_text = [](const RangeChoice::End& end) {
      return number_text(end.value) + (end.is_percentile ? "%" : "");
    };
    const bool is_default =
        choice.low.is_percentile && choice.low.value == 0 && choice.high.is_percentile && choice.high.value == 100;
    chose("range " + range_text(range),
          fmt::format(
              "{}{}{}{}{}",
              is_default ? "minimum and maximum" : fmt::format("{} to {}", end_text(choice.low), end_text(choice.high)),
              out_.frames.size() > 1 ? " over all frames" : "", choice.is_symmetric ? ", symmetric" : "",
              choice.is_log ? ", logarithmic" : "",
              crowded
                  ? fmt::format("; 99 % of the values are within {}, which --range 1%:99% shows", range_text(*crowded))
              : is_default ? "; --range changes it"
                           : ""));
  }

  /// Prints how many spheres are drawn, next to the number of particles, where they differ.
  void report_count(std::size_t fewest, std::size_t most) {
    if (most == info_.rows && fewest == most) return;
    std::vector<std::string> why;
    if (!options_.points.assembly.empty()) why.push_back("assembly " + options_.points.assembly);
    if (!(options_.points.replicate == math::Vec3d{1, 1, 1})) why.emplace_back("--replicate");
    if (info_.is_unit_cell && out_.points.bonds.are_drawn)
      why.emplace_back("atoms on faces of the cell at each of them");
    if (const std::string options = selection(); !options.empty()) why.push_back(options);
    if (why.empty()) why.emplace_back(fewest == most ? "--skip-bad" : "the fewest and the most of all frames");
    out_.choices.insert(out_.choices.begin() + 1,
                        fmt::format("{}: {}", count_text(fewest, most, "sphere"), base::joined(why)));
  }

  /// Adds the edges of the simulation box and the axes, and the space that they take.
  void add_guides(ViewExtent& extent) {
    const bool is_cell = shows_cell(options_, info_);
    if (options_.box || is_cell) {
      if (!info_.box)
        throw base::Error(base::ErrorKind::kBadData,
                          fmt::format("--box: {} has no simulation box", options_.file.string()));
      guides_.add_box(*info_.box, options_.points.replicate, extent);
      if (out_.frames.size() > 1) chose("box", fmt::format("that of frame {}", data_.described_frame()));
    }
    if ((options_.axes || is_cell) && !extent.is_empty()) {
      guides_.add_axes(extent, info_.is_unit_cell ? info_.box : std::nullopt);
      chose("axes", info_.is_unit_cell ? "a red, b green, c blue" : "x red, y green, z blue");
    }
    extent.add(guides_.ends());
  }

  /// The space that the spheres of all frames pass through on the orbit of the camera.
  ViewExtent orbit(const ViewAxes& axes, const math::Vec3d& pivot, const math::Vec3d& pole) {
    ViewExtent out(axes);
    const scene::PointsKeys keys = selected(options_.fit);
    data_.visit([&](int frame) { out.add_orbits(data_.load(frame, keys).points, pivot, pole); });
    if (options_.fit.empty()) out.add_orbits(guides_.ends(), pivot, pole);
    return out;
  }

  const PlotOptions& options_;
  DataFrames data_;
  const data::FrameInfo& info_;
  int width_, height_;          ///< px
  std::optional<double> vfov_;  ///< degrees: a perspective camera; otherwise orthographic
  bool is_turntable_;           ///< the camera orbits around the up axis
  std::string up_name_;         ///< "x", "y" or "z"
  math::Vec3d up_;
  std::string outline_by_;  ///< column that divides the outlines; empty: none does
  Guides guides_;
  std::string look_from_;  ///< the view that was chosen
  RangeFinder finder_{options_.range};
  std::optional<LoadedFrame> first_;  ///< the first frame to be shown, if it has been read
  std::string bonds_from_;            ///< see scene::PointsFindings
  scene::HeaderNumbers header_;       ///< see scene::PointsFindings
  std::size_t largest_count_ = 0;     ///< of particles in a frame
  PlotScene out_;
};

}  // namespace

PlotScene make_plot(const PlotOptions& options, const std::function<void(const std::vector<int>& frames)>& check) {
  PlotMaker maker(options);
  if (check) maker.check(check);
  return maker.run();
}

}  // namespace orrery::plot
