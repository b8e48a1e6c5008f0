// SPDX-License-Identifier: Apache-2.0
#include "compare/color_view.h"

#include <algorithm>
#include <cmath>

namespace orrery::compare {

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

namespace {

constexpr int kSteps = 16;
constexpr float kMagma[kSteps + 1][3] = {{0.001f, 0.000f, 0.014f}, {0.040f, 0.031f, 0.134f}, {0.113f, 0.065f, 0.277f},
                                         {0.212f, 0.062f, 0.419f}, {0.317f, 0.072f, 0.485f}, {0.415f, 0.110f, 0.505f},
                                         {0.513f, 0.148f, 0.508f}, {0.614f, 0.182f, 0.499f}, {0.716f, 0.215f, 0.475f},
                                         {0.817f, 0.256f, 0.436f}, {0.904f, 0.320f, 0.388f}, {0.961f, 0.418f, 0.360f},
                                         {0.987f, 0.536f, 0.382f}, {0.996f, 0.654f, 0.446f}, {0.997f, 0.770f, 0.535f},
                                         {0.992f, 0.884f, 0.640f}, {0.987f, 0.991f, 0.750f}};

template <class F>
film::Picture picture_of(const Map& map, F channel) {
  film::Picture out;
  out.width = map.width;
  out.height = map.height;
  const char* const names[3] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    film::Plane plane{names[c], map.values};
    for (float& v : plane.values) v = channel(v, c);
    out.planes.push_back(std::move(plane));
  }
  out.planes.push_back({"A", std::vector<float>(map.values.size(), 1.0f)});
  return out;
}

}  // namespace

film::Picture false_color(const Map& map, double full) {
  return picture_of(map, [full](float value, int c) {
    const double at = full > 0 ? std::clamp(static_cast<double>(value) / full, 0.0, 1.0) * kSteps : 0;
    const int step = std::min(static_cast<int>(at), kSteps - 1);
    const auto part = static_cast<float>(at - step);
    return kMagma[step][c] + (kMagma[step + 1][c] - kMagma[step][c]) * part;
  });
}

film::EncodedPicture encoded(const film::Picture& codes) {
  film::EncodedPicture out;
  out.width = codes.width;
  out.height = codes.height;
  out.is_srgb = true;
  for (std::size_t i = 0; i < codes.planes[0].values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.values.push_back(
          static_cast<std::uint16_t>(std::lround(std::clamp(codes.planes[c].values[i], 0.0f, 1.0f) * 255)));
  return out;
}

film::Picture grey(const Map& map) {
  return picture_of(map, [](float value, int) { return value; });
}

}  // namespace orrery::compare
