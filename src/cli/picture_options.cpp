// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_options.h"

#include "cli/display_options.h"
#include "cli/option_checks.h"

namespace orrery::cli {

void PictureOptions::add_to(Command& command, job::Job& job) {
  command
      .add_option("-o,--output", files_,
                  "File to write; its extension chooses EXR, HDR, PNG, TIFF, JPEG or PPM; can be repeated")
      ->required()
      ->type_name("FILE")
      ->repeatable();
  add_display_options(command, job.outputs.display, job.outputs.bits);
  command.add_option("--type", type_, "EXR channels: half, the default, or float")
      ->check(one_of({"half", "float"}))
      ->type_name("TYPE");
  command
      .add_option("--compression", job.outputs.exr.compression, "EXR compression, zips by default: zip, dwaa:45 ...")
      ->type_name("NAME");
  command
      .add_option("--deep", job.outputs.deep, "Write also an EXR of samples in depth, one for each sphere in a pixel")
      ->type_name("FILE");
  command.add_flag("--multipart", job.outputs.exr.multipart, "Give each layer of an EXR a part of its own");
  command
      .add_option("--disk-limit", job.resources.disk_limit,
                  "Refuse pictures that need more than this, e.g. 8G; default: the free space of their disk")
      ->transform(byte_size())
      ->type_name("SIZE");
  command.add_flag("--reproducible", job.outputs.reproducible, "Leave out of headers what changes between runs");
}

void PictureOptions::finish(job::Job& job) const {
  job.outputs.images = job::image_files(files_);
  job.outputs.exr.as_float = type_ == "float";
}

}  // namespace orrery::cli
