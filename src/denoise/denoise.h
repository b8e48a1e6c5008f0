// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "film/picture.h"

namespace orrery::denoise {

/// Header attribute of a denoised image: the program that denoised it.
inline constexpr const char* kAttribute = "orrery/denoised";

/// Report of denoise().
struct Report {
  std::vector<std::string> layers;   ///< light layers that were filtered with the beauty
  std::vector<std::string> missing;  ///< layers that would improve the result, but that the image lacks
  bool has_guides = false;           ///< the filter used albedo and normal as guides
  /// Pixels without samples, or whose beauty is not finite or too large. They remain unchanged.
  std::uint64_t bad_pixels = 0;
};

/// Filters the noise of an image's beauty, and applies the same weights to its light layers (lobe AOVs, light groups
/// and the lobes of the groups). If they added up to the beauty, they still do, bit for bit in single precision. Alpha
/// is filtered with the same weights if part of the image is transparent, since colours are premultiplied. Other planes
/// are unchanged. The sum over the image is preserved, within the limits of LightBalance.
///
/// The weights come from the layer `halves`, or, if the image lacks it, from the guides `denoise.albedo`,
/// `denoise.normal` and `depth`, from `variance` and from the beauty itself.
///
/// `threads`       number of threads; 0: all that the process may use
/// `keeps_halves`  false: removes the layer `halves` early, which saves memory
/// Result     the same bits on any number of threads and with any instruction set
/// Errors     base::Error(kBadData) if the image has no R, G and B
/// Reference  rousselle2012, bitterli2016
Report denoise(film::Picture& picture, int threads = 0, bool keeps_halves = true);

}  // namespace orrery::denoise
