// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "display/settings.h"
#include "image/format.h"
#include "image/write.h"

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
/// `why`      added to the message
/// Errors     base::Error(kUsage)
void check_bits(const std::vector<ImageFile>& images, int bits, const std::string& why = {});

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

}  // namespace orrery::job
