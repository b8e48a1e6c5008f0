// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/color_view.h"
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

/// Summarizes channels by layer with their counts: "Z, N (3), CryptoObject (12) and 2 more layers".
std::string channels_text(const std::vector<std::string>& channels);

}  // namespace orrery::compare
