// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "load/load_images.h"
#include "support/everything.h"

namespace orrery::load {
namespace {

class LoadWorkingSpace : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("OCIO"); }
};

TEST_F(LoadWorkingSpace, EqualSpacesNeedNoConversionOrConfig) {
  scene::Scene s = test::everything();
  s.color.space = s.color.working = "no such space";
  EXPECT_EQ(to_working_space("no such config", s), 0);
  s.color.working.clear();
  EXPECT_EQ(to_working_space("no such config", s), 0);
}

/// Grey stays grey in every space; red gains green and blue in wider primaries, by the matrix between the spaces.
TEST_F(LoadWorkingSpace, ColoursAreConverted) {
  scene::Scene s = test::everything();
  s.color.working = "ACEScg";
  s.background.bottom = {1, 1, 1};
  std::get<scene::Lambertian>(s.materials[0].model).albedo = {0.5, 0, 0};
  EXPECT_EQ(to_working_space({}, s), 0);
  EXPECT_NEAR(s.background.bottom.x, 1, 1e-4);
  EXPECT_NEAR(s.background.bottom.z, 1, 1e-4);
  const math::Vec3d red = std::get<scene::Lambertian>(s.materials[0].model).albedo;
  EXPECT_NEAR(red.x, 0.5 * 0.613097, 1e-4);
  EXPECT_NEAR(red.y, 0.5 * 0.070194, 1e-4);
  EXPECT_NEAR(red.z, 0.5 * 0.020616, 1e-4);
  EXPECT_EQ(std::get<scene::Dielectric>(s.materials[4].model).ior, 1.5);
}

TEST_F(LoadWorkingSpace, RadianceOfEmittersIsConverted) {
  scene::Scene s;
  s.materials = {{"lamp", scene::Emitter{{20, 0, 0}}}};
  s.color.working = "ACEScg";
  EXPECT_EQ(to_working_space({}, s), 0);
  EXPECT_NEAR(std::get<scene::Emitter>(s.materials[0].model).radiance.x, 20 * 0.613097, 1e-3);
}

/// Colour maps are Rec.709 whatever the scene's space is; colours that the scene authors are in its space.
TEST_F(LoadWorkingSpace, PalettesAreConvertedFromTheirOwnSpaces) {
  scene::Scene s;
  s.color.space = "ACEScg";
  s.color.working = "ACEScg";
  s.points.resize(2);
  s.points[0].palette = {{0.5, 0, 0}, {0.5, 0, 0}};
  s.points[0].palette_rec709 = 1;
  s.points[1].palette = {{0.5, 0, 0}};
  EXPECT_EQ(to_working_space({}, s), 0);
  EXPECT_NEAR(s.points[0].palette[0].x, 0.5 * 0.613097, 1e-4);
  EXPECT_NEAR(s.points[0].palette[0].z, 0.5 * 0.020616, 1e-4);
  EXPECT_EQ(s.points[0].palette[1], (math::Vec3d{0.5, 0, 0}));
  EXPECT_EQ(s.points[1].palette[0], (math::Vec3d{0.5, 0, 0}));

  s.color.working = "lin_rec709";
  s.points[0].palette = {{0.5, 0.25, 0}, {0.25, 0.25, 0.25}, {1, 1, 0}};
  EXPECT_EQ(to_working_space({}, s), 2) << "yellow and red of ACEScg are outside Rec.709";
  EXPECT_EQ(s.points[0].palette[0], (math::Vec3d{0.5, 0.25, 0})) << "already Rec.709";
  EXPECT_NEAR(s.points[0].palette[1].y, 0.25, 1e-4);
  EXPECT_EQ(s.points[0].palette[2].x, 1) << "an albedo is at most 1";
}

TEST_F(LoadWorkingSpace, ClampsAndCountsColoursOutOfRange) {
  scene::Scene s = test::everything();
  s.color.space = "ACEScg";
  s.color.working = "lin_rec709";
  std::get<scene::Lambertian>(s.materials[0].model).albedo = {0, 1, 0};
  EXPECT_GE(to_working_space({}, s), 1);
  const math::Vec3d green = std::get<scene::Lambertian>(s.materials[0].model).albedo;
  EXPECT_EQ(green.x, 0);
  EXPECT_EQ(green.y, 1);
}

TEST_F(LoadWorkingSpace, RejectsSpacesThatAreNotSceneLinear) {
  scene::Scene s = test::everything();
  for (const char* name : {"acescct", "raw", "srgb_texture"}) {
    s.color.working = name;
    try {
      to_working_space({}, s);
      FAIL() << name;
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
      EXPECT_NE(std::string(error.what()).find("not scene-linear"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace orrery::load
