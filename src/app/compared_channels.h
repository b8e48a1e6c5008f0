// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "film/picture.h"
#include "metrics/color_view.h"

namespace orrery::app {

/// The channels of two pictures that a comparison is of: up to three; one alone stands for all.
struct ComparedChannels {
  std::vector<std::string> names;
  metrics::ColorView picture, reference;
  /// Pixels that are left out, since one of the pictures has no hit there (film::kNothingHit); empty: none.
  std::vector<bool> left_out;
  std::uint64_t no_hit = 0;         ///< how many these are
  std::uint64_t no_hit_in_one = 0;  ///< in which the other picture has a hit
  /// A Cryptomatte is compared by coverage: `picture` is the share of each pixel that belongs to other things than in
  /// the reference, and `reference` is 0. The background counts as a thing.
  bool is_matte = false;
  std::vector<float> shares, zeros;  ///< of a matte
};

/// The colours R, G, B, or the channels of another layer, by its name or by that of a Cryptomatte.
///
/// `layer`    empty: the beauty
/// Domain     pictures of the same size, which outlive the result
/// Errors     base::Error(kBadData) if they are not in both pictures; lists the layers of the first
ComparedChannels compared_channels(const film::Picture& picture, const film::Picture& reference,
                                   const std::string& layer);

/// Channels by layer and their number, "Z, N (3), CryptoObject (12) and 2 more layers".
std::string channels_text(const std::vector<std::string>& channels);

}  // namespace orrery::app
