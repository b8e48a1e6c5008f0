// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "film/picture.h"

namespace orrery::image {

/// A scene-linear image of noise, which compresses badly; all values are exact in half.
inline film::Picture test_picture(int width, int height, const std::vector<std::string>& names = {"R", "G", "B", "A"}) {
  film::Picture picture{width, height, {}};
  std::uint32_t state = 1;
  for (const std::string& name : names) {
    film::Plane plane{name, std::vector<float>(static_cast<std::size_t>(width * height))};
    for (float& v : plane.values) {
      state = state * 1664525u + 1013904223u;
      v = static_cast<float>(state >> 22) / 256.0f;
    }
    picture.planes.push_back(plane);
  }
  return picture;
}

/// A display-encoded image of noise, or of ramps that survive JPEG if `smooth`.
inline film::EncodedPicture test_encoded(int width, int height, int bits, bool smooth = false) {
  film::EncodedPicture picture;
  picture.width = width;
  picture.height = height;
  picture.bits = bits;
  const std::uint32_t largest = bits == 8 ? 255 : 65535;
  std::uint32_t state = 1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        state = state * 1664525u + 1013904223u;
        const int ramp = c == 0 ? x : c == 1 ? y : x + y;
        const std::uint32_t v =
            smooth ? static_cast<std::uint32_t>(ramp) * largest / static_cast<std::uint32_t>(width + height)
                   : (state >> 8) % (largest + 1);
        picture.values.push_back(static_cast<std::uint16_t>(v));
      }
    }
  }
  return picture;
}

/// Expects an error of this kind whose message contains all `parts`.
template <class Function>
void expect_error(base::ErrorKind kind, const std::vector<std::string>& parts, Function function) {
  try {
    function();
    ADD_FAILURE() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(kind)) << error.what();
    for (const std::string& part : parts)
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what() << "\nlacks " << part;
  }
}

}  // namespace orrery::image
