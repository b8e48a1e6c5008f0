// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "film/picture.h"
#include "metrics/pixel_errors.h"
#include "metrics/z_test.h"

namespace orrery::app {

/// Whether a picture holds light, or the codes of a display.
enum class Encoding : std::uint8_t { kLight, kDisplay };

/// How much a picture differs from a reference.
struct Comparison {
  int width = 0, height = 0;          ///< px
  std::vector<std::string> channels;  ///< that the errors are of
  metrics::PixelErrors errors;
  std::optional<double> ssim;                   ///< of colours
  std::optional<double> flip;                   ///< the mean, of colours; of light the one for high dynamic range
  std::optional<metrics::ZTest> z_test;         ///< where the picture has a layer `variance`
  std::uint64_t values = 0, differing = 0;      ///< of all common channels, and those not equal
  bool is_matte = false;                        ///< the errors are of ComparedChannels::shares
  std::uint64_t no_hit = 0, no_hit_in_one = 0;  ///< pixels left out, as in ComparedChannels
  std::vector<std::string> only_in_picture, only_in_reference;  ///< channels that the other lacks

  // As pictures, of colours.
  metrics::Map flip_map, display_map;

  /// A metric by the name that `--fail-above` gives it.
  ///
  /// Domain     one of limitable_metrics()
  /// Errors     base::Error(kUsage) where these pictures have no such metric
  double metric(const std::string& name) const;
};

/// The metrics that grow with the difference, so that a largest value makes sense.
const std::vector<std::string>& limitable_metrics();

/// Compares the colours R, G, B, or the channels of another layer, which must be in both.
///
/// `layer`    empty: the beauty
/// `threads`  0: default_threads()
/// Errors     base::Error(kBadData) if sizes differ, the channels are not in both, or no value can be compared
Comparison compare(const film::Picture& picture, const film::Picture& reference, Encoding encoding,
                   const std::string& layer = {}, int threads = 0);

/// Pictures of a comparison that were asked for; empty: none.
struct ComparisonPictures {
  std::filesystem::path difference, heat, flip;
};

/// The same for files. Scene-linear light is not comparable to what was developed for a display.
///
/// Of a difference a file of light holds the numbers themselves, a display format half of them above mid-grey; heat is
/// the display error in false colours up to kHottest, and FLIP's map up to 1.
///
/// Errors     base::Error: as compare, image::read and image::write; kUsage for one file of each kind
Comparison compare_files(const std::filesystem::path& picture, const std::filesystem::path& reference,
                         const std::string& layer, const ComparisonPictures& pictures, int threads = 0);

/// The largest display error that the heat map tells apart.
inline constexpr double kHottest = 0.1;

/// For people.
std::string comparison_text(const Comparison& comparison);
/// As JSON, "orrery.compare/2"; what does not apply is null.
std::string comparison_json(const Comparison& comparison);

}  // namespace orrery::app
