// SPDX-License-Identifier: Apache-2.0
#include "job/display_writer.h"

#include "display/develop.h"
#include "image/format.h"
#include "image/write.h"

namespace orrery::job {

void DisplayWriter::write(const std::filesystem::path& file, const std::string& software, const std::string& stamp) {
  const bool keeps_alpha = picture_.is_transparent && image::holds_alpha(image::format_of(file));
  std::optional<film::EncodedPicture>& developed = keeps_alpha ? with_alpha_ : over_black_;
  if (!developed)
    developed = display::develop(picture_, settings_, bits_, false,
                                 keeps_alpha ? display::Alpha::kStraight : display::Alpha::kOverBlack);
  image::write_encoded(file, *developed, software, stamp);
}

}  // namespace orrery::job
