// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::metrics {

/// The curve of sRGB screens, IEC 61966-2-1: from light 0..1 to code 0..1 and back.
float srgb_encoded(float light);
float srgb_decoded(float code);

}  // namespace orrery::metrics
