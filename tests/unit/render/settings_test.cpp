// SPDX-License-Identifier: Apache-2.0
#include "render/settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace orrery::render {
namespace {

TEST(RenderSettings, EveryPixelBelongsToOneShard) {
  for (const int count : {1, 2, 3, 17, 1000}) {
    std::vector<int> owners(130 * 67, 0);
    for (int i = 0; i < count; ++i) {
      const std::vector<bool> owned = pixels_of({i, count}, 130, 67);
      for (std::size_t p = 0; p < owners.size(); ++p) owners[p] += owned[p] ? 1 : 0;
    }
    EXPECT_EQ(std::count(owners.begin(), owners.end(), 1), 130 * 67) << count;
  }
}

}  // namespace
}  // namespace orrery::render
