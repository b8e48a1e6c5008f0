// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "base/text.h"
#include "display/settings.h"
#include "job/job.h"
#include "load/read_scene.h"
#include "scene/limits.h"

namespace orrery::cli {

void SceneOptions::add_to(Command& command, Short forms) {
  const OptionGroup group(command, "Scene options");
  command
      .add_option("--set", set_, "KEY=VALUE", "Override a key of the scene file, e.g. camera.vfov=30; can be repeated")
      ->details(
          "With the same checks as for the file; messages name the option. Other examples: material.gold.fuzz=0.3, "
          "sphere[0].radius=2, color.view=Raw. Tables are merged into those of the scene: render={samples=20} and "
          "render.samples=20 are the same. A key that both --set and a short form set is an error.")
      ->repeatable();
  if (forms == Short::kNone) return;
  const auto add = [&](const char* flag, const char* key, const char* type, const char* what) {
    ShortForm& option = short_forms_.emplace_back(ShortForm{flag, key, {}, nullptr, false});
    option.flag = command.add_option(flag, option.value, type, fmt::format("{} ({})", what, key));
  };
  add("--width", "image.width", "N", "Image width in pixels");
  add("--height", "image.height", "N", "Image height in pixels");
  add("--dpi", "image.dpi", "X", "Resolution in print, in pixels per inch, e.g. 300: PNG, TIFF and JPEG carry it");
  if (forms == Short::kSize) return;
  add("--samples", "render.samples", "N", "Samples per pixel");
  add("--precision", "render.precision", "NAME", "Arithmetic: exact, fast or book");
  add("--layers", "output.layers", "NAMES",
      "Additional EXR layers, e.g. Z,N,diffuse; all: every layer of the scene; \"\": none");
  short_forms_.back().is_list = true;
  short_forms_.back().flag->may_be_empty();
}

void refuse_second(const std::string& option, const load::Overrides& overrides, const char* key) {
  for (const load::Override& other : overrides)
    if (other.sets(key))
      base::refuse(fmt::format("{} and --set {} set the same key; omit one of them", option, other.typed));
}

load::Overrides SceneOptions::overrides() const {
  load::Overrides out, set;
  for (const std::string& setting : set_) set.add(setting);
  for (const ShortForm& option : short_forms_) {
    if (option.flag->count() == 0) continue;
    refuse_second(option.name, set, option.key);
    out.add_option(option.name, option.key, option.value, option.is_list);
  }
  for (const load::Override& other : set) out.add(other);
  return out;
}

void SceneOptions::add_frame_to(Command& command) {
  command.add_option("--frame,--frames", frame_, "N", "Frame of an animation; default: 1");
}

int SceneOptions::frame() const {
  if (frame_.empty()) return load::kFirstFrame;
  const std::vector<int> frames = base::parse_frames(frame_);
  if (frames.size() != 1)
    base::refuse(fmt::format("--frame {} selects {} frames, but this command takes one; orrery check takes several",
                             frame_, frames.size()));
  return frames.front();
}

void add_display_options(Command& command, display::Settings& settings) {
  const OptionGroup group(command, kDisplayOptions);
  command.add_option("--ocio", settings.config, "FILE", "OCIO config; default: $OCIO, or the built-in config")
      ->details("It is used for PNG, TIFF, JPEG and PPM; EXR and HDR files do not depend on it.");
  command
      .add_option("--display", settings.display, "NAME",
                  "Display of the OCIO config, e.g. \"sRGB\"; default: the config's")
      ->details(
          "The built-in config has the displays sRGB, Rec.1886 Rec.709, Display P3, P3-D65 Cinema, Rec.2100-PQ and "
          "Gamma 2.0 Rec.709, which is the square root of Ray Tracing in One Weekend, and the views Un-tone-mapped and "
          "Raw; the first three also have ACES 1.0 SDR Video, and Rec.2100-PQ has ACES 1.1 HDR Video (1000 nits).");
  command.add_option("--view", settings.view, "NAME",
                     "View of the display, e.g. \"Un-tone-mapped\"; default: the display's");
  command.add_option("--look", settings.look, "NAME", "Look of the OCIO config, applied before the view");
  command.add_option("--exposure", settings.exposure, "STOPS", "Exposure in stops; default: 0")
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
  command.add_flag("--denoise", job.denoise, "Denoise the images")
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
          "and annotations as text and shapes that an editor can change.")
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
  job.outputs.images.assign(files_.begin(), files_.end());
  job.outputs.exr.as_float = type_ == "float";
}

}  // namespace orrery::cli
