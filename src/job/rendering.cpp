// SPDX-License-Identifier: Apache-2.0
#include "job/rendering.h"

#include <string>

#include "film/sums.h"
#include "image/format.h"
#include "job/checkpoint.h"
#include "job/write_outputs.h"
#include "load/read_scene.h"

namespace orrery::job {
namespace {

/// Checks the names and the formats of the files, as a job does before it renders.
void check_outputs(const Rendering& rendering, const Outputs& outputs) {
  base::FileSet files = rendering.files;
  load::add_ocio_configs(display_of(rendering, outputs.display).config, files);
  check_bits(outputs.images, outputs.bits);
  image::check_compression(outputs.exr.compression);
  for (const ImageFile& output : outputs.images) {
    files.add_output(output.path, "-o");
    image::check_size(output.path, rendering.picture.width, rendering.picture.height);
  }
  if (outputs.has_exr()) image::check_lossless(rendering.picture.planes, outputs.exr);
}

}  // namespace

display::Settings display_of(const Rendering& rendering, display::Settings display) {
  display.complete(rendering.display);
  return display;
}

image::WriteReport write_rendering(const Rendering& rendering, const Outputs& outputs) {
  check_outputs(rendering, outputs);
  const display::Settings display = display_of(rendering, outputs.display);
  image::Header header = outputs.reproducible ? rendering.reproducible_header : rendering.header;
  display::Choice choice;
  if (outputs.has_display_format()) {
    choice = display::choose(display);
    require_bits(choice, outputs);
    header.attributes.push_back({"orrery/ocioConfigId", choice.config_id});
  }
  Job job = rendering.job;
  job.outputs = outputs;
  header.stamp = annotation::stamped(stamp_of(job, rendering.provenance, display, choice), rendering.drawing);
  if (!rendering.report.target_missed.empty()) header.stamp = stamp_of_missed(header.stamp);
  return write_outputs(outputs, display, choice, rendering.picture, header, rendering.drawing);
}

}  // namespace orrery::job
