// SPDX-License-Identifier: Apache-2.0
#include "film/layer_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>

#include "base/image_limits.h"
#include "film/layers.h"
#include "kernel/material.h"
#include "kernel/path_record.h"
#include "kernel/scene_view.h"
#include "support/add_matte.h"
#include "unit/film/pixel_of_layers.h"

namespace orrery::film {
namespace {

using FilmLayerPlanes = PixelOfLayers;

TEST_F(FilmLayerPlanes, NoRequestGivesNoPlanes) {
  EXPECT_FALSE(request_.any());
  EXPECT_TRUE(planes_of(request_).empty());
}

TEST_F(FilmLayerPlanes, DistancesAndIdsComeFromTheNearestHit) {
  request_.z = request_.depth = request_.position = request_.object_id = request_.material_id = true;
  request_.material_numbers = {7, 9};
  view_.camera.origin.x = 3;  // the axis is still along -z, so z and distance differ
  add(path_to(1));
  add(path_to(0));
  add(kernel::PathRecord{});
  const Picture p = picture();
  EXPECT_EQ(value(p, "Z"), 4);
  EXPECT_EQ(value(p, "depth.X"), 5);
  EXPECT_EQ(value(p, "P.X"), 0);
  EXPECT_EQ(value(p, "P.Z"), -4);
  EXPECT_EQ(value(p, "object_id.X"), 1);
  EXPECT_EQ(value(p, "material_id.X"), 7);
}

TEST_F(FilmLayerPlanes, WithoutAHitDistancesAreFarAndIdsZero) {
  request_.z = request_.depth = request_.normal = request_.object_id = request_.samples = true;
  add(kernel::PathRecord{});
  const Picture p = picture();
  EXPECT_EQ(value(p, "Z"), kNothingHit);
  EXPECT_EQ(value(p, "depth.X"), kNothingHit);
  EXPECT_EQ(value(p, "N.Z"), 0);
  EXPECT_EQ(value(p, "object_id.X"), 0);
  EXPECT_EQ(value(p, "samples.X"), 1);
}

TEST_F(FilmLayerPlanes, NormalsAndAlbedoAreMeansAndFaceTheCamera) {
  request_.normal = request_.albedo = true;
  add(path_to(0));
  add(path_to(1));
  add(kernel::PathRecord{});
  add(kernel::PathRecord{});
  const Picture p = picture();
  EXPECT_EQ(value(p, "N.Z"), 0.5F);
  EXPECT_EQ(value(p, "albedo.R"), (1 + 0.25F) / 4);
  EXPECT_EQ(value(p, "albedo.G"), 0.5F);

  view_.camera.origin.z = -5;  // inside the first sphere
  clear();
  kernel::PathRecord back = path_to(0);
  back.offset.z = -1;
  add(back);
  EXPECT_EQ(value(picture(), "N.Z"), 1);
}

/// A group has layers only for the lobes that its sources can have, and none without sources.
TEST_F(FilmLayerPlanes, LightGroupsHaveTheLayersOfTheirSources) {
  request_.light_groups = true;
  request_.groups = {{"default", false, false}, {"key", true, false}, {"sky", false, true}};
  std::string names;
  for (const Plane& plane : planes_of(request_)) {
    EXPECT_EQ(plane.kind, PlaneKind::kLight);
    if (plane.name.ends_with(".R")) names += plane.layer() + " ";
  }
  EXPECT_EQ(names,
            "key key_diffuse_direct key_diffuse_indirect key_specular_direct key_specular_indirect "
            "key_transmission_direct key_transmission_indirect key_emission "
            "sky sky_background sky_diffuse_direct sky_diffuse_indirect sky_specular_direct sky_specular_indirect "
            "sky_transmission_direct sky_transmission_indirect ");
  // Light too small for the sums is not lost where there is no first group.
  kernel::PathRecord path = path_to(0, 0x1.8p-60);
  add(path, std::vector<kernel::LightEvent>(2, {{0x1.8p-61, 0, 0}, 0, 1, kernel::Lobe::kEmission}));
  EXPECT_EQ(value(picture(), "key.R"), 0x1p-60F);
}

/// The values 1, 2, 3, 6 have mean 3 and variance 14/3; the variance of the mean is a fourth of that.
TEST_F(FilmLayerPlanes, VarianceIsThatOfTheMean) {
  request_.variance = true;
  for (const double light : {1.0, 2.0, 3.0, 6.0}) add(path_to(0, light));
  EXPECT_FLOAT_EQ(value(picture(), "variance.R"), 14.0F / 12);
  clear();
  add(path_to(0, 4));
  EXPECT_EQ(value(picture(), "variance.R"), 0);  // one path has no sample variance
}

TEST_F(FilmLayerPlanes, ConstantRadianceHasNoVariance) {
  request_.variance = true;
  for (const double light : {0.3, 1.0 / 3, 7.7, 1e-3, 123456.7}) {
    clear();
    for (int i = 0; i < 100; ++i) add(path_to(0, light));
    EXPECT_EQ(value(picture(), "variance.R"), 0) << light;
  }
}

/// A lens larger than a sphere: some rays start inside the sphere.
TEST_F(FilmLayerPlanes, NormalsPointAgainstTheRay) {
  request_.normal = true;
  kernel::PathRecord path = path_to(0);
  path.direction.x = 0.6, path.direction.z = 0.8;  // leaves through the side that faces the camera
  add(path);
  EXPECT_FLOAT_EQ(value(picture(), "N.Z"), -1);
  add(path_to(0));
  EXPECT_FLOAT_EQ(value(picture(), "N.Z"), 0);
}

TEST_F(FilmLayerPlanes, VarianceIsFiniteForTheLargestRadiance) {
  request_.variance = true;
  for (const double light : {0.0, 0x1p34}) add(path_to(0, light));
  // Squares are clamped to 2^47; the variance must be finite and not negative.
  EXPECT_GE(value(picture(), "variance.R"), 0);
  EXPECT_TRUE(std::isfinite(value(picture(), "variance.R")));
}

TEST_F(FilmLayerPlanes, MattesRankIdsByCoverage) {
  test::add_matte(request_, "CryptoObject", {0x3f000000u, 0x40000000u});
  for (int i = 0; i < 3; ++i) add(path_to(1));
  for (int i = 0; i < 2; ++i) add(path_to(0));
  for (int i = 0; i < 3; ++i) add(kernel::PathRecord{});
  const Picture p = picture();
  EXPECT_EQ(value(p, "CryptoObject00.R"), 2.0F);  // the bits of 0x40000000
  EXPECT_EQ(value(p, "CryptoObject00.G"), 3.0F / 8);
  EXPECT_EQ(value(p, "CryptoObject00.B"), 0.5F);
  EXPECT_EQ(value(p, "CryptoObject00.A"), 2.0F / 8);
  EXPECT_EQ(value(p, "CryptoObject01.R"), 0);
  EXPECT_EQ(value(p, "CryptoObject02.A"), 0);
  EXPECT_EQ(p.find("CryptoObject03.R"), nullptr);
}

TEST_F(FilmLayerPlanes, SpheresWithOneIdShareARankAndIdZeroHasNone) {
  test::add_matte(request_, "A", {0x3f000000u, 0x3f000000u});
  test::add_matte(request_, "B", {0, 0});
  add(path_to(1));
  add(path_to(0));
  const Picture p = picture();
  EXPECT_EQ(value(p, "A00.G"), 1);
  EXPECT_EQ(value(p, "A00.A"), 0);
  EXPECT_EQ(value(p, "B00.G"), 0);
}

/// Memory does not grow with the spheres of an object, except in a deep image.
TEST_F(FilmLayerPlanes, SpheresOfOneClassHaveOneSum) {
  test::add_matte(request_, "A", {0x3f000000u, 0x3f000000u});
  request_.matte_classes = std::make_shared<MatteClasses>(MatteClasses{{2, 0}, {0}});
  for (const bool deep : {false, true}) {
    clear();
    request_.deep = deep;
    add(path_to(1));
    add(path_to(0));
    EXPECT_EQ(sums().layers.shares[0].size(), deep ? 2u : 1u);
    EXPECT_EQ(value(picture(), "A00.G"), 1);
  }
}

TEST_F(FilmLayerPlanes, EqualCoverageRanksBySmallerId) {
  test::add_matte(request_, "A", {0x40000000u, 0x3f000000u});
  add(path_to(0));
  add(path_to(1));
  EXPECT_EQ(value(picture(), "A00.R"), 0.5F);
}

TEST_F(FilmLayerPlanes, CoverageBecomesAlpha) {
  request_.coverage = true;
  sums().counts[0] = 4;
  sums().layers.covered[0] = static_cast<std::int64_t>(1 / kernel::kGuideUnit);
  EXPECT_EQ(value(picture(), "A"), 1);
  request_.transparent = true;
  EXPECT_EQ(value(picture(), "A"), 0.25F);
}

TEST_F(FilmLayerPlanes, DeepSamplesCompositeToTheFlatPixel) {
  request_.deep = true;
  kernel::PathRecord sky;
  std::fill_n(sky.light, 3, 1.0);
  for (int i = 0; i < 2; ++i) add(path_to(1, 0.5));
  add(path_to(0, 0.25));
  add(sky);
  picture();
  const auto& samples = deep_;
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(samples[0].front, 4);
  EXPECT_EQ(samples[0].back, 6);
  EXPECT_EQ(samples[0].alpha, 0.25F);
  EXPECT_FLOAT_EQ(samples[1].alpha, 2.0F / 3);
  EXPECT_EQ(samples[1].front, 8);
  EXPECT_EQ(samples[2].front, kNothingHit);
  EXPECT_EQ(samples[2].alpha, 1);
  float color = 0, seen_through = 1;
  for (const DeepSample& s : samples) {
    color += s.rgb[0] * seen_through;
    seen_through *= 1 - s.alpha;
  }
  EXPECT_FLOAT_EQ(color, (0.25F + 2 * 0.5F + 1) / 4);
}

TEST_F(FilmLayerPlanes, ATransparentBackgroundHasNoDeepSample) {
  request_.deep = request_.coverage = request_.transparent = true;
  add(kernel::PathRecord{});
  picture();
  EXPECT_TRUE(deep_.empty());
}

TEST_F(FilmLayerPlanes, LayersHaveTheirChannelNamesAndKinds) {
  request_.z = request_.depth = request_.normal = request_.position = request_.albedo = true;
  request_.diffuse = request_.specular = request_.transmission = request_.background = request_.emission = true;
  request_.variance = request_.samples = request_.object_id = request_.material_id = true;
  request_.guide_albedo = request_.guide_normal = true;
  std::string names;
  for (const Plane& plane : planes_of(request_)) {
    if (plane.name.back() == 'X' || plane.name.back() == 'R' || plane.name == "Z")
      names += plane.name + (plane.kind == PlaneKind::kData     ? " data, "
                             : plane.kind == PlaneKind::kVector ? " vector, "
                                                                : ", ");
  }
  EXPECT_EQ(names,
            "Z data, depth.X data, N.X vector, P.X data, albedo.R, background.R, diffuse_direct.R, diffuse_indirect.R, "
            "specular_direct.R, specular_indirect.R, transmission_direct.R, transmission_indirect.R, emission.R, "
            "variance.R data, samples.X data, object_id.X data, material_id.X data, denoise.albedo.R, denoise.normal.X "
            "vector, ");
}

/// Halves of two paths each.
TEST_F(FilmLayerPlanes, HalvesAreMeansOfTheirOwnPaths) {
  request_.halves = request_.guide_albedo = request_.guide_normal = true;
  const auto one = static_cast<std::int64_t>(1 / kernel::kGuideUnit);
  const kernel::Int128 unit = kernel::to_fixed_point(1);
  sums().light[0][0] = {{3 * unit, 0, 0}, 2};
  sums().guides[0][0] = {unit / 2, 2, {0, one / 2, 0}, {0, 0, one}};
  sums().light[1][0] = {{0, 5 * unit, 0}, 1};  // one of its two paths is invalid
  sums().guides[1][0] = {unit / 8, 2, {one, 0, 0}, {0, 0, -one}};
  const Picture p = picture();
  EXPECT_EQ(value(p, "half_a.R"), 1.5F);
  EXPECT_EQ(value(p, "half_b.G"), 5);
  EXPECT_EQ(value(p, "half_a.albedo.G"), 0.25F);
  EXPECT_EQ(value(p, "half_a.normal.Z"), 0.5F);
  EXPECT_EQ(value(p, "half_b.normal.Z"), -0.5F);
  EXPECT_EQ(value(p, "half_a.inverse_depth.X"), 0.25F);
  EXPECT_EQ(value(p, "half_b.inverse_depth.X"), 0.0625F);
  EXPECT_EQ(value(p, "denoise.albedo.R"), 0.25F);
  EXPECT_EQ(value(p, "denoise.albedo.G"), 0.125F);
  EXPECT_EQ(value(p, "denoise.normal.Z"), 0);
}

TEST_F(FilmLayerPlanes, MergedHalvesAreSums) {
  request_.halves = true;
  const kernel::Int128 unit = kernel::to_fixed_point(1);
  Sums of_one_path(1, 1, request_);
  of_one_path.light[1][0] = {{unit, unit, unit}, 1};
  of_one_path.guides[1][0] = {unit, 1, {0, 0, 0}, {0, 0, 0}};
  sums().light[1][0] = {{3 * unit, 0, 0}, 1};
  sums().guides[1][0] = {unit / 2, 1, {0, 0, 0}, {0, 0, 0}};
  sums().add(of_one_path);
  const Picture p = picture();
  EXPECT_TRUE(std::isnan(value(p, "half_a.R"))) << "without paths there is no mean";
  EXPECT_TRUE(std::isnan(value(p, "half_a.inverse_depth.X")));
  EXPECT_EQ(value(p, "half_b.R"), 2);
  EXPECT_EQ(value(p, "half_b.G"), 0.5F);
  EXPECT_EQ(value(p, "half_b.inverse_depth.X"), 0.75F);
}

}  // namespace
}  // namespace orrery::film
