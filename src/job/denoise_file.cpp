// SPDX-License-Identifier: Apache-2.0
#include "job/denoise_file.h"

#include <string>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_set.h"
#include "image/format.h"
#include "image/header.h"
#include "image/library.h"
#include "job/resources.h"
#include "job/version.h"

namespace orrery::job {

DenoisedFile denoise_file(const Denoising& denoising) {
  for (const std::filesystem::path& file : {denoising.input, denoising.output})
    if (image::format_of(file) != image::Format::kExr)
      throw base::Error(base::ErrorKind::kUsage,
                        file.string() + " is not an EXR file; denoising needs scene-linear EXR");
  base::FileSet files;
  files.add_input(denoising.input, "image");
  files.add_output(denoising.output, "-o");
  base::check_creatable(denoising.output);
  const int threads = denoising.threads > 0 ? denoising.threads : default_threads();
  image::set_threads(threads);
  DenoisedFile out;
  const auto edit = [&](film::Picture& picture) {
    for (const char* channel : {"R", "G", "B"})
      if (picture.find(channel) == nullptr)
        throw base::Error(base::ErrorKind::kBadData,
                          fmt::format("{} has no half or float channel {}", denoising.input.string(), channel));
    out.report = denoise::denoise(picture, threads);
    return std::vector<image::Attribute>{{denoise::kAttribute, "orrery " + program_version()}};
  };
  out.written = image::rewrite_exr(denoising.input, denoising.output, edit);
  return out;
}

}  // namespace orrery::job
