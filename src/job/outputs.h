// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "display/settings.h"
#include "image/exr_options.h"
#include "image/format.h"

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

/// The formats of several files.
///
/// Errors     those of ImageFile
std::vector<ImageFile> image_files(const std::vector<std::filesystem::path>& files);

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

}  // namespace orrery::job
