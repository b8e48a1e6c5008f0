// SPDX-License-Identifier: Apache-2.0
#include "metrics/color_view.h"
#include <cmath>

namespace orrery::metrics {

double Map::mean() const {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v);
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

ColorView color_of(const film::Picture& picture, const std::string& prefix) {
  ColorView out;
  out.width = picture.width;
  out.height = picture.height;
  const char* const names[3] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const film::Plane* const plane = picture.find(prefix.empty() ? names[c] : prefix + "." + names[c]);
    if (plane == nullptr) return {out.width, out.height, {nullptr, nullptr, nullptr}};
    out.channel[c] = plane->values.data();
  }
  return out;
}

float srgb_encoded(float light) {
  return light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
}

float srgb_decoded(float code) { return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f); }

}  // namespace orrery::metrics
