// SPDX-License-Identifier: Apache-2.0
#include "job/outputs.h"

#include <algorithm>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::job {

void check_bits(const std::vector<ImageFile>& images, int bits, const std::string& why) {
  for (const ImageFile& image : images)
    if (image::is_display_format(image.format) && bits > image::max_bits(image.format))
      base::refuse(fmt::format("{} holds 8 bits per channel{}; PNG and TIFF hold 16", image.path.string(), why));
}

bool Outputs::has_exr() const {
  return std::any_of(images.begin(), images.end(), [](const ImageFile& i) { return i.format == image::Format::kExr; });
}

bool Outputs::has_display_format() const {
  return std::any_of(images.begin(), images.end(), [](const ImageFile& i) { return is_display_format(i.format); });
}

void require_bits(const display::Choice& display, const Outputs& outputs) {
  check_bits(outputs.images, display.default_bits(), ", too few for display " + display.display);
}

}  // namespace orrery::job
