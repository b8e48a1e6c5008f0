// SPDX-License-Identifier: Apache-2.0
#include "job/rendering.h"

#include <algorithm>
#include <string>

#include "base/atomic_file.h"
#include "film/partial.h"
#include "image/format.h"
#include "job/check_job.h"
#include "job/checkpoint.h"
#include "job/layers.h"
#include "job/outputs.h"
#include "load/read_scene.h"

namespace orrery::job {
namespace {

/// Checks the names and the formats of the files, as a job does before it renders.
void check_outputs(const Rendering& rendering, const Outputs& outputs) {
  base::FileSet files = rendering.files;
  const auto add = [&](const std::filesystem::path& file, const char* role) {
    files.add_output(file, role);
    base::check_creatable(file);
  };
  load::add_ocio_configs(display_of(rendering, outputs.display).config, files);
  check_bits(outputs.images, outputs.bits);
  image::check_compression(outputs.exr.compression);
  for (const ImageFile& output : outputs.images) {
    add(output.path, "-o");
    image::check_size(output.path, rendering.picture.width, rendering.picture.height);
  }
  for (const std::filesystem::path& manifest : manifest_files(rendering.mattes, outputs))
    add(manifest, "Cryptomatte manifest");
  if (outputs.has_exr()) image::check_lossless(rendering.picture.planes, outputs.exr);
}

/// Adds the attribute where picture_header() puts it.
void add_config_id(const std::string& config_id, image::Header& header) {
  const auto place = std::find_if(header.attributes.begin(), header.attributes.end(),
                                  [](const image::Attribute& a) { return a.name == "orrery/settings"; });
  header.attributes.insert(place, {"orrery/ocioConfigId", config_id});
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
  int bits = outputs.bits;
  display::Choice choice;
  if (outputs.has_display_format()) {
    choice = display::choose(display);
    require_bits(choice, outputs);
    if (bits == 0) bits = choice.default_bits();
    add_config_id(choice.config_id, header);
  }
  Job job = rendering.job;
  job.outputs = outputs;
  header.stamp = annotation::stamped(stamp_of(job, rendering.provenance, display, choice), rendering.drawing);
  return write_outputs(outputs, display, bits, {rendering.picture, header, rendering.mattes, rendering.drawing});
}

}  // namespace orrery::job
