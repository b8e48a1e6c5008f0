// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "display/forward.h"
#include "film/picture.h"

namespace orrery::job {

/// Writes one image to display formats. The display transform runs once for all files with the same channels. PNG and
/// TIFF keep the alpha of a transparent image.
class DisplayWriter {
 public:
  /// Prepares an image for display formats; write() applies the display transform on first use.
  ///
  /// Domain     the arguments outlive this; bits 8 or 16
  DisplayWriter(const film::Picture& picture, const display::Settings& settings, int bits)
      : picture_(picture), settings_(settings), bits_(bits) {}

  /// Writes a file in the display format of its extension.
  ///
  /// Errors     those of display::develop and image::write_encoded
  void write(const std::filesystem::path& file, const std::string& software, const std::string& stamp = {});

 private:
  const film::Picture& picture_;
  const display::Settings& settings_;
  int bits_;
  std::optional<film::EncodedPicture> over_black_, with_alpha_;
};

}  // namespace orrery::job
