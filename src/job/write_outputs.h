// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "annotation/drawing.h"
#include "display/develop.h"
#include "display/forward.h"
#include "film/picture.h"
#include "image/write.h"
#include "job/outputs.h"

namespace orrery::job {

/// Writes the files of an image.
///
/// `choice`   the resolved `display`; only its bits per channel are used, for display formats
/// `drawing`  over the image; that of EXR files is a layer of `picture`
/// Errors     base::Error: kCannotCreate, kIo; those of display::develop
image::WriteReport write_outputs(const Outputs& outputs, const display::Settings& display,
                                 const display::Choice& choice, const film::Picture& picture,
                                 const image::Header& header, const annotation::Drawing& drawing);

/// Applies the display transform, then draws the annotation.
///
/// Errors     those of display::develop and annotation::draw
film::EncodedPicture develop_annotated(const film::Picture& picture, const annotation::Drawing& drawing,
                                       const display::Settings& settings, int bits, display::Alpha alpha);

/// Writes one image to display formats. The display transform runs once for all files with the same channels. PNG,
/// TIFF and SVG keep the alpha of a transparent image.
class DisplayWriter {
 public:
  /// Prepares an image for display formats; write() applies the display transform on first use.
  ///
  /// `drawing`  over the image
  /// Domain     the arguments outlive this; bits 8 or 16
  DisplayWriter(const film::Picture& picture, const display::Settings& settings, int bits,
                const annotation::Drawing& drawing)
      : picture_(picture), settings_(settings), bits_(bits), drawing_(drawing) {}

  /// Writes a file in the display format of its extension.
  ///
  /// `dpi`      resolution in print, px per inch; 0: not known
  /// Errors     those of display::develop, image::write_encoded and base::write_text_file
  void write(const std::filesystem::path& file, const std::string& software, const std::string& stamp = {},
             double dpi = 0);

 private:
  void write_svg(const std::filesystem::path& file, display::Alpha alpha) const;

  const film::Picture& picture_;
  const display::Settings& settings_;
  int bits_;
  const annotation::Drawing& drawing_;
  std::optional<film::EncodedPicture> over_black_, with_alpha_;
};

}  // namespace orrery::job
