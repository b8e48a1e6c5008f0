// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_options.h"

#include "cli/display_options.h"
#include "cli/option_checks.h"

namespace orrery::cli {

void PictureOptions::add_to(Command& command, job::Job& job) {
  command
      .add_option("-o,--output", job.outputs,
                  "File to write; its extension chooses EXR, HDR, PNG, TIFF, JPEG or PPM; can be repeated")
      ->required()
      ->type_name("FILE")
      ->repeatable();
  add_display_options(command, job.display, job.bits);
  command.add_option("--type", type_, "EXR channels: half, the default, or float")
      ->check(one_of({"half", "float"}))
      ->type_name("TYPE");
  command.add_option("--compression", job.exr.compression, "EXR compression, zips by default: zip, dwaa:45 ...")
      ->type_name("NAME");
  command.add_option("--deep", job.deep, "Write also an EXR of samples in depth, one for each sphere in a pixel")
      ->type_name("FILE");
  command.add_flag("--multipart", job.exr.multipart, "Give each layer of an EXR a part of its own");
  command
      .add_option("--disk-limit", job.disk_limit,
                  "Refuse pictures that need more than this, e.g. 8G; default: the free space of their disk")
      ->transform(byte_size())
      ->type_name("SIZE");
  command.add_flag("--reproducible", job.reproducible, "Leave out of headers what changes between runs");
}

}  // namespace orrery::cli
