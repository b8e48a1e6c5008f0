// SPDX-License-Identifier: Apache-2.0
#include "denoise/source_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace orrery::denoise {
namespace {

constexpr int kSmallWidth = 16, kSmallHeight = 4;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A grey image whose halves differ.
film::Picture grey() {
  film::Picture out{kSmallWidth, kSmallHeight, {}};
  const auto add = [&](const std::string& name, float value) {
    out.planes.push_back({name, std::vector<float>(kSmallWidth * kSmallHeight, value)});
  };
  for (const char* name : {"R", "G", "B"}) add(name, 0.5F);
  for (const auto& [half, light] : {std::pair{"half_a", 0.4F}, std::pair{"half_b", 0.6F}}) {
    for (const char* end : {".R", ".G", ".B"}) add(std::string(half) + end, light);
    for (const char* end :
         {".albedo.R", ".albedo.G", ".albedo.B", ".normal.X", ".normal.Y", ".normal.Z", ".inverse_depth.X"})
      add(std::string(half) + end, 0.25F);
  }
  return out;
}

/// Removes the samples of one half of the first pixels.
film::Picture without_half_b(int pixels) {
  film::Picture out = grey();
  for (film::Plane& plane : out.planes)
    if (plane.name.starts_with("half_b.")) std::fill_n(plane.values.begin(), pixels, kNan);
  return out;
}

TEST(DenoiseSourcePlanes, EveryChannelOfBothHalvesIsNeeded) {
  const film::Picture complete = grey();
  for (const film::Plane& plane : complete.planes) {
    film::Picture incomplete = complete;
    std::erase_if(incomplete.planes, [&](const film::Plane& other) { return other.name == plane.name; });
    EXPECT_THROW(source_planes(incomplete, true), base::Error) << plane.name;
  }
}

TEST(DenoiseSourcePlanes, AHalfWithoutSamplesIsThatOfTheOther) {
  film::Picture picture = without_half_b(1);
  const auto planes = source_planes(picture, true);
  ASSERT_TRUE(planes);
  EXPECT_EQ(*planes->b[0].at(0, 0), 0.4F);
  EXPECT_EQ(*planes->b[0].at(1, 0), 0.6F);
  EXPECT_EQ(*planes->valid.at(0, 0), 1);
}

TEST(DenoiseSourcePlanes, UpToASixteenthOfThePixelsMayHaveOneHalf) {
  film::Picture few = without_half_b(kSmallWidth * kSmallHeight / 16),
                many = without_half_b(kSmallWidth * kSmallHeight / 16 + 1);
  EXPECT_TRUE(source_planes(few, true));
  EXPECT_FALSE(source_planes(many, true));
}

TEST(DenoiseSourcePlanes, PixelsWithoutAFiniteBeautyOrSamplesAreInvalid) {
  film::Picture picture = grey();
  for (film::Plane& plane : picture.planes) {
    if (plane.name == "G") plane.values[5] = kNan;
    if (film::is_half(plane.name)) plane.values[7] = kNan;
  }
  const auto planes = source_planes(picture, true);
  ASSERT_TRUE(planes);
  for (int x = 0; x < kSmallWidth; ++x) EXPECT_EQ(*planes->valid.at(x, 0), x == 5 || x == 7 ? 0 : 1) << x;
}

TEST(DenoiseSourcePlanes, HalvesAreFreedUnlessTheyAreKept) {
  film::Picture kept = grey(), released = kept;
  const auto a = source_planes(kept, true), b = source_planes(released, false);
  ASSERT_TRUE(a && b);
  for (const film::Plane& plane : kept.planes) EXPECT_FALSE(plane.values.empty()) << plane.name;
  for (const film::Plane& plane : released.planes)
    EXPECT_EQ(plane.values.empty(), film::is_half(plane.name)) << plane.name;
  ASSERT_EQ(a->guides.size(), b->guides.size());
  EXPECT_EQ(*a->guides[0].at(3, 2), *b->guides[0].at(3, 2));
}

}  // namespace
}  // namespace orrery::denoise
