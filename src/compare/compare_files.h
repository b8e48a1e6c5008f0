// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare/color_view.h"
#include "compare/errors.h"
#include "film/picture.h"

namespace orrery::compare {

/// The channels of two images that a comparison covers. With fewer than three, the views repeat the last one.
struct ComparedChannels {
  std::vector<std::string> names;
  ColorView picture, reference;
  /// Flags of pixels that are skipped because an image has no hit there (film::kNothingHit); empty: none.
  std::vector<bool> excluded;
  std::uint64_t no_hit = 0;         ///< number of skipped pixels
  std::uint64_t no_hit_in_one = 0;  ///< number of skipped pixels with a hit in the other image
  /// A Cryptomatte is compared by coverage: `picture` is the fraction of each pixel that belongs to different objects
  /// than in the reference, and `reference` is 0. The background counts as an object.
  bool is_matte = false;
  std::vector<float> shares, zeros;  ///< pixel values behind the views `picture` and `reference` for a matte
};

/// True if a channel belongs to the layer or Cryptomatte of this name; an empty `layer` matches all channels.
bool is_of_layer(const film::Plane& channel, const std::string& layer);

/// Selects the channels to compare: R, G, B for an empty `layer`, else those of the layer or Cryptomatte of this name.
///
/// Domain     images of the same size, which outlive the result
/// Errors     base::Error(kBadData) if they are not in both images; lists the layers of the first
ComparedChannels compared_channels(const film::Picture& picture, const film::Picture& reference,
                                   const std::string& layer);

/// The layers of channels, in the order of their first ones. A channel without a layer counts as one.
std::vector<std::string> layers_of(const std::vector<std::string>& channels);

/// Whether an image is scene-linear or display-encoded.
enum class Encoding : std::uint8_t { kLight, kDisplay };

/// Differences between an image and a reference.
struct Comparison {
  int width = 0, height = 0;          ///< px
  std::vector<std::string> channels;  ///< channels that `errors` covers
  PixelErrors errors;
  std::optional<double> ssim;   ///< colours only
  std::optional<double> flip;   ///< mean of flip_map; HDR-FLIP if scene-linear; colours only
  std::optional<ZTest> z_test;  ///< set if the image has a layer `variance`
  std::uint64_t values = 0,
                differing = 0;                  ///< values in common channels of the layer, and how many differ
  bool is_matte = false;                        ///< `errors` compares ComparedChannels::shares
  std::uint64_t no_hit = 0, no_hit_in_one = 0;  ///< skipped pixels, as in ComparedChannels
  std::vector<std::string> only_in_picture, only_in_reference;  ///< channels missing in the other image

  Map flip_map, display_map;  ///< per-pixel FLIP and display error

  /// The name of a channel of `errors` or `z_test`.
  const std::string& channel(int index) const {
    return channels[std::min(static_cast<std::size_t>(index), channels.size() - 1)];
  }
  /// Returns a metric, given its name in `--fail-above`.
  ///
  /// Domain     one of limitable_metrics()
  /// Errors     base::Error(kUsage) if these images do not have the metric
  double metric(const std::string& name) const;
};

/// The metrics that `--fail-above` accepts: those that grow with the difference.
const std::vector<std::string>& limitable_metrics();

/// Compares R, G, B, or the channels of another layer, which must be in both images. Without a layer, `differing`
/// counts the values of all channels.
///
/// Domain     `layer` empty: the beauty; `threads` 0: default_threads()
/// Errors     base::Error(kBadData) if sizes differ, the channels are not in both images, or no value can be compared
Comparison compare(const film::Picture& picture, const film::Picture& reference, Encoding encoding,
                   const std::string& layer = {}, int threads = 0);

/// Paths of the error maps to write. An empty path writes none.
struct ComparisonPictures {
  std::filesystem::path heat, flip;
};

/// Compares two image files, and writes error maps: EXR files hold the values, display formats show the display error
/// up to kFalseColorMax and FLIP up to 1 in false colours.
///
/// Errors     those of compare, image::read and image::write; base::Error(kUsage) if one file is scene-linear and the
///            other display-encoded
Comparison compare_files(const std::filesystem::path& picture, const std::filesystem::path& reference,
                         const std::string& layer, const ComparisonPictures& pictures, int threads = 0);

/// A comparison as text.
std::string comparison_text(const Comparison& comparison);
/// A comparison as JSON, schema "orrery.compare/2"; metrics that do not apply are null.
std::string comparison_json(const Comparison& comparison);

}  // namespace orrery::compare
