// SPDX-License-Identifier: Apache-2.0
#include "metrics/color_view.h"

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

}  // namespace orrery::metrics
