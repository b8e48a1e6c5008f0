// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::metrics {

/// The sRGB transfer function, IEC 61966-2-1, from linear 0..1 to encoded 0..1, and its inverse.
float srgb_encoded(float light);
float srgb_decoded(float code);

}  // namespace orrery::metrics
