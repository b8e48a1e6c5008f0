// SPDX-License-Identifier: Apache-2.0
#include "film/sums.h"

#include <gtest/gtest.h>

#include "film/layers.h"
#include "film/picture.h"
#include "support/picture_of.h"

namespace orrery::film {
namespace {

TEST(FilmSums, ImageIsTheMeanOfTheSamples) {
  Sums sums(3, 2);
  for (const double v : {0.25, 0.5, 3.0}) {
    sums.light[0][5].rgb[0] += kernel::to_fixed_point(v);
    ++sums.light[0][5].weight;
  }
  const Picture picture = test::picture_of(sums);
  ASSERT_EQ(picture.planes.size(), 4u);
  EXPECT_EQ(picture.find("R")->values, (std::vector<float>{0, 0, 0, 0, 0, 1.25F}));  // 0 without samples
  EXPECT_EQ(picture.find("G")->values[5], 0.0F);
  EXPECT_EQ(picture.find("A")->values, std::vector<float>(6, 1.0F));
}

TEST(FilmSums, HasTheArraysOfItsLayers) {
  LayerRequest z;
  z.z = true;
  const Sums plain(3, 2), with_z(3, 2, z);
  EXPECT_TRUE(with_z.has_arrays_of(plain));
  EXPECT_FALSE(plain.has_arrays_of(with_z));
  EXPECT_EQ(plain.bytes(), 6 * (sizeof(kernel::PixelSum) + sizeof(std::uint32_t)));
  EXPECT_EQ(with_z.bytes() - plain.bytes(), 6 * (sizeof(std::uint32_t) + sizeof(double) + sizeof(float)));
}

}  // namespace
}  // namespace orrery::film
