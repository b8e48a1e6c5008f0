// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "compare/color_view.h"
#include "compare/perceptual.h"

namespace orrery::compare {

/// An image that owns its values, with its view.
struct Own {
  std::vector<float> values[3];
  ColorView view;

  template <class F>
  Own(int width, int height, F f) : view{width, height, {}} {
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) values[c].push_back(static_cast<float>(f(x, y, c)));
      view.channel[c] = values[c].data();
    }
  }
  Maps maps() const { return maps_of(view, std::identity()); }
  Own(const Own&) = delete;
  Own& operator=(const Own&) = delete;
};

/// An image of one colour.
inline Own flat(float r, float g, float b) {
  return Own(24, 16, [=](int, int, int c) { return c == 0 ? r : c == 1 ? g : b; });
}

}  // namespace orrery::compare
