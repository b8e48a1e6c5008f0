// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/picture.h"

namespace orrery::app {

/// How much a picture differs from a reference, over all values of the channels that both have.
struct Comparison {
  std::vector<std::string> channels;  ///< that were compared
  int width = 0, height = 0;          ///< px
  double rmse = 0;                    ///< root of the mean squared difference
  double relative_mse = 0;            ///< mean of (a - b)^2 / (b^2 + kRelativeFloor)
  double max = 0;                     ///< largest absolute difference
  std::string max_channel;            ///< where it is; empty where nothing differs
  int max_x = 0, max_y = 0;           ///< px, from the upper left
  std::uint64_t differing = 0;        ///< values that are not equal
  std::uint64_t not_finite = 0;       ///< values left out, since a or b is NaN or infinite

  /// Peak signal to noise, decibels, for a peak of 1; infinite where nothing differs.
  double psnr_db() const;
};

/// Keeps black from making the relative error infinite: a tenth of white, squared.
inline constexpr double kRelativeFloor = 0.01;

/// Errors     base::Error(kBadData) where sizes differ or no channel is common
Comparison compare(const film::Picture& picture, const film::Picture& reference);

/// The same for files. Scene-linear light is not comparable to what was developed for a display.
///
/// Errors     base::Error: as compare and image::read; kUsage for one file of each kind
Comparison compare_files(const std::filesystem::path& picture, const std::filesystem::path& reference);

/// For people.
std::string comparison_text(const Comparison& comparison);
/// As JSON, "orrery.compare/1"; a PSNR that is infinite is null.
std::string comparison_json(const Comparison& comparison);

}  // namespace orrery::app
