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
  std::vector<std::string> layers;  ///< light layers that were filtered with the beauty
  /// False: more than a sixteenth of the pixels have samples in one half only, so that the noise cannot be measured.
  /// The image is unchanged.
  bool is_filtered = false;
  /// Pixels without samples, or whose beauty is not finite or too large. They remain unchanged.
  std::uint64_t bad_pixels = 0;
};

/// Filters the noise of an image's beauty, and applies the same weights to its light layers (lobe AOVs, light groups
/// and the lobes of the groups). If they added up to the beauty, they still do, bit for bit in single precision. Alpha
/// is filtered with the same weights if part of the image is transparent, since colours are premultiplied. Other planes
/// are unchanged. The sum over the image is preserved, within the limits of LightBalance.
///
/// The weights come from the layer `halves`.
///
/// `threads`       number of threads; 0: all that the process may use
/// `keeps_halves`  false: removes the layer `halves` early, which saves memory
/// Result     the same bits on any number of threads and with any instruction set
/// Errors     base::Error: kBadData if the image lacks R, G, B or the layer `halves`; kStopped in a base::StopScope
/// Reference  rousselle2012, bitterli2016
Report denoise(film::Picture& picture, int threads = 0, bool keeps_halves = true);

}  // namespace orrery::denoise
