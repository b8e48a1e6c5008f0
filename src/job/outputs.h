// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "annotation/drawing.h"
#include "display/develop.h"
#include "display/forward.h"
#include "display/settings.h"
#include "film/forward.h"
#include "film/picture.h"
#include "image/format.h"
#include "image/write.h"
#include "job/layers.h"

namespace orrery::job {

/// An image file to write. Its extension selects the format.
struct ImageFile {
  std::filesystem::path path;
  image::Format format;

  /// Determines the format from the extension.
  ///
  /// Errors     base::Error(kUsage) for an unknown extension
  // NOLINTNEXTLINE(google-explicit-constructor): a path is an image file
  ImageFile(std::filesystem::path file) : path(std::move(file)), format(image::format_of(path)) {}
};

/// A file that a job writes, and its role.
struct NamedOutput {
  std::filesystem::path path;
  std::string role;  ///< "-o", "--stats", "checkpoint"
};

/// Checks that every display format among these supports `bits` per channel; 0 always passes.
///
/// Errors     base::Error(kUsage)
void check_bits(const std::vector<ImageFile>& images, int bits);

/// The files that a job writes, and how.
struct Outputs {
  std::vector<ImageFile> images;     ///< at least one
  std::filesystem::path deep;        ///< deep EXR; empty: none
  std::filesystem::path statistics;  ///< JSON; empty: none
  display::Settings display;         ///< for display formats; the working space is the scene's
  int bits = 0;                      ///< per channel of display formats; 0: the display's default
  image::ExrOptions exr;
  bool reproducible = false;  ///< omit everything from headers that varies between runs

  /// True if an image is an EXR, the only format that holds layers.
  bool has_exr() const;
  /// True if an image needs a display transform.
  bool has_display_format() const;
};

/// Calls `use(path, role)` for each output that the user named.
template <class AnyOutputs, class Use>
void each_named(AnyOutputs& outputs, Use use) {
  for (auto& image : outputs.images) use(image.path, "-o");
  if (!outputs.deep.empty()) use(outputs.deep, "--deep");
  if (!outputs.statistics.empty()) use(outputs.statistics, "--stats");
}

/// Checks that the display formats among the outputs have enough bits per channel for the display.
///
/// Errors     base::Error(kUsage)
void require_bits(const display::Choice& display, const Outputs& outputs);

/// An image and what its files hold besides it.
struct FinishedPicture {
  const film::Picture& picture;
  const image::Header& header;
  const std::vector<MatteNames>& mattes;
  const annotation::Drawing& drawing;  ///< over the image; that of EXR files is a layer of `picture`
};

/// Writes the files of an image, and the manifests of its mattes.
///
/// `choice`   the resolved `display`; only its bits per channel are used, for display formats
/// Errors     base::Error: kCannotCreate, kIo; those of display::develop
image::WriteReport write_outputs(const Outputs& outputs, const display::Settings& display,
                                 const display::Choice& choice, const FinishedPicture& finished);

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
