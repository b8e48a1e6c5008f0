// SPDX-License-Identifier: Apache-2.0
#include "job/image_files.h"

#include <string>

#include "annotation/drawing.h"
#include "base/available_memory.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/file_set.h"
#include "display/settings.h"
#include "image/format.h"
#include "image/header.h"
#include "image/library.h"
#include "image/read.h"
#include "image/write.h"
#include "job/resources.h"
#include "job/version.h"
#include "job/write_outputs.h"
#include "load/read_scene.h"

namespace orrery::job {

namespace {

void check_kinds(const Development& development) {
  for (const auto& output : development.outputs)
    if (!image::is_display_format(image::format_of(output)))
      base::refuse(output.string() + " has a scene-linear format; write png, tiff, jpg, ppm or svg");
  if (image::is_display_format(image::format_of(development.input)))
    base::refuse(development.input.string() + " is already display-encoded; the input must be exr or hdr");
}

}  // namespace

DevelopReport develop_file(const Development& development) {
  check_kinds(development);
  check_bits({development.outputs.begin(), development.outputs.end()}, development.bits);
  base::FileSet files;
  files.add_input(development.input, "image");
  load::add_ocio_configs(development.display.config, files);
  for (const auto& output : development.outputs) files.add_output(output, "-o");
  DevelopReport report;
  const film::Picture picture =
      image::read(development.input, image::Parts::kFirst, base::available_memory().value_or(0));
  for (const auto& output : development.outputs) image::check_size(output, picture.width, picture.height);
  display::Settings display = development.display;
  if (display.working_space.empty()) display.working_space = picture.color_interop_id;
  if (display.working_space.empty()) display.working_space = "lin_rec709";
  display.backdrop = picture.backdrop;
  report.display = display::choose(display);
  for (const char* name : {"R", "G", "B"})  // no other plane is developed
    if (const film::Plane* plane = picture.find(name)) report.bad_values += film::count_bad_values(*plane);
  const annotation::Drawing none;
  DisplayWriter developed(picture, display, development.bits != 0 ? development.bits : report.display.default_bits(),
                          none);
  for (const auto& output : development.outputs) developed.write(output, "orrery " + program_version());
  return report;
}

DenoisedFile denoise_file(const Denoising& denoising) {
  for (const std::filesystem::path& file : {denoising.input, denoising.output})
    if (image::format_of(file) != image::Format::kExr)
      base::refuse(file.string() + " is not an EXR file; denoising needs scene-linear EXR");
  base::FileSet files;
  files.add_input(denoising.input, "image");
  files.add_output(denoising.output, "-o");
  const int threads = thread_count(denoising.threads);
  image::set_threads(threads);
  DenoisedFile out;
  const auto edit = [&](film::Picture& picture) {
    try {
      out.report = denoise::denoise(picture, threads);
    } catch (const base::Error& error) {
      throw base::Error(error.kind(), denoising.input.string() + ": " + error.what());
    }
    return std::vector<image::Attribute>{{denoise::kAttribute, "orrery " + program_version()}};
  };
  out.written = image::rewrite_exr(denoising.input, denoising.output, edit);
  return out;
}

}  // namespace orrery::job
