// SPDX-License-Identifier: Apache-2.0
#include "film/layer_film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace orrery::film {
namespace {

/// Two spheres in front of a camera at the origin that looks along -z, and the sums of one pixel.
class FilmLayerFilm : public testing::Test {
 protected:
  FilmLayerFilm() {
    view_.spheres = spheres_;
    view_.sphere_materials = sphere_materials_;
    view_.materials = materials_;
    view_.sphere_count = 2;
    materials_[1].albedo[0] = 0.25;
  }

  /// A path along the view axis that hits the front of a sphere.
  static kernel::PathRecord path_to(std::uint32_t sphere, double light = 0) {
    kernel::PathRecord path;
    path.sphere = sphere;
    path.offset[2] = 1;
    path.direction[2] = -1;
    std::fill_n(path.light, 3, light);
    return path;
  }

  void add(const kernel::PathRecord& path, std::int64_t weight = 1, kernel::Lobe lobe = kernel::Lobe::kDiffuseDirect) {
    pixel_.add(request_, view_, path, weight);
    kernel::LightEvent event{};
    std::copy_n(path.light, 3, event.value);
    event.lobe = lobe;
    pixel_.add(path, event, weight);
  }

  /// An image of one pixel from the paths added so far.
  Picture picture() {
    LayerFilm film(request_, view_, 1, 1);
    film.set(0, pixel_);
    deep_ = {};
    Picture out{1, 1, {{"R", {0}}, {"A", {1}}}};
    film.move_to(out);
    deep_ = film.take_deep();
    return out;
  }
  static float value(const Picture& picture, const std::string& plane) {
    const Plane* found = picture.find(plane);
    EXPECT_NE(found, nullptr) << plane;
    return found != nullptr ? found->values[0] : std::numeric_limits<float>::quiet_NaN();
  }

  kernel::Sphere spheres_[2] = {{0, 0, -5, 1}, {0, 0, -9, 1}};
  std::uint32_t sphere_materials_[2] = {0, 1};
  kernel::Material materials_[2];
  kernel::SceneView view_;
  LayerRequest request_;
  LayerPixel pixel_;
  DeepPicture deep_;
};

TEST_F(FilmLayerFilm, NoRequestGivesNoPlanes) {
  EXPECT_FALSE(request_.any());
  EXPECT_TRUE(planes_of(request_).empty());
}

TEST_F(FilmLayerFilm, DistancesAndIdsComeFromTheNearestHit) {
  request_.z = request_.depth = request_.position = request_.object_id = request_.material_id = true;
  request_.material_numbers = {7, 9};
  view_.camera.origin[0] = 3;  // the axis is still along -z, so z and distance differ
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

TEST_F(FilmLayerFilm, WithoutAHitDistancesAreFarAndIdsZero) {
  request_.z = request_.depth = request_.normal = request_.object_id = request_.samples = true;
  add(kernel::PathRecord{});
  const Picture p = picture();
  EXPECT_EQ(value(p, "Z"), kNothingHit);
  EXPECT_EQ(value(p, "depth.X"), kNothingHit);
  EXPECT_EQ(value(p, "N.Z"), 0);
  EXPECT_EQ(value(p, "object_id.X"), 0);
  EXPECT_EQ(value(p, "samples.X"), 1);
}

TEST_F(FilmLayerFilm, NormalsAndAlbedoAreMeansAndFaceTheCamera) {
  request_.normal = request_.albedo = true;
  add(path_to(0));
  add(path_to(1));
  add(kernel::PathRecord{});
  add(kernel::PathRecord{});
  const Picture p = picture();
  EXPECT_EQ(value(p, "N.Z"), 0.5F);
  EXPECT_EQ(value(p, "albedo.R"), (1 + 0.25F) / 4);
  EXPECT_EQ(value(p, "albedo.G"), 0.5F);

  view_.camera.origin[2] = -5;  // inside the first sphere
  pixel_ = {};
  kernel::PathRecord back = path_to(0);
  back.offset[2] = -1;
  add(back);
  EXPECT_EQ(value(picture(), "N.Z"), 1);
}

/// The sum of the lobe AOVs in single precision equals the beauty bit for bit in any order.
TEST_F(FilmLayerFilm, LightGroupsAddUpToTheBeautyInAnyOrder) {
  request_.diffuse = request_.specular = request_.transmission = request_.background = true;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-30, 12), uniform(0, 1);
  for (int trial = 0; trial < 3000; ++trial) {
    pixel_ = {};
    const int paths = 1 + static_cast<int>(uniform(random) * 40);
    for (int i = 0; i < paths; ++i) {
      kernel::PathRecord path = path_to(0);
      for (double& v : path.light) v = uniform(random) < 0.2 ? 0 : std::exp2(exponent(random));
      add(path, 1, static_cast<kernel::Lobe>(uniform(random) * kernel::kLobes));
    }
    const Picture p = picture();
    std::vector<float> groups;
    for (const Plane& plane : p.planes)
      if (plane.name.size() > 2 && plane.name.ends_with(".G")) groups.push_back(plane.values[0]);
    ASSERT_EQ(groups.size(), 7u);
    kernel::Int128 sum = 0;
    for (const auto& group : pixel_.light) sum += group[1];
    const auto beauty = static_cast<float>(kernel::from_fixed_point(sum) / static_cast<double>(pixel_.lit));
    for (int order = 0; order < 5; ++order) {
      float total = 0;
      for (const float g : groups) {
        ASSERT_GE(g, 0);
        total += g;
      }
      ASSERT_EQ(total, beauty) << "trial " << trial;
      std::shuffle(groups.begin(), groups.end(), random);
    }
  }
}

TEST_F(FilmLayerFilm, InvalidRadianceIsIgnored) {
  request_.diffuse = request_.samples = request_.albedo = true;
  add(path_to(0, 0.5));
  add(path_to(0, std::numeric_limits<double>::quiet_NaN()));
  add(path_to(0, 1e30));
  const Picture p = picture();
  EXPECT_EQ(value(p, "diffuse_direct.R"), 0.5F);
  EXPECT_EQ(value(p, "samples.X"), 1);
  EXPECT_EQ(value(p, "albedo.R"), 1);  // the hits count nevertheless
}

/// The values 1, 2, 3, 6 have mean 3 and variance 14/3; the variance of the mean is a fourth of that.
TEST_F(FilmLayerFilm, VarianceIsThatOfTheMean) {
  request_.variance = true;
  for (const double light : {1.0, 2.0, 3.0, 6.0}) add(path_to(0, light));
  EXPECT_FLOAT_EQ(value(picture(), "variance.R"), 14.0F / 12);
  pixel_ = {};
  add(path_to(0, 4));
  EXPECT_EQ(value(picture(), "variance.R"), 0);  // one path has no sample variance
}

/// Paths with positive weight have radiance 1, 2, 3, 6 (variance 14/3), those with negative weight 1, 3 (variance 2).
/// The total weight is 2. The paths are added in two parts, as for shards.
TEST_F(FilmLayerFilm, VarianceTreatsPositiveAndNegativeWeightsSeparately) {
  request_.variance = true;
  for (const double light : {1.0, 2.0, 3.0}) add(path_to(0, light));
  add(path_to(0, 1), -1);
  const LayerPixel part = pixel_;
  pixel_ = {};
  add(path_to(0, 6));
  add(path_to(0, 3), -1);
  pixel_.add(part);
  EXPECT_FLOAT_EQ(value(picture(), "variance.R"), (4 * 14.0F / 3 + 2 * 2) / 4);
  pixel_ = part;  // one negative path: uses the variance of the positive ones, which is 1
  EXPECT_FLOAT_EQ(value(picture(), "variance.R"), 4.0F / 4);
}

TEST_F(FilmLayerFilm, ConstantRadianceHasNoVariance) {
  request_.variance = true;
  for (const double light : {0.3, 1.0 / 3, 7.7, 1e-3, 123456.7}) {
    pixel_ = {};
    for (int i = 0; i < 100; ++i) add(path_to(0, light), i % 16 == 15 ? -1 : 1);
    EXPECT_EQ(value(picture(), "variance.R"), 0) << light;
  }
}

/// A lens larger than a sphere: some rays start inside the sphere.
TEST_F(FilmLayerFilm, NormalsPointAgainstTheRay) {
  request_.normal = true;
  kernel::PathRecord path = path_to(0);
  path.direction[0] = 0.6, path.direction[2] = 0.8;  // leaves through the side that faces the camera
  add(path);
  EXPECT_FLOAT_EQ(value(picture(), "N.Z"), -1);
  add(path_to(0));
  EXPECT_FLOAT_EQ(value(picture(), "N.Z"), 0);
}

TEST_F(FilmLayerFilm, VarianceIsFiniteForTheLargestRadiance) {
  request_.variance = true;
  for (const double light : {0.0, 0x1p34}) add(path_to(0, light));
  // Squares are clamped to 2^48; the variance must be finite and not negative.
  EXPECT_GE(value(picture(), "variance.R"), 0);
  EXPECT_TRUE(std::isfinite(value(picture(), "variance.R")));
}

TEST_F(FilmLayerFilm, MattesRankIdsByCoverage) {
  request_.mattes = {{"CryptoObject", [](std::uint32_t sphere) { return sphere == 0 ? 0x3f000000u : 0x40000000u; }}};
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

TEST_F(FilmLayerFilm, SpheresWithOneIdShareARankAndIdZeroHasNone) {
  request_.mattes = {{"A", [](std::uint32_t) { return 0x3f000000u; }}, {"B", [](std::uint32_t) { return 0u; }}};
  add(path_to(1));
  add(path_to(0));
  const Picture p = picture();
  EXPECT_EQ(value(p, "A00.G"), 1);
  EXPECT_EQ(value(p, "A00.A"), 0);
  EXPECT_EQ(value(p, "B00.G"), 0);
}

TEST_F(FilmLayerFilm, EqualCoverageRanksBySmallerId) {
  request_.mattes = {{"A", [](std::uint32_t sphere) { return sphere == 0 ? 0x40000000u : 0x3f000000u; }}};
  add(path_to(0));
  add(path_to(1));
  EXPECT_EQ(value(picture(), "A00.R"), 0.5F);
}

TEST_F(FilmLayerFilm, CoverageBecomesAlpha) {
  request_.coverage = true;
  add(path_to(0));
  for (int i = 0; i < 3; ++i) add(kernel::PathRecord{});
  EXPECT_EQ(value(picture(), "A"), 0.25F);
}

/// Samples of a filter's negative lobes have negative weight.
TEST_F(FilmLayerFilm, NegativeWeightsAreSubtracted) {
  request_.diffuse = request_.albedo = request_.coverage = true;
  for (int i = 0; i < 3; ++i) add(path_to(0, 0.5));
  add(path_to(0, 0.5), -1);
  const Picture p = picture();
  EXPECT_EQ(value(p, "diffuse_direct.R"), 0.5F);
  EXPECT_EQ(value(p, "albedo.R"), 1);
  EXPECT_EQ(value(p, "A"), 1);
}

TEST_F(FilmLayerFilm, DeepSamplesCompositeToTheFlatPixel) {
  request_.deep = true;
  kernel::PathRecord sky;
  std::fill_n(sky.light, 3, 1.0);
  for (int i = 0; i < 2; ++i) add(path_to(1, 0.5));
  add(path_to(0, 0.25));
  add(sky);
  picture();
  ASSERT_EQ(deep_.pixels.size(), 1u);
  const auto& samples = deep_.pixels[0];
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

TEST_F(FilmLayerFilm, ATransparentBackgroundHasNoDeepSample) {
  request_.deep = request_.coverage = true;
  add(kernel::PathRecord{});
  picture();
  EXPECT_TRUE(deep_.pixels[0].empty());
}

TEST_F(FilmLayerFilm, LayersHaveTheirChannelNamesAndKinds) {
  request_.z = request_.depth = request_.normal = request_.position = request_.albedo = true;
  request_.diffuse = request_.specular = request_.transmission = request_.background = true;
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
            "specular_direct.R, specular_indirect.R, transmission_direct.R, transmission_indirect.R, variance.R data, "
            "samples.X data, object_id.X data, material_id.X data, denoise.albedo.R, denoise.normal.X vector, ");
}

}  // namespace
}  // namespace orrery::film
