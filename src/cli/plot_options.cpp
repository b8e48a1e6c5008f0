// SPDX-License-Identifier: Apache-2.0
#include "cli/plot_options.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/frames.h"
#include "base/image_limits.h"
#include "base/text.h"
#include "job/job.h"
#include "plot/range.h"
#include "points/color_map.h"
#include "points/rules.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::cli {
namespace {

/// The value of "CONDITION: VALUE" or "VALUE" of an option, which errors name.
///
/// `parse`    value of a text; throws base::Error
auto value_of(const char* option, const std::string& text, const auto& parse) {
  try {
    return parse(points::split_rule(text).second);
  } catch (const base::Error& error) {
    base::refuse(fmt::format("{}: {}", option, error.what()));
  }
}

/// Adds a rule "CONDITION: VALUE" of an option to those before it.
///
/// `parse`    see value_of()
/// Result     false if the text has no condition
bool add_rule(const char* option, const std::string& text, const auto& parse, std::vector<std::string>& rules) {
  if (points::end_of_expression(text) == std::string::npos) return false;
  static_cast<void>(value_of(option, text, parse));
  rules.push_back(text);
  return true;
}

/// Adds an --opacity to those before it. One without a condition matches all particles, so that it replaces them.
void read_opacity(const std::string& text, scene::PointsOpacity& opacity) {
  if (add_rule("--opacity", text, points::parse_opacity, opacity.where)) {
    if (opacity.value) opacity.where.insert(opacity.where.end() - 1, scene::number_text(*opacity.value));
    opacity.value.reset();
    return;
  }
  opacity = {};
  opacity.value = base::number_of<double>(text);
  if (!opacity.value)
    opacity.column = text;
  else if (!(*opacity.value >= 0 && *opacity.value <= 1))
    base::refuse(fmt::format("--opacity: {} must be in 0..1", text));
}

void read_radius(const std::string& text, scene::PointsRadius& radius) {
  if (add_rule("--radius", text, points::parse_radius, radius.where)) return;
  radius.column.clear();
  radius.value = base::number_of<double>(text);
  if (!radius.value) {
    radius.column = text;
    return;
  }
  if (!(*radius.value > 0) || !std::isfinite(*radius.value)) base::refuse("--radius: must be above 0");
  if (radius.scale != 1)
    base::refuse("--radius-scale applies to radii of the data; scale the number in --radius instead");
}

/// Adds a --representation to those before it. One without a condition matches all particles, so that it replaces them.
void read_representation(const std::string& text, plot::PlotOptions& plot) {
  std::vector<std::string>& rules = plot.points.representation;
  if (add_rule("--representation", text, points::parse_representation, rules)) return;
  rules.clear();
  plot.representation = value_of("--representation", text, points::parse_representation);
}

/// Adds a --material to those before it, as read_representation().
void read_material(const std::string& text, plot::PlotOptions& plot) {
  const auto parse = [](const std::string& name) {
    return points::index_of_name(name, plot::material_names(), "a material");
  };
  if (add_rule("--material", text, parse, plot.points.material_where)) return;
  plot.points.material_where.clear();
  plot.material = plot::material_names()[value_of("--material", text, parse)];
}

/// The number of a frame, from 1; below 0 it is counted from the end.
int frame_of(const std::string& text) {
  constexpr int kMost = 2'000'000'000;
  const int frame = text == "last" ? -1 : base::number_of<int>(text).value_or(0);
  if (frame == 0 || std::abs(frame) > kMost)
    base::refuse(fmt::format("--frame: `{}` is not a frame; write a number from 1 to {}, or last", text, kMost));
  return frame;
}

math::Vec3d copies_of(const std::string& text) {
  std::vector<double> counts;
  std::istringstream words(text + ',');
  for (std::string word; std::getline(words, word, ',');)
    counts.push_back(base::number_of<double>(word).value_or(std::nan("")));
  if (counts.size() != 3 || !std::all_of(counts.begin(), counts.end(), [](double n) { return std::isfinite(n); }))
    base::refuse(fmt::format("--replicate: `{}` must be three numbers of copies, e.g. 2,2,1", text));
  for (const double n : counts)
    if (!(n >= 1 && n <= scene::kMaxCopies && n == std::floor(n)))
      base::refuse(fmt::format("--replicate: the numbers of copies must be integers from 1 to {}", scene::kMaxCopies));
  return {counts[0], counts[1], counts[2]};
}

std::pair<int, double> slice_of(const std::string& text) {
  const bool is_of_axis = text.size() > 2 && text[0] >= 'x' && text[0] <= 'z' && text[1] == '=';
  const auto position = base::number_of<double>(is_of_axis ? text.substr(2) : "");
  if (!position || !std::isfinite(*position))
    base::refuse(fmt::format("--slice: `{}` is not a plane; write AXIS=POSITION, e.g. z=10", text));
  return {text[0] - 'x', *position};
}

/// Adds the options of the camera.
void add_view_options(Command& command, plot::PlotOptions& plot) {
  const OptionGroup group(command, kViewOptions);
  command
      .add_option(
          "--look-from", plot.look_from, "VIEW",
          "View: auto, iso, +x, -x, +y, -y, +z, -z, or azimuth and elevation in degrees; default: auto or 30,20")
      ->details(
          "auto, the default for molecules: along the direction in which they are least extended. 30,20, the default "
          "for "
          "others: from 30 degrees to the right of the front and 20 degrees above; 30,40 for flat data; with one "
          "--slice: from its axis. iso: 45 and 35.26 degrees.");
  command.add_option("--zoom", plot.zoom, "X", "Magnification, relative to the view that shows all; default: 1")
      ->check(real_number(1e-3, 1e6));
  command.add_option("--fit", plot.fit, "CONDITION",
                     "Fit the camera to the particles that match, e.g. 'within 5 of (residue HEM)'");
  command
      .add_option("--near", plot.near, "X",
                  "Remove the particles that are more than X in front of those of --fit or --center")
      ->check(real_number(0, scene::kLargestLength));
  command.add_option("--far", plot.far, "X", "Remove the particles that are more than X behind them")
      ->check(real_number(0, scene::kLargestLength));
  command.add_option("--center", plot.center, "CONDITION",
                     "Look at the middle of the particles that match, e.g. 'residue == \"HEM\"'");
  command
      .add_option("--perspective", plot.vfov_deg, "VFOV",
                  "Perspective camera with this vertical field of view in degrees, e.g. 30; default: orthographic")
      ->check(real_number(0.1, 170));
  command.add_option("--up", plot.up, "AXIS", "Axis that points up in the image; default: z, y for PDB and mmCIF")
      ->choices({"x", "y", "z"});
}

/// Parses "auto", "20", "20 nm" or "20nm".
void read_scale_bar(const std::string& text, scene::Annotation& annotation) {
  if (text.empty()) return;
  double length = 0;
  const char* const end = text.data() + text.size();
  const char* unit = text == "auto" ? end : std::from_chars(text.data(), end, length).ptr;
  const bool has_unit = unit == end || *unit == ' ' || std::isalpha(static_cast<unsigned char>(*unit)) || *unit < 0;
  if (text != "auto" && !(length >= scene::kSmallestRadius && length <= scene::kLargestLength && has_unit))
    base::refuse(
        fmt::format("--scale-bar: `{}` is not a length; write auto, or a length above 0, with or without a unit, e.g. "
                    "20 or '20 nm'",
                    text));
  annotation.scale_bar = length;
  if (unit != end && *unit == ' ') ++unit;
  annotation.unit.assign(unit, end);
}

/// Sets the size of the image from its width in print and its resolution.
void set_print_width(const std::string& text, SceneOptions& scene) {
  if (text.empty()) return;
  const load::Overrides overrides = scene.overrides();
  double length = 0;
  const char* const end = text.data() + text.size();
  const std::string unit(std::from_chars(text.data(), end, length).ptr, end);
  const double inches = unit == "in" ? 1 : unit == "cm" ? 1 / 2.54 : unit == "mm" ? 1 / 25.4 : 0;
  if (!(length > 0) || inches == 0)
    base::refuse(fmt::format("--print-width: `{}` is not a length; write e.g. 8.5cm, 85mm or 3.3in", text));
  const std::optional<double> dpi = overrides.number("image.dpi");
  if (!dpi) base::refuse("--print-width: the number of pixels depends on the resolution; add --dpi, e.g. --dpi 300");
  if (overrides.sets("image.width")) base::refuse("--print-width and --width exclude each other");
  const double width = length * inches * *dpi;
  if (!(width >= 1 && width <= base::kLargestSide))
    base::refuse(fmt::format("--print-width {} at {} dpi is {:.0f} pixels; it must be 1 to {}", text, *dpi, width,
                             base::kLargestSide));
  scene.set(fmt::format("image.width={:.0f}", width));
  constexpr double kAspect = 16.0 / 9;  // that of the default size
  if (!overrides.sets("image.height")) scene.set(fmt::format("image.height={:.0f}", std::max(1.0, width / kAspect)));
}

/// Parses --bonds, except none and auto.
void read_bonds(const std::string& text, scene::PointsBonds& bonds) {
  if (text == "file" || text == "distance" || text == "both") {
    bonds.from = text;
    return;
  }
  constexpr std::string_view kLength = "length=";
  constexpr double kLargestFactor = 2;  // second neighbours are closer
  const bool is_length = text.starts_with(kLength);
  const auto number = base::number_of<double>(std::string_view(text).substr(is_length ? kLength.size() : 0));
  if (number > kLargestFactor && !is_length)
    base::refuse(
        fmt::format("--bonds {0} would join atoms closer than {0} times the sum of their covalent radii; for "
                    "those closer than {0}, write --bonds length={0}",
                    text));
  if (!number || !(*number >= scene::kSmallestRadius && *number <= scene::kLargestLength))
    base::refuse(
        fmt::format("--bonds: `{}` is not a source of bonds; write auto, file, distance, both, none, a factor "
                    "such as 1.2, or length=1.6",
                    text));
  (is_length ? bonds.length : bonds.factor) = *number;
}

}  // namespace

void DataArguments::add_to(Command& command, plot::DataOptions& data, const std::string& kind) {
  command
      .add_option(
          "FILE", data.file, "FILE",
          kind +
              ": LAMMPS, XYZ, PDB, mmCIF, CIF, VASP, GRO, XTC, TRR, DCD, PLY, CSV, NPY, NPZ, LAS, LAZ, GSD, HDF5, VTK")
      ->required();
  const OptionGroup group(command, kDataOptions);
  scene::PointsKeys& points = data.points;
  command.add_option("--frame", frame, "N",
                     "Frame of the file, from 1; last or -1: the last, -2: the one before; default: 1");
  command
      .add_option("--select", select, "CONDITION",
                  "Use only the rows that match, e.g. 'type == 2 && z > 0'; if repeated, all must match")
      ->details("For example 'id in [20:60] && chain in {A, B}'; docs/data.md describes conditions.")
      ->repeatable();
  command
      .add_option("--slice,--clip", slice, "AXIS=POSITION",
                  "Slice plane: remove the spheres in front of it, e.g. z=10; can be repeated")
      ->details("With convert, as seen from the default view of plot.")
      ->repeatable();
  command.add_option("--component", points.component, "N", "HDF5: particle type, N of PartTypeN")
      ->details("Required if the file has particles of several types.")
      ->transform(whole_number(0, 1000));
  command.add_option("--topology", points.topology, "FILE",
                     "Trajectories: data file that names the atoms, e.g. top.pdb or conf.gro");
  command.add_option("--assembly", points.assembly, "NAME", "PDB, mmCIF: biological assembly, e.g. 1");
  command.add_option("--replicate", replicate, "A,B,C", "Number of periodic boxes along each box edge, e.g. 2,2,1");
  command.add_flag(
      "--unwrap", points.unwrap,
      "Unwrap coordinates with the file's periodic image flags, or else make molecules whole by their bonds");
  command.add_flag("--skip-bad", points.skip_bad, "Skip rows with non-finite coordinates or radii")
      ->details("Otherwise they are an error.");
  const OptionGroup look(command, kLookOptions);
  command
      .add_option(
          "--radius", radius, "X|COLUMN|CONDITION:X",
          "Radius: a number, a column of radii, or of those that match, e.g. 'type == 2: 0.5'; default: from the "
          "file; can be repeated")
      ->repeatable();
  command
      .add_option("--radius-scale", points.radius.scale, "X",
                  "Scale factor for radii of the data and for the default radius, e.g. 0.5 for a column of diameters")
      ->check(real_number(1e-30, 1e30));
  command
      .add_option("--element-radii", points.radius.element, "TABLE",
                  "Radii by chemical element: vdw, covalent or ball (a quarter of vdw)")
      ->details("In angstrom.")
      ->choices({"vdw", "covalent", "ball"});
  command
      .add_option(
          "--color-by", data.color_by, "COLUMN",
          "Colour by a column, an expression such as 'sqrt(vx^2+vy^2)', element, type, chain+element, rgb or none")
      ->details(
          "COLUMN+element: by element, but carbon atoms by the column. rgb: the file's own colours. none: one colour. "
          "The default depends on the file. Expressions have the "
          "operators and functions of conditions.");
  command
      .add_option("--color", data.points.color.where, "CONDITION:COLOR",
                  "Colour of those that match, e.g. 'residue HEM: red' or 'id == 5: #ffaa00'; can be repeated")
      ->repeatable();
  command.add_option("--carbon", data.points.color.carbon, "COLUMN",
                     "With --color-by element: colour carbon atoms by a column, e.g. chain");
  map = command
            .add_option("--map,--colormap", points.color.map, "MAP",
                        "Colour map, e.g. viridis, fast, coolwarm, viridis_r for the reverse, or a file")
            ->details("docs/data.md lists the maps. The default is fast, for types and strings set2.");
  command
      .add_option("--range", range, "RANGE",
                  "Values at both ends of the colour map, e.g. 0:12, 1%:99%, log, symmetric; default: 0%:100%")
      ->details(
          "Numbers or percentiles of the values of all frames. log: a logarithmic scale; symmetric: -X:X; both also "
          "with a range, e.g. log,1%:99%.");
}

void DataArguments::add_frames_to(Command& command) {
  const OptionGroup group(command, kDataOptions);
  command
      .add_option("--frames", frames, "RANGE", "Frames of the file: all, or e.g. 1-48; name outputs like out.####.png")
      ->details("Names of outputs need a frame pattern, as for orrery render.");
}

void DataArguments::read(plot::DataOptions& data) const {
  if (!frames.empty() && !frame.empty()) base::refuse("--frame and --frames exclude each other");
  if (!frame.empty()) data.points.frame = frame_of(frame);
  data.all_frames = frames == "all";
  if (!frames.empty() && !data.all_frames) data.frames = base::parse_frames(frames);
  data.has_map = map->count() > 0;
  scene::PointsKeys& points = data.points;
  for (const std::string& text : points.color.where) points::parse_color(points::split_rule(text).second);
  for (const std::string& text : radius) read_radius(text, points.radius);
  for (const std::string& text : opacity) read_opacity(text, points.opacity);
  if (!replicate.empty()) points.replicate = copies_of(replicate);
  if (!range.empty()) {
    data.range = plot::parse_range(range);
    points.color.range = data.range.fixed();
    points.color.log = data.range.is_log;
  }
  points.select = plot::all_of(select);
  for (const std::string& plane : slice) data.slices.push_back(slice_of(plane));
}

void PlotArguments::add_look_to(Command& command) {
  add_view_options(command, options);
  const OptionGroup group(command, kLookOptions);
  command
      .add_option(
          "--representation", look_.representation, "KIND|CONDITION:KIND",
          "Particles as spheres, ball-and-stick, sticks, trace or points, or those that match, e.g. 'residue HEM: "
          "sticks'; default: spheres; can be repeated")
      ->details(
          "ball-and-stick: a quarter of the van der Waals radii, or without elements half the default radius. sticks: "
          "spheres have the radius of the bonds. trace: a tube along the C-alpha or phosphorus atoms of PDB and mmCIF "
          "files, the default for files of these atoms alone. points: spheres of the radius of bonds. The last that "
          "matches a particle decides.")
      ->repeatable();
  command
      .add_option(
          "--bonds", look_.bonds, "SOURCE",
          "Draw bonds: auto, file, distance, both, a factor of the covalent radii such as 1.2, or length=X; none")
      ->details(
          "auto: those of the file; by distance if it has none; both for PDB and mmCIF, which leave out common bonds. "
          "A factor or a length: by distance. docs/data.md describes bonds.");
  command
      .add_option("--vectors", look_.vectors, "X,Y,Z",
                  "Draw arrows from three columns, e.g. vx,vy,vz, or from a vector, e.g. forces")
      ->details("Their length is chosen from the data; --set 'points[0].vectors.scale=2' sets it.");
  command
      .add_option("--shutter", options.shutter, "X",
                  "Motion blur: time that the shutter is open in frames, e.g. 0.5; particles move to the next frame")
      ->details("From the frame on, to the nearest periodic image. By velocities with --frame-time.")
      ->check(real_number(1e-6, scene::kLongestShutter));
  command
      .add_option("--frame-time", options.points.motion.frame_time, "T",
                  "Particles move by the velocities of the file: time between frames, in the unit of the velocities")
      ->check(real_number(scene::kSmallestRadius, scene::kLargestLength));
  command.add_option("--velocity", look_.velocity, "X,Y,Z",
                     "With --frame-time: columns of the velocity, e.g. ux,uy,uz; default: those of the file");
  command
      .add_option("--opacity", data.opacity, "X|COLUMN|CONDITION:X",
                  "Opacity, 0 to 1: of all, from a column, or of those that match, e.g. 'type == 2: 0.3'; can be "
                  "repeated")
      ->details("The last that matches a particle decides; particles that none matches are opaque.")
      ->repeatable();
  command
      .add_option("--style,--lighting", look_.style, "STYLE",
                  "Light: studio, soft, flat, night, ambient or illustration; default: studio")
      ->details(
          "studio: a key light from the upper left of the camera, and white light from all directions. soft: more of "
          "the latter. flat: no shading. night: a lamp and a dark sky. ambient: white light from all directions alone. "
          "illustration: soft, with outlines between chains and a depth cue.")
      ->choices(plot::style_names());
  command.add_option(
      "--background", look_.background, "COLOR",
      "Colour behind the spheres: white, grey, navy or the like, or #rrggbb; default: that of the style");
  command.add_flag("--transparent", options.transparent, "Transparent background, in EXR, PNG, TIFF and SVG");
  command.add_flag("--exact-colors", options.exact_colors,
                   "No tone mapping: bright colours are not compressed, and may clip; as with flat and ambient");
  command
      .add_option("--depth-cue", options.depth_cue, "X",
                  "Fade what is far away into the background, 0 to 1 for the farthest; default: 0.35 for molecules")
      ->check(real_number(0, 1));
  command
      .add_option("--quality", look_.quality, "NAME",
                  "draft (--samples 4 --denoise), good (--noise 0.15 --denoise) or final (--noise 0.02); default: good")
      ->choices(plot::quality_names());
  command
      .add_option("--material", look_.material, "MATERIAL|CONDITION:MATERIAL",
                  "Material of all, or of those that match, e.g. 'residue HEM: metal': matte, plastic, metal or glass; "
                  "default: plastic with rods, else matte; can be repeated")
      ->details(
          "plastic: matte with a soft highlight. metal: brushed. glass: clear, without colours; not for bonds. The "
          "last that matches a particle decides. Bonds have the materials of their ends.")
      ->repeatable();
  command.add_flag("--allow-empty", options.allow_empty,
                   "Render the background alone if no particle is left; default: an error");
  command.add_flag("--ground", options.ground, "Add a ground that receives shadows");
  command.add_flag("--box", options.box, "Draw the edges of the simulation box");
  command.add_flag("--axes", options.axes, "Draw the directions of x (red), y (green) and z (blue)");
}

void PlotArguments::add_annotations_to(Command& command) {
  const OptionGroup group(command, kAnnotationOptions);
  scene::Annotation& annotation = options.annotation;
  command.add_option("--title", annotation.title, "TEXT", "Text at the top left, e.g. 't = {step * 0.005:.1f} ps'")
      ->details(
          "{EXPRESSION} is the value of an expression of frame and step, the time step in the data file, with a format "
          "after a colon.");
  command.add_option("--scale-bar", look_.scale_bar, "LENGTH",
                     "Scale bar: auto, or a length, with a unit to be shown, e.g. '20 nm'; not with --perspective");
  command.add_flag("--color-bar", annotation.color_bar, "Legend of the colours in the image");
  command.add_option("--color-title", annotation.color_title, "TEXT",
                     "Title of the legend, e.g. 'Speed (m/s)'; implies --color-bar; default: the column");
  command.add_option("--color-at", annotation.color_at, "CORNER", "Corner of the legend; default: 'top right'")
      ->choices({"top right", "bottom right", "top left", "bottom left"});
  command
      .add_option("--font-size", annotation.font_size, "PX",
                  "Height of all texts in pixels; default: a 32nd of the image, with --dpi 8 points")
      ->check(real_number(4, 1000));
  command.add_option("--print-width", look_.print_width, "LENGTH",
                     "Width in print, e.g. 8.5cm, 85mm or 3.3in: with --dpi, it sets the width in pixels");
  command
      .add_option("--label", options.points.labels, "CONDITION: TEXT",
                  "Label the middle of the particles that match, e.g. 'id == 5: Fe'; can be repeated")
      ->repeatable();
  command.add_option("--outline", annotation.outline, "PX", "Width of the outlines of objects in pixels, e.g. 2")
      ->check(real_number(0, scene::kWidestOutline));
  command.add_option("--outline-by", options.outline_by, "COLUMN",
                     "Outlines between the values of a column, e.g. chain; within them, thinner ones");
  command
      .add_option("--outline-depth", annotation.outline_depth, "LENGTH",
                  "Outlines only where the depth jumps by more than a length, in units of the file")
      ->check(real_number(scene::kSmallestRadius, scene::kLargestLength));
  command.add_option("--font", annotation.font, "FONT", "Name or file of the font; default: DejaVuSans");
}

void PlotArguments::read(SceneOptions& scene, const job::Job& job) {
  plot::PlotOptions& plot = options;
  set_print_width(look_.print_width, scene);
  plot.annotation.color_bar = plot.annotation.color_bar || !plot.annotation.color_title.empty();
  plot.style = plot::style_of(look_.style);
  plot.quality = plot::quality_of(look_.quality);
  if (!look_.background.empty()) plot.background = points::parse_color(look_.background);
  for (const std::string& text : look_.representation) read_representation(text, plot);
  for (const std::string& text : look_.material) read_material(text, plot);
  for (const auto& [text, list] : {std::pair{&look_.vectors, &plot.points.vectors.columns},
                                   std::pair{&look_.velocity, &plot.points.motion.columns}}) {
    std::istringstream columns(*text);
    for (std::string column; std::getline(columns, column, ',');) list->push_back(column);
  }
  read_scale_bar(look_.scale_bar, plot.annotation);
  if (const std::string& bonds = look_.bonds; !bonds.empty()) {
    plot.bonds = bonds != "none";
    if (bonds != "none" && bonds != "auto") read_bonds(bonds, plot.points.bonds);
  }
  plot.overrides = scene.overrides();
  const scene::Annotation& annotation = plot.annotation;
  for (const auto& [is_given, option, key] : std::initializer_list<std::tuple<bool, const char*, const char*>>{
           {!annotation.title.empty(), "--title", "annotation.title"},
           {annotation.scale_bar.has_value(), "--scale-bar", "annotation.scale_bar"},
           {annotation.color_bar, "--color-bar", "annotation.color_bar"},
           {!annotation.color_title.empty(), "--color-title", "annotation.color_title"},
           {annotation.font_size != 0, "--font-size", "annotation.font_size"},
           {annotation.outline != 0, "--outline", "annotation.outline"},
           {annotation.outline_depth != 0, "--outline-depth", "annotation.outline_depth"},
           {plot.depth_cue.has_value(), "--depth-cue", "camera.depth_cue"},
           {plot.shutter > 0, "--shutter", "camera.shutter_close"},
           {!annotation.font.empty(), "--font", "annotation.font"},
           {plot.vfov_deg.has_value(), "--perspective", "camera.vfov"}})
    if (is_given) refuse_second(option, plot.overrides, key);
  plot.has_target = job.settings.noise || job.settings.time_budget_s;
  plot.memory_limit =
      job.resources.memory_limit > 0 ? job.resources.memory_limit : base::available_memory().value_or(0);
}

void show(const plot::PlotScene& made, std::shared_ptr<const std::string> text, job::Job& job) {
  job.scene.text = std::move(text);
  job.scene.has_file = false;
  job.scene.loaded = made.loaded;
  if (made.noise) job.settings.noise = *made.noise;
  job.denoise = job.denoise || (made.denoise && job.outputs.deep.empty());
}

}  // namespace orrery::cli
