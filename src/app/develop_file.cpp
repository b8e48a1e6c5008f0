// SPDX-License-Identifier: Apache-2.0
#include "app/develop_file.h"

#include "app/version.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "image/format.h"
#include "image/read.h"
#include "image/write.h"

namespace orrery::app {

void develop_file(const std::filesystem::path& input, const std::vector<std::filesystem::path>& outputs,
                  const display::Settings& settings, int bits) {
  for (const auto& output : outputs) {
    if (!image::is_display_format(image::format_of(output)))
      throw base::Error(base::ErrorKind::kUsage, output.string() + " would hold scene-linear light; a developed picture is "
                                                                   "for png, tiff, jpg or ppm");
    base::check_creatable(output);
  }
  const film::EncodedPicture picture = display::develop(image::read(input), settings, bits);
  for (const auto& output : outputs) image::write_encoded(output, picture, "orrery " + program_version());
}

}  // namespace orrery::app
