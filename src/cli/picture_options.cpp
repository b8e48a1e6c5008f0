// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_options.h"

#include <utility>

#include <fmt/core.h>

#include "base/diagnostic.h"
#include "base/text.h"
#include "cli/display_options.h"
#include "cli/option_checks.h"
#include "display/settings.h"
#include "job/job.h"

namespace orrery::cli {

void PictureOptions::add_to(Command& command, job::Job& job, bool allows_deep) {
  const OptionGroup group(command, kImageOptions);
  command
      .add_option("-o,--output", files_,
                  "File to write: .exr, .hdr, .png, .tif, .tiff, .jpg, .jpeg or .ppm; can be repeated")
      ->required()
      ->type_name("FILE")
      ->repeatable();
  add_display_options(command, job.outputs.display, job.outputs.bits, DisplayDefaults::kOfScene);
  command.add_option("--type", type_, "EXR channel type: half or float; default: half")
      ->check(one_of({"half", "float"}))
      ->type_name("TYPE");
  command
      .add_option("--compression", job.outputs.exr.compression, "EXR compression, e.g. zip or dwaa:45; default: zips")
      ->type_name("NAME");
  if (allows_deep)
    command.add_option("--deep", job.outputs.deep, "Also write a deep EXR, with one sample for each sphere in a pixel")
        ->type_name("FILE");
  command.add_flag("--multipart", job.outputs.exr.multipart, "Write each EXR layer to a separate part");
  command
      .add_option("--disk-limit", job.resources.disk_limit,
                  "Refuse to start if the estimated disk space exceeds SIZE, e.g. 8G; default: free space")
      ->transform(byte_size())
      ->type_name("SIZE");
  command.add_flag("--denoise", job.denoise, "Denoise the images; shards store the data for merge --denoise");
  command.add_flag("--reproducible", job.outputs.reproducible,
                   "Omit run-dependent metadata (date, render time, accelerator, instruction set) from EXR headers");
}

std::string PictureOptions::unused_options(const job::Job& job, bool shows_display) const {
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
  const display::Settings& display = outputs.display;
  if (!outputs.has_display_format() && !shows_display)
    warn({{"--display", !display.display.empty()},
          {"--view", !display.view.empty()},
          {"--look", !display.look.empty()},
          {"--exposure", display.exposure.has_value()},
          {"--bits", outputs.bits != 0}},
         "the display transform applies to PNG, TIFF, JPEG and PPM");
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

}  // namespace orrery::cli
