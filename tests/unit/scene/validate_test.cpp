// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "scene/diagnostic.h"
#include "scene/scene.h"
#include "scene/texture.h"
#include "support/mentions.h"

namespace orrery::scene {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kNotFinite = std::numeric_limits<double>::infinity();

Scene with_sphere(Vec3d center, double radius) {
  Scene scene;
  scene.materials = {{"grey", Lambertian{}}};
  scene.spheres = {{center, radius, 0, ""}};
  return scene;
}

/// "key: text" of each diagnostic, warnings in parentheses.
std::vector<std::string> told(const Scene& scene) {
  std::vector<std::string> out;
  std::vector<SceneDiagnostic> all = validate(scene);
  for (const SceneDiagnostic& p : warn_of_coincident(scene, nullptr)) all.push_back(p);
  for (const SceneDiagnostic& p : all) {
    const std::string line = p.key + ": " + p.text;
    out.push_back(p.severity == base::Severity::kError ? line : "(" + line + ")");
  }
  return out;
}
using Told = std::vector<std::string>;

/// Whether there is one diagnostic, with these facts.
testing::AssertionResult tells(const Scene& scene, std::initializer_list<std::string_view> facts) {
  const Told all = told(scene);
  if (all.size() != 1) return testing::AssertionFailure() << all.size() << " diagnostics";
  return test::mentions(all[0], facts);
}

TEST(SceneValidate, AnEmptySceneIsValid) { EXPECT_EQ(told({}), Told{}); }

TEST(SceneValidate, AScaleBarFitsTheImage) {
  Scene scene;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.width = 10;
  scene.image.width = 200;
  scene.annotation.scale_bar = 9;
  EXPECT_EQ(told(scene), Told{});
  scene.annotation.scale_bar = 11;
  EXPECT_TRUE(tells(scene, {"(annotation.scale_bar", "11", "long", "image", "10"}));
  scene.annotation.scale_bar = 0.04;  // less than a pixel
  EXPECT_TRUE(tells(scene, {"(annotation.scale_bar", "0.04", "short", "image", "10"}));
}

TEST(SceneValidate, AColorBarExplainsColors) {
  Scene scene;
  scene.materials = {{"grey", Lambertian{}}};
  scene.annotation.color_bar = true;
  scene.points.resize(1);
  scene.points[0].color.rgb = true;
  EXPECT_TRUE(tells(scene, {"(annotation.color_bar", "table", "column"}));
  scene.points[0].color.rgb = false;
  scene.points[0].color.element = "jmol";
  EXPECT_EQ(told(scene), Told{});
}

TEST(SceneValidate, Rods) {
  Scene scene;
  scene.materials = {{"grey", Lambertian{}}, {"glass", Dielectric{}}};
  scene.rods.resize(1);
  EXPECT_EQ(told(scene), Told{}) << "a rod of length 0";
  Rod& rod = scene.rods[0];
  rod.from.x = kNan;
  rod.to.z = 2e18;
  EXPECT_EQ(told(scene), (Told{"rod[0].from: [nan, 0, 0] is not finite or exceeds 1e+18",
                               "rod[0].to: [0, 0, 2e+18] is not finite or exceeds 1e+18"}));
  rod = {};
  for (const double radius : {0.0, -1.0, kNan, kNotFinite, 1e-31, 1e19}) {
    rod.radius = radius;
    EXPECT_EQ(told(scene).size(), 1u) << radius;
    EXPECT_TRUE(told(scene)[0].starts_with("rod[0].radius: radius is ")) << told(scene)[0];
  }
  rod.radius = 1e-19;
  scene.render.precision = Precision::kFast;
  EXPECT_EQ(told(scene).size(), 1u);
  rod = {};
  rod.materials = {0, 1};
  EXPECT_TRUE(tells(scene, {"rod[0].material", "dielectric"}));
  rod.materials = {2, 2};
  EXPECT_TRUE(tells(scene, {"rod[0].material", "2", "0"}));
}

TEST(SceneValidate, CropMustBeInsideTheFrame) {
  Scene scene;
  scene.image = {100, 50};
  for (const Window& good : {Window{0, 0, 100, 50}, {99, 49, 1, 1}}) {
    scene.image.crop = good;
    EXPECT_EQ(told(scene), Told{});
  }
  for (const Window& bad :
       {Window{0, 0, 101, 50}, {1, 0, 100, 50}, {0, 0, 0, 5}, {0, 50, 1, 1}, {65536, 0, 65536, 1}}) {
    scene.image.crop = bad;
    EXPECT_TRUE(tells(scene, {"image.crop", "100", "50", "frame"}));
  }
  scene.image.crop = Window{0, 0, 10, 10};
  scene.image.overscan = 1;
  EXPECT_TRUE(tells(scene, {"image.overscan", "combined"}));
}

TEST(SceneValidate, FramePlusOverscanIsLimited) {
  Scene scene;
  scene.image = {65536, 10};
  EXPECT_EQ(told(scene), Told{});
  scene.image.overscan = 1;
  EXPECT_TRUE(tells(scene, {"image.overscan", "frame", "65536"}));
}

TEST(SceneValidate, AnImageBackgroundNeedsAFile) {
  Scene scene;
  scene.background.type = BackgroundType::kImage;
  EXPECT_TRUE(tells(scene, {"background.file", "EXR", "HDR"}));
  scene.background.file = "sky.exr";
  scene.background.color_space = "acescg";
  scene.background.rotation = 30;
  scene.background.visible = false;
  EXPECT_EQ(told(scene), Told{});
}

TEST(SceneValidate, KeysOfImageBackgroundsHaveNoEffectOnOthers) {
  Scene scene;
  scene.background.file = "sky.exr";
  scene.background.exposure = 1;
  EXPECT_EQ(told(scene), (Told{"(background.file: has no effect; set background.type to \"image\")",
                               "(background.exposure: has no effect; set background.type to \"image\" or \"sky\")"}));
  scene = {};
  scene.background.type = BackgroundType::kConstant;
  scene.background.light_group = "sky";
  EXPECT_EQ(told(scene).size(), 1u);
}

TEST(SceneValidate, KeysOfSkiesHaveNoEffectOnOthers) {
  Scene scene;
  scene.background.sun_elevation = 5;
  scene.background.sun = false;
  EXPECT_EQ(told(scene), (Told{"(background.sun_elevation: has no effect; set background.type to \"sky\")",
                               "(background.sun: has no effect; set background.type to \"sky\")"}));
  scene.background.turbidity = 4;
  scene.background.sun_azimuth = 4;
  scene.background.ground_albedo = {0, 0, 0};
  EXPECT_EQ(told(scene).size(), 5u);
  scene.background.exposure = 1;
  scene.background.type = BackgroundType::kSky;
  EXPECT_EQ(told(scene), Told{});
}

TEST(SceneValidate, RadianceWithExposureIsLimited) {
  Scene scene;
  Emitter lamp;
  lamp.radiance = {1, 0, 0x1p20};
  lamp.exposure = 14;
  scene.materials = {{"lamp", lamp}};
  EXPECT_EQ(told(scene), Told{}) << "2^34 is allowed";
  std::get<Emitter>(scene.materials[0].model).exposure = 15;
  EXPECT_TRUE(tells(scene, {"material.lamp.exposure", "34359738368", "17179869184", "color.exposure"}));
  const auto texture = std::make_shared<Texture>();
  texture->high = {0, 0x1p19, 0};
  std::get<Emitter>(scene.materials[0].model).radiance_texture = texture;
  EXPECT_EQ(told(scene), Told{}) << "the texture replaces the constant";
  std::get<Emitter>(scene.materials[0].model).exposure = 16;
  EXPECT_EQ(told(scene).size(), 1u);
}

TEST(SceneValidate, CameraMustHaveADirection) {
  Scene scene;
  scene.camera.look_at = scene.camera.look_from;
  EXPECT_TRUE(tells(scene, {"camera.look_at", "look_at", "look_from"}));
  // The length, or its square, would be 0: in both cases the direction would be NaN.
  scene.camera.look_at = scene.camera.look_from + Vec3d{0, 0, 1e-200};
  EXPECT_TRUE(tells(scene, {"camera.look_at", "look_at", "look_from", "1e-30"}));
  scene.camera.look_at = {0, 0, 1e-29};
  EXPECT_EQ(told(scene), Told{});
}

TEST(SceneValidate, AnOrthographicCameraNeedsAWidth) {
  Scene scene;
  scene.camera.projection = Projection::kOrthographic;
  ASSERT_EQ(validate(scene).size(), 1u);
  EXPECT_EQ(validate(scene)[0].severity, base::Severity::kError);
  EXPECT_EQ(validate(scene)[0].key, "camera.projection");
  scene.camera.width = 3;
  EXPECT_TRUE(validate(scene).empty());
}

TEST(SceneValidate, KeysOfTheOtherProjectionHaveNoEffect) {
  Scene scene;
  scene.camera.width = 3;
  ASSERT_EQ(validate(scene).size(), 1u);
  EXPECT_EQ(validate(scene)[0].severity, base::Severity::kWarning);
  EXPECT_EQ(validate(scene)[0].key, "camera.width");
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.vfov = 20;
  ASSERT_EQ(validate(scene).size(), 1u);
  EXPECT_EQ(validate(scene)[0].key, "camera.vfov");
}

TEST(SceneValidate, UpMustNotBeZeroTinyOrParallel) {
  Scene scene;
  scene.camera.up = {0, 0, 0};
  EXPECT_TRUE(tells(scene, {"camera.up", "direction"}));
  scene.camera.up = {0, 1e-200, 0};
  EXPECT_TRUE(tells(scene, {"camera.up", "1e-30", "direction"}));
  const Told parallel{"camera.up: up is parallel to the view; choose another direction"};
  scene.camera.up = {0, 0, -5};
  EXPECT_EQ(told(scene), parallel);
  scene.camera.up = {0, 0, 1e18};
  EXPECT_EQ(told(scene), parallel);
  scene.camera.up = {0, 1e-10, 1};
  EXPECT_EQ(told(scene), parallel);
  scene.camera.up = {0, 1e-8, 1};
  EXPECT_EQ(told(scene), Told{});
}

TEST(SceneValidate, CameraVectorsMustBeFinite) {
  Scene scene;
  scene.camera.look_from = {kNan, 0, 0};
  scene.camera.up = {0, kNotFinite, 0};
  EXPECT_EQ(told(scene), (Told{"camera.look_from: [nan, 0, 0] is not finite or exceeds 1e+18",
                               "camera.up: [0, inf, 0] is not finite or exceeds 1e+18"}));
}

TEST(SceneValidate, LensMustBeInTheDomain) {
  Scene scene;
  scene.camera.defocus_angle = 179;
  scene.camera.focus_distance = 1e18;
  ASSERT_EQ(told(scene).size(), 1u);
  EXPECT_EQ(told(scene)[0].rfind("camera.defocus_angle: the lens radius would be 1.14", 0), 0u) << told(scene)[0];
  scene.camera.focus_distance = 1e10;
  EXPECT_EQ(told(scene), Told{});
  scene.camera.defocus_angle = kNotFinite;
  EXPECT_EQ(told(scene).size(), 1u);
}

TEST(SceneValidate, RadiusMustBeInTheDomain) {
  EXPECT_TRUE(tells(with_sphere({}, 0), {"sphere[0].radius", "is 0", "1e-30..1e+18", "negative"}));
  EXPECT_EQ(told(with_sphere({}, 1e-31)),
            Told{"sphere[0].radius: radius is 1e-31; its magnitude must be in 1e-30..1e+18"});
  EXPECT_EQ(told(with_sphere({}, -2e18)),
            Told{"sphere[0].radius: radius is -2e+18; its magnitude must be in 1e-30..1e+18"});
  EXPECT_TRUE(tells(with_sphere({}, kNan), {"sphere[0].radius", "not finite", "1e-30..1e+18"}));
  EXPECT_TRUE(tells(with_sphere({}, -kNotFinite), {"sphere[0].radius", "not finite"}));
  EXPECT_EQ(told(with_sphere({}, 1e-30)), Told{});
  EXPECT_EQ(told(with_sphere({}, -1e18)), Told{});
  Scene fast = with_sphere({}, 1e-19);
  fast.render.precision = Precision::kFast;
  EXPECT_TRUE(tells(fast, {"sphere[0].radius", "1e-19", "`fast`", "1e-18", "`exact`"}));
  fast.spheres[0].radius = 1e-18;
  EXPECT_EQ(told(fast), Told{});
}

TEST(SceneValidate, CenterMustBeInTheDomain) {
  EXPECT_EQ(told(with_sphere({0, 2e18, 0}, 1)),
            Told{"sphere[0].center: center [0, 2e+18, 0] is not finite or exceeds 1e+18"});
  EXPECT_EQ(told(with_sphere({0, 0, kNan}, 1)),
            Told{"sphere[0].center: center [0, 0, nan] is not finite or exceeds 1e+18"});
  EXPECT_EQ(told(with_sphere({-1e18, 1e18, 1e18}, 1)), Told{});
}

TEST(SceneValidate, MaterialMustExist) {
  Scene scene = with_sphere({}, 1);
  scene.spheres[0].material = 1;
  EXPECT_TRUE(tells(scene, {"sphere[0].material", "1", "0"}));
  scene = with_sphere({}, 1);
  scene.points.resize(2);
  scene.points[0].material = 9;
  scene.points[0].centers = {{5, 0, 0}, {6, 0, 0}};
  scene.points[0].radii = {1, 1};
  scene.points[1] = scene.points[0];
  scene.points[1].centers = {{7, 0, 0}, {8, 0, 0}};
  scene.points[1].materials = {0, 3};
  EXPECT_EQ(
      told(scene),
      (Told{"points[0].material: there is no material with index 9; the scene has 1, counted from 0",
            "points[1].file: row 2 of points[1]: there is no material with index 3; the scene has 1, counted from 0"}));
}

TEST(SceneValidate, MissingMaterialOfAPointsFileIsReportedOnce) {
  Scene scene;
  scene.points.resize(1);
  scene.points[0].centers = {{5, 0, 0}, {6, 0, 0}};
  scene.points[0].radii = {1, 1};
  EXPECT_TRUE(tells(scene, {"points[0].material", "material", "0"}));
}

TEST(SceneValidate, EveryInvalidSphereTableIsReported) {
  Scene scene = with_sphere({}, 0);
  for (int i = 1; i < 25; ++i) scene.spheres.push_back({{0.0 + i, 0, 0}, 0, 0, ""});
  EXPECT_EQ(validate(scene).size(), 25u);
}

TEST(SceneValidate, OfInvalidPointsThreeAreReportedAndAllCounted) {
  Scene scene;
  scene.materials = {{"grey", Lambertian{}}};
  scene.points.resize(2);
  for (Points& points : scene.points) {
    for (int i = 0; i < 100; ++i) points.centers.push_back({i + (&points == &scene.points[0] ? 0.0 : 1000.0), 0, 0});
    points.radii.assign(100, 1);
  }
  for (std::size_t i = 20; i < 50; ++i) scene.points[1].radii.set(i, 0);
  const Told lines = told(scene);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0].rfind("points[1].file: row 21 of points[1]: radius is 0", 0), 0u) << lines[0];
  EXPECT_EQ(lines[3], "points[1].file: and 27 more (30 in all)");
}

TEST(SceneValidate, ArraysOfDifferentLengthsAreNotIndexed) {
  Scene scene;
  scene.materials = {{"grey", Lambertian{}}};
  scene.points.resize(1);
  scene.points[0].centers.resize(3);  // all equal: indexing them would warn of coincident spheres
  scene.points[0].radii = {1, 1};
  EXPECT_TRUE(tells(scene, {"points[0]", "3", "2", "0"}));
}

TEST(SceneValidate, CoincidentSpheresAreAWarningThatNamesBoth) {
  Scene scene = with_sphere({1, 2, 3}, 2);
  scene.spheres.push_back({{1, 2, 3}, -2, 0, ""});
  EXPECT_TRUE(tells(scene, {"(sphere[1]", "sphere[0]", "rendered"}));
}

TEST(SceneValidate, OfCoincidentSpheresThreeAreReported) {
  Scene scene = with_sphere({1, 2, 3}, 2);
  scene.spheres.assign(32, scene.spheres[0]);
  const Told lines = told(scene);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[3], "(: and 28 more coincident spheres (31 in all))");
}

}  // namespace
}  // namespace orrery::scene
