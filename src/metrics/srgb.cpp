// SPDX-License-Identifier: Apache-2.0
#include "metrics/srgb.h"

#include <cmath>

namespace orrery::metrics {

float srgb_encoded(float light) {
  return light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
}

float srgb_decoded(float code) { return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f); }

}  // namespace orrery::metrics
