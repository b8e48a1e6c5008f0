// SPDX-License-Identifier: Apache-2.0
#include "film/film.h"

#include <gtest/gtest.h>

#include "film/picture.h"

namespace orrery::film {
namespace {

TEST(FilmFilm, PictureIsTheMeanOfTheSamples) {
  Film film(3, 2);
  kernel::PixelSum& sum = *film.at(2, 1);
  for (const double v : {0.25, 0.5, 3.0}) {
    sum.rgb[0] += kernel::to_fixed_point(v);
    ++sum.weight;
  }
  const Picture picture = film.picture();
  ASSERT_EQ(picture.planes.size(), 4u);
  EXPECT_EQ(picture.find("R")->values[5], 1.25f);
  EXPECT_EQ(picture.find("G")->values[5], 0.0f);
  EXPECT_EQ(picture.find("A")->values[0], 1.0f);
}

TEST(FilmFilm, APixelWithoutSamplesIsBlack) { EXPECT_EQ(Film(1, 1).picture().find("R")->values[0], 0.0f); }

}  // namespace
}  // namespace orrery::film
