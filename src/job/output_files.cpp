// SPDX-License-Identifier: Apache-2.0
#include "job/output_files.h"

#include "base/error.h"
#include "image/format.h"

namespace orrery::job {

void check_formats(const std::vector<std::filesystem::path>& pictures, int bits) {
  for (const std::filesystem::path& file : pictures) {
    const image::Format format = image::format_of(file);
    if (image::is_display_format(format) && bits > image::most_bits(format))
      throw base::Error(base::ErrorKind::kUsage, file.string() + " holds 8 bits in a channel; PNG and TIFF hold 16");
  }
}

}  // namespace orrery::job
