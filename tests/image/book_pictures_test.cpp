// SPDX-License-Identifier: Apache-2.0
// Checks in small images of the scenes what the book describes in its figures. Positions are fractions of width and
// height from the upper left.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "film/picture.h"
#include "image/render_scene.h"
#include "load/read_scene.h"
#include "math/vec3.h"
#include "render/render.h"
#include "support/read_scene_file.h"

namespace orrery {
namespace {

using math::Vec3d;

constexpr int kWidth = 160, kHeight = 90;

film::Picture picture_of(const std::string& name, load::Overrides overrides = {}) {
  overrides.add("image.width=" + std::to_string(kWidth));
  overrides.add("image.height=" + std::to_string(kHeight));
  return test::render_scene(
      support::read_scene_file(std::filesystem::path(ORRERY_SCENES) / "book" / (name + ".toml"), overrides));
}

/// Mean colour of a block of 7 x 7 pixels.
Vec3d color_at(const film::Picture& picture, double u, double v) {
  const int x0 = static_cast<int>(u * kWidth), y0 = static_cast<int>(v * kHeight);
  double sums[3] = {};
  int count = 0;
  for (int y = std::max(y0 - 3, 0); y <= std::min(y0 + 3, kHeight - 1); ++y) {
    for (int x = std::max(x0 - 3, 0); x <= std::min(x0 + 3, kWidth - 1); ++x) {
      for (std::size_t c = 0; c < 3; ++c)
        sums[c] += static_cast<double>(picture.planes[c].values[static_cast<std::size_t>(y * kWidth + x)]);
      ++count;
    }
  }
  return {sums[0] / count, sums[1] / count, sums[2] / count};
}

double brightness(Vec3d c) { return (c.x + c.y + c.z) / 3; }
/// The ground of the metal and glass scenes reflects no blue.
bool is_ground(Vec3d c) { return c.z < 0.3 * c.x; }
bool is_sky(Vec3d c) { return c.z > c.x && c.x > 0.4; }

/// Maximum difference in blue between neighbouring pixels of a row. The ground's blue is 0 without noise.
double steepest_blue(const film::Picture& picture, double v, double u_from, double u_to) {
  const auto& blue = picture.find("B")->values;
  const auto row = static_cast<std::size_t>(static_cast<int>(v * kHeight) * kWidth);
  float most = 0;
  for (auto x = static_cast<std::size_t>(u_from * kWidth); x + 1 < static_cast<std::size_t>(u_to * kWidth); ++x)
    most = std::max(most, std::abs(blue[row + x + 1] - blue[row + x]));
  return static_cast<double>(most);
}

TEST(ImageBookPictures, SkyIsBluerAtTheTop) {
  const auto p = picture_of("01-gradient-sky");
  const Vec3d top = color_at(p, 0.5, 0), middle = color_at(p, 0.5, 0.5), bottom = color_at(p, 0.5, 1);
  EXPECT_LT(top.x, middle.x);
  EXPECT_LT(middle.x, bottom.x);
  EXPECT_NEAR(top.z, 1, 1e-6);
  EXPECT_NEAR(bottom.z, 1, 1e-6);
  EXPECT_NEAR(middle.x, 0.75, 0.01);  // horizontal: the mean of white, 1, and blue, 0.5
}

TEST(ImageBookPictures, RedSphereIsFlat) {
  const auto p = picture_of("02-red-sphere");
  for (const double v : {0.35, 0.5, 0.65}) EXPECT_EQ(color_at(p, 0.5, v), (Vec3d{1, 0, 0}));
  EXPECT_TRUE(is_sky(color_at(p, 0.1, 0.5)));
}

TEST(ImageBookPictures, NormalsAreShownAsColours) {
  const auto p = picture_of("03-normals-one-sphere");
  EXPECT_GT(color_at(p, 0.62, 0.5).x, color_at(p, 0.38, 0.5).x + 0.4);
  EXPECT_GT(color_at(p, 0.5, 0.27).y, color_at(p, 0.5, 0.73).y + 0.4);
  EXPECT_GT(color_at(p, 0.5, 0.5).z, 0.98);
  const auto ground = color_at(picture_of("04-normals-with-ground"), 0.5, 0.95);
  EXPECT_NEAR(ground.x, 0.5, 0.02);
  EXPECT_NEAR(ground.y, 1.0, 0.02);
}

TEST(ImageBookPictures, ManySamplesAntialiasTheEdge) {
  // To the left of the ball are the sky (blue 1) and the ground (blue 0.5); a single sample is one or the other.
  const auto mixed_pixels = [](const film::Picture& p) {
    int count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth / 4; ++x) {
        const float blue = p.find("B")->values[static_cast<std::size_t>(y * kWidth + x)];
        count += blue > 0.6f && blue < 0.9f;
      }
    }
    return count;
  };
  EXPECT_EQ(mixed_pixels(picture_of("04-normals-with-ground")), 0);
  EXPECT_GT(mixed_pixels(picture_of("05-antialiased")), kWidth / 8);
}

TEST(ImageBookPictures, LowRayLimitDarkensTheCreviceUnderTheBall) {
  const auto fifty = picture_of("07-child-ray-limit"), two = picture_of("07-child-ray-limit", {"render.max_depth=2"});
  EXPECT_LT(brightness(color_at(two, 0.5, 0.8)), 0.75 * brightness(color_at(fifty, 0.5, 0.8)));
  EXPECT_NEAR(brightness(color_at(picture_of("06-hemisphere-diffuse"), 0.5, 0.5)),
              brightness(color_at(fifty, 0.5, 0.5)), 1e-6);
}

TEST(ImageBookPictures, AcneDarkensAndExactHasNone) {
  const auto ball = [](const film::Picture& p) { return brightness(color_at(p, 0.5, 0.5)); };
  const double fixed = ball(picture_of("09-shadow-acne-fixed"));
  EXPECT_LT(ball(picture_of("08-shadow-acne")), 0.7 * fixed);
  EXPECT_NEAR(ball(picture_of("08-shadow-acne", {"render.precision=exact"})), fixed, 0.01 * fixed);
}

TEST(ImageBookPictures, LambertianShadowIsDarkerAndTheBallBrighter) {
  const auto hemisphere = picture_of("06-hemisphere-diffuse"), lambertian = picture_of("10-lambertian");
  EXPECT_GT(brightness(color_at(lambertian, 0.5, 0.4)), 1.03 * brightness(color_at(hemisphere, 0.5, 0.4)));
  EXPECT_LT(brightness(color_at(lambertian, 0.5, 0.81)), 0.95 * brightness(color_at(hemisphere, 0.5, 0.81)));
}

TEST(ImageBookPictures, ReflectanceIncreasesToTheRight) {
  const auto p = picture_of("11-gamma");
  double last = 0;
  for (const double u : {0.133, 0.316, 0.5, 0.684, 0.867}) {
    const double b = brightness(color_at(p, u, 0.48));
    EXPECT_GT(b, last + 0.05) << u;
    last = b;
  }
}

TEST(ImageBookPictures, MetalReflectsUprightAndFuzzBlurs) {
  const auto p = picture_of("12-metal");
  for (const double u : {0.2, 0.8}) {
    EXPECT_FALSE(is_ground(color_at(p, u, 0.35))) << u;
    EXPECT_TRUE(is_ground(color_at(p, u, 0.65))) << u;
  }
  const Vec3d gold = color_at(p, 0.8, 0.35), silver = color_at(p, 0.2, 0.35);
  EXPECT_LT(gold.z / gold.x, 0.5 * silver.z / silver.x);
  const Vec3d fuzzy = color_at(picture_of("13-fuzzy-metal"), 0.8, 0.65);
  const Vec3d sharp = color_at(p, 0.8, 0.65);
  EXPECT_GT(fuzzy.z / fuzzy.x, 2 * sharp.z / sharp.x) << "with maximum fuzz the lower half reflects some sky";
}

TEST(ImageBookPictures, RefractingGlassShowsTheSceneUpsideDown) {
  for (const char* name : {"14-glass-always-refracts", "16-glass-schlick"}) {
    const auto p = picture_of(name);
    EXPECT_TRUE(is_ground(color_at(p, 0.19, 0.31))) << name;
    EXPECT_TRUE(is_sky(color_at(p, 0.19, 0.62))) << name;
  }
}

TEST(ImageBookPictures, BubbleAndHollowGlassShowTheSceneUpright) {
  for (const char* name : {"15-glass-total-internal-reflection", "17-hollow-glass"}) {
    const auto p = picture_of(name);
    EXPECT_TRUE(is_sky(color_at(p, 0.19, 0.4))) << name;
    EXPECT_TRUE(is_ground(color_at(p, 0.19, 0.65))) << name;
  }
}

TEST(ImageBookPictures, BubbleRimReflectsTheBlueBall) {
  const auto p = picture_of("15-glass-total-internal-reflection");
  const Vec3d rim = color_at(p, 0.345, 0.5), further_in = color_at(p, 0.28, 0.45);
  EXPECT_LT(rim.x, 0.4);
  EXPECT_GT(rim.z, 1.5 * rim.x);
  EXPECT_TRUE(is_sky(further_in));
}

TEST(ImageBookPictures, SchlickBrightensTheRim) {
  // Near its upper edge the refracting ball shows dark ground; Schlick reflection adds sky.
  EXPECT_GT(color_at(picture_of("16-glass-schlick"), 0.125, 0.235).z,
            color_at(picture_of("14-glass-always-refracts"), 0.125, 0.235).z + 0.05);
}

TEST(ImageBookPictures, WideAngleHasBlueOnTheLeft) {
  const auto p = picture_of("18-wide-angle-two-spheres");
  const Vec3d left = color_at(p, 0.2, 0.5), right = color_at(p, 0.8, 0.5);
  EXPECT_GT(left.z, 0.3);
  EXPECT_EQ(left.x, 0);
  EXPECT_GT(right.x, 0.2);
  EXPECT_EQ(right.z, 0);
}

TEST(ImageBookPictures, ZoomMagnifies) {
  const auto far = picture_of("19-far-view"), zoomed = picture_of("20-zoomed-view");
  const auto blue_pixels = [](const film::Picture& p) {
    int count = 0;
    for (std::size_t i = 0; i < p.planes[0].values.size(); ++i)
      count += p.planes[2].values[i] > 2 * p.planes[0].values[i];
    return count;
  };
  const double magnified = static_cast<double>(blue_pixels(zoomed)) / blue_pixels(far);
  const double expected = std::pow(std::tan(0.7853981633974483) / std::tan(0.17453292519943295), 2);
  EXPECT_NEAR(magnified / expected, 1, 0.2);  // perspective distortion at the ball's edges
}

TEST(ImageBookPictures, DefocusBlursInFrontOfAndBehindTheFocusPlane) {
  // Flat shading leaves edges only: glass in front is white, the middle ball blue, metal behind gold.
  const auto sharp = picture_of("20-zoomed-view", {"render.shading=flat"});
  const auto blurred = picture_of("21-defocus-blur", {"render.shading=flat"});
  const auto step = [](const film::Picture& p, double v, double u_from, double u_to) {
    return steepest_blue(p, v, u_from, u_to);
  };
  EXPECT_LT(step(blurred, 0.3, 0.85, 1.0), 0.5 * step(sharp, 0.3, 0.85, 1.0)) << "behind the focus plane";
  EXPECT_LT(step(blurred, 0.9, 0.2, 0.45), 0.5 * step(sharp, 0.9, 0.2, 0.45)) << "in front of the focus plane";
  EXPECT_GT(step(blurred, 0.2, 0.15, 0.35), 0.7 * step(sharp, 0.2, 0.15, 0.35)) << "in focus";
}

}  // namespace
}  // namespace orrery
