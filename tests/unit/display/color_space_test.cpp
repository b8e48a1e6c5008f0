// SPDX-License-Identifier: Apache-2.0
#include "display/color_space.h"

#include <gtest/gtest.h>

#include <array>

#include "base/error.h"

namespace orrery::display {
namespace {

TEST(DisplayColorSpace, SpacesAreKnownByNameAliasAndPrimaries) {
  const KnownSpace* const space = known_space("ACES - ACEScg");
  ASSERT_NE(space, nullptr);
  EXPECT_EQ(space, known_space("acescg"));
  EXPECT_STREQ(space->interop_id, "lin_ap1_scene");
  EXPECT_EQ(known_space(space->chromaticities), space);
  const std::array<float, 8> rec709 = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
  EXPECT_EQ(known_space(rec709), known_space("Linear Rec.709 (sRGB)"));
  EXPECT_EQ(known_space("sRGB"), nullptr) << "not scene-linear";
  EXPECT_EQ(known_space(std::array<float, 8>{}), nullptr);
}

TEST(DisplayColorSpace, ColorsKeepWhiteAndChangePrimaries) {
  const PixelConversion convert = pixel_conversion("", "lin_rec709", "acescg");
  const math::Vec3d white = converted(convert, {1, 1, 1}), red = converted(convert, {1, 0, 0});
  for (const double v : {white.x, white.y, white.z}) EXPECT_NEAR(v, 1, 1e-5);
  EXPECT_NEAR(red.x, 0.6131, 1e-3);  // the red of Rec.709 in ACEScg
  EXPECT_NEAR(red.y, 0.0702, 1e-3);
  EXPECT_NEAR(red.z, 0.0206, 1e-3);
  const math::Vec3d back = converted(pixel_conversion("", "acescg", "lin_rec709"), red);
  EXPECT_NEAR(back.x, 1, 1e-5);
  EXPECT_NEAR(back.y, 0, 1e-5);
  EXPECT_EQ(converted({}, {0.1, 2, 3}), (math::Vec3d{0.1, 2, 3}));
}

TEST(DisplayColorSpace, PixelsOfTheSameSpaceNeedNoConversion) {
  EXPECT_FALSE(pixel_conversion("", "lin_rec709", "lin_rec709"));
  const PixelConversion convert = pixel_conversion("", "srgb_texture", "lin_rec709");
  ASSERT_TRUE(convert);
  float pixels[] = {0.5F, 0, 1};
  convert(pixels, 1);
  EXPECT_NEAR(pixels[0], 0.2140, 1e-3);
  EXPECT_NEAR(pixels[1], 0, 1e-6);
  EXPECT_NEAR(pixels[2], 1, 1e-6);
}

TEST(DisplayColorSpace, UnknownSpacesAreUsageErrors) {
  try {
    pixel_conversion("", "lin_rec709", "none such");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("none such"), std::string::npos);
  }
}

}  // namespace
}  // namespace orrery::display
