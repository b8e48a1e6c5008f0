// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "base/text.h"
#include "display/settings.h"
#include "format/read_scene.h"
#include "job/job.h"
#include "plot/data_frames.h"
#include "plot/range.h"
#include "points/point_opacity.h"
#include "scene/limits.h"
#include "scene/value_text.h"

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

/// Adds an --opacity to those before it. One without a condition matches all particles, so that it replaces them.
void read_opacity(const std::string& text, scene::PointsOpacity& opacity) {
  if (text.find(':') != std::string::npos) {
    try {
      points::parse_opacity_rule(text);
    } catch (const base::Error& error) {
      base::refuse(std::string("--opacity: ") + error.what());
    }
    if (opacity.value) opacity.where.push_back(scene::number_text(*opacity.value));
    opacity.value.reset();
    opacity.where.push_back(text);
    return;
  }
  opacity = {};
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) {
    opacity.column = text;
    return;
  }
  if (!(value >= 0 && value <= 1)) base::refuse(fmt::format("--opacity: {} must be in 0..1", text));
  opacity.value = value;
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
  for (const std::string& text : arguments.opacity) read_opacity(text, points.opacity);
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

void SceneOptions::add_to(Command& command, Short forms) {
  const OptionGroup group(command, "Scene options");
  command
      .add_option("--set", set_, "KEY=VALUE", "Override a key of the scene file, e.g. camera.vfov=30; can be repeated")
      ->details(
          "With the same checks as for the file; messages name the option. Other examples: material.gold.fuzz=0.3, "
          "sphere[0].radius=2, color.view=Raw. Tables are merged into those of the scene: render={samples=20} and "
          "render.samples=20 are the same. A key that both --set and a short form set is an error.")
      ->repeatable();
  const auto add = [&](const char* flag, const char* key, const char* type, const char* what) {
    ShortForm& option = short_forms_.emplace_back(ShortForm{flag, key, {}, nullptr, false});
    option.flag = command.add_option(flag, option.value, type, fmt::format("{} ({})", what, key));
  };
  add("--width", "image.width", "N", "Image width in pixels");
  add("--height", "image.height", "N", "Image height in pixels");
  if (forms == Short::kSize) return;
  add("--samples", "render.samples", "N", "Samples per pixel");
  add("--precision", "render.precision", "NAME", "Arithmetic: exact, fast or book");
  add("--layers", "output.layers", "NAMES",
      "Additional EXR layers, e.g. Z,N,diffuse; all: every layer of the scene; \"\": none");
  short_forms_.back().is_list = true;
  short_forms_.back().flag->may_be_empty();
}

format::Overrides SceneOptions::overrides() const {
  format::Overrides out, set;
  for (const std::string& setting : set_) set.add(setting);
  for (const ShortForm& option : short_forms_) {
    if (option.flag->count() == 0) continue;
    for (const format::Override& other : set)
      if (other.sets(option.key))
        throw base::Error(base::ErrorKind::kUsage,
                          fmt::format("{} and --set {} set the same key; omit one of them", option.name, other.typed));
    out.add_option(option.name, option.key, option.value, option.is_list);
  }
  for (const format::Override& other : set) out.add(other);
  return out;
}

void SceneOptions::add_frame_to(Command& command) {
  command.add_option("--frame,--frames", frame_, "N", "Frame of an animation; default: 1");
}

int SceneOptions::frame() const {
  if (frame_.empty()) return format::kFirstFrame;
  const std::vector<int> frames = base::parse_frames(frame_);
  if (frames.size() != 1)
    throw base::Error(
        base::ErrorKind::kUsage,
        fmt::format("--frame {} selects {} frames, but this command takes one; orrery check takes several", frame_,
                    frames.size()));
  return frames.front();
}

void add_display_options(Command& command, display::Settings& settings, bool has_scene) {
  const std::string scene = has_scene ? "the scene's, or " : "";
  const OptionGroup group(command, kDisplayOptions);
  command
      .add_option(
          "--ocio", settings.config, "FILE",
          fmt::format("OCIO config; default: {}$OCIO, or the built-in config", has_scene ? "the scene's, " : ""))
      ->details("It is used for PNG, TIFF, JPEG and PPM; EXR and HDR files do not depend on it.");
  command
      .add_option("--display", settings.display, "NAME",
                  "Display of the OCIO config, e.g. \"sRGB\"; default: " + scene + "the config's")
      ->details(
          "The built-in config has the displays sRGB, Rec.1886 Rec.709, Display P3, P3-D65 Cinema, Rec.2100-PQ and "
          "Gamma 2.0 Rec.709, which is the square root of Ray Tracing in One Weekend, and the views Un-tone-mapped and "
          "Raw; the first three also have ACES 1.0 SDR Video, and Rec.2100-PQ has ACES 1.1 HDR Video (1000 nits).");
  command.add_option("--view", settings.view, "NAME",
                     "View of the display, e.g. \"Un-tone-mapped\"; default: " + scene + "the display's");
  command.add_option("--look", settings.look, "NAME", "Look of the OCIO config, applied before the view");
  command.add_option("--exposure", settings.exposure, "STOPS", "Exposure in stops; default: " + scene + "0")
      ->check(real_number(-scene::kMaxStops, scene::kMaxStops));
}

void add_bits_option(Command& command, int& bits) {
  command.add_option("--bits", bits, "8|16", "Bits per channel of PNG and TIFF; default: 8, or 16 for an HDR display")
      ->choices({"8", "16"});
}

void add_threads_option(Command& command, int& threads, const char* otherwise) {
  command.add_option("-t,--threads", threads, "N", fmt::format("Number of threads; default: {}", otherwise))
      ->transform(whole_number(1, kMaxThreads));
}

void add_denoise_option(Command& command, job::Job& job) {
  command.add_flag("--denoise", job.denoise, "Denoise the images; shards store the data for merge --denoise")
      ->details("As orrery denoise does, before they are written.");
}

void PictureOptions::add_to(Command& command, job::Job& job) {
  const OptionGroup group(command, kImageOptions);
  command
      .add_option("-o,--output", files_, "FILE",
                  "File to write: .exr, .hdr, .png, .tif, .tiff, .jpg, .jpeg, .ppm or .svg; can be repeated")
      ->details(
          "EXR and HDR are scene-linear, the others are display formats. An image with background.alpha = 0 has an "
          "alpha channel in PNG, TIFF and SVG, unassociated (not premultiplied). SVG files contain the image as PNG, "
          "and "
          "annotations as text and shapes that an editor can change.")
      ->required()
      ->repeatable();
  add_bits_option(command, job.outputs.bits);
  command.add_option("--type", type_, "TYPE", "EXR channel type: half or float; default: half")
      ->choices({"half", "float"});
  command
      .add_option("--compression", job.outputs.exr.compression, "NAME",
                  "EXR compression, e.g. zip or dwaa:45; default: zips")
      ->details("One of none, rle, zip, zips, piz, dwaa or dwab, the last two with an optional level.");
  command.add_flag("--multipart", job.outputs.exr.multipart, "Write each EXR layer to a separate part");
  command
      .add_option("--disk-limit", job.resources.disk_limit, "SIZE",
                  "Refuse to start if the estimated disk space exceeds SIZE, e.g. 8G; default: free space")
      ->details(
          "The estimate assumes the compression of noisy images. A limit above the free space overrides the check.")
      ->transform(byte_size());
  add_denoise_option(command, job);
  command
      .add_flag("--reproducible", job.outputs.reproducible,
                "Omit run-dependent metadata (date, render time, accelerator, instruction set) from EXR headers")
      ->details("The same scene then gives the same bytes.");
}

std::string PictureOptions::unused_options(const job::Job& job) const {
  const job::Outputs& outputs = job.outputs;
  std::string out;
  const auto warn = [&](const std::vector<std::pair<const char*, bool>>& options, const char* formats) {
    std::vector<std::string> given;
    for (const auto& [name, is_given] : options)
      if (is_given) given.emplace_back(name);
    if (!given.empty())
      out += base::warning_line(fmt::format("{} {} no effect: {}, and none is written", base::joined(given),
                                            given.size() == 1 ? "has" : "have", formats));
  };
  if (!outputs.has_display_format()) warn({{"--bits", outputs.bits != 0}}, "the bits are those of PNG and TIFF");
  if (!outputs.has_exr())
    warn({{"--type", type_ != "half"},
          {"--compression", outputs.exr.compression != job::Outputs().exr.compression},
          {"--multipart", outputs.exr.multipart}},
         "they apply to images in EXR");
  return out;
}

void PictureOptions::finish(job::Job& job) const {
  job.outputs.images = job::image_files(files_);
  job.outputs.exr.as_float = type_ == "float";
}

void add_data_options(Command& command, DataArguments& arguments, plot::DataOptions& data, const std::string& kind) {
  command
      .add_option("FILE", data.file, "FILE",
                  kind + ": LAMMPS, XYZ, PDB, mmCIF, PLY, CSV, NPY, NPZ, LAS, GSD, HDF5, VTK")
      ->required();
  const OptionGroup group(command, kDataOptions);
  scene::Points& points = data.points;
  command.add_option("--frame", arguments.frame, "N", "Frame of the file, from 1; default: 1")
      ->check(whole_number(1, 2'000'000'000));
  command
      .add_option("--frames", arguments.frames, "RANGE",
                  "Frames of the file: all, or e.g. 1-48; name outputs like out.####.png")
      ->details("Names of outputs need a frame pattern, as for orrery render.");
  command
      .add_option("--select", arguments.select, "CONDITION",
                  "Use only the rows that match, e.g. 'type == 2 && z > 0'; if repeated, all must match")
      ->details("For example 'id in [20:60] && chain in {A, B}'; docs/data.md describes conditions.")
      ->repeatable();
  command
      .add_option("--slice", arguments.slice, "AXIS=POSITION",
                  "Slice plane: remove the spheres in front of it, e.g. z=10; can be repeated")
      ->details("With convert, as seen from the default view of plot.")
      ->repeatable();
  command.add_option("--component", arguments.component, "N", "HDF5: particle type, N of PartTypeN")
      ->details("Required if the file has particles of several types.")
      ->check(whole_number(0, 1000));
  command.add_option("--assembly", points.assembly, "NAME", "PDB, mmCIF: biological assembly, e.g. 1");
  command.add_option("--replicate", arguments.replicate, "A,B,C",
                     "Number of periodic boxes along each box edge, e.g. 2,2,1");
  command.add_flag("--unwrap", points.unwrap, "Unwrap coordinates with the file's periodic image flags");
  command.add_flag("--skip-bad", points.skip_bad, "Skip rows with non-finite coordinates or radii")
      ->details("Otherwise they are an error.");
  const OptionGroup look(command, kLookOptions);
  command.add_option("--radius", arguments.radius, "X|COLUMN",
                     "Radius: a number, or a column of radii; default: from the file");
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
      .add_option("--color-by", data.color_by, "COLUMN",
                  "Colour by a column, an expression such as 'sqrt(vx^2+vy^2)', element, type, rgb or none")
      ->details(
          "rgb: the file's own colours. none: one colour. The default depends on the file. Expressions have the "
          "operators and functions of conditions.");
  arguments.map =
      command.add_option("--map", points.color.map, "MAP", "Colour map, e.g. viridis, fast, coolwarm, or a file")
          ->details("docs/data.md lists the maps. The default is fast, for types and strings tab10.");
  command
      .add_option("--range", arguments.range, "RANGE",
                  "Values at both ends of the colour map, e.g. 0:12, 1%:99%, log, symmetric; default: 0%:100%")
      ->details(
          "Numbers or percentiles of the values of all frames. log: a logarithmic scale; symmetric: -X:X; both also "
          "with a range, e.g. log,1%:99%.");
}

void read_data_options(const DataArguments& arguments, plot::DataOptions& data) {
  if (!arguments.frames.empty() && !arguments.frame.empty()) base::refuse("--frame and --frames exclude each other");
  data.all_frames = arguments.frames == "all";
  if (!arguments.frames.empty() && !data.all_frames) data.frames = base::parse_frames(arguments.frames);
  data.has_map = arguments.map->count() > 0;
  read_points(arguments, data.points);
  if (!arguments.range.empty()) {
    data.range = plot::parse_range(arguments.range);
    data.points.color.range = data.range.fixed();
    data.points.color.log = data.range.is_log;
  }
  data.points.select = plot::all_of(arguments.select);
  for (const std::string& plane : arguments.slice) data.slices.push_back(slice_of(plane));
}

}  // namespace orrery::cli
