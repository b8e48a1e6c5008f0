// SPDX-License-Identifier: Apache-2.0
#include "job/outputs.h"

#include <algorithm>

#include "base/error.h"

namespace orrery::job {

std::vector<ImageFile> image_files(const std::vector<std::filesystem::path>& files) {
  std::vector<ImageFile> out;
  for (const std::filesystem::path& file : files) out.emplace_back(file);
  return out;
}

void check_bits(const std::vector<ImageFile>& images, int bits) {
  for (const ImageFile& image : images)
    if (image::is_display_format(image.format) && bits > image::max_bits(image.format))
      throw base::Error(base::ErrorKind::kUsage,
                        image.path.string() + " holds 8 bits per channel; use PNG or TIFF for 16");
}

bool Outputs::has_exr() const {
  return std::any_of(images.begin(), images.end(), [](const ImageFile& i) { return i.format == image::Format::kExr; });
}

bool Outputs::has_display_format() const {
  return std::any_of(images.begin(), images.end(), [](const ImageFile& i) { return is_display_format(i.format); });
}

}  // namespace orrery::job
