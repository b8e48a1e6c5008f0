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
#include "support/picture_of.h"

namespace orrery::film {
namespace {

/// Two spheres in front of a camera at the origin that looks along -z, and the sums of one pixel.
class FilmLayerPlanes : public testing::Test {
 protected:
  FilmLayerPlanes() {
    view_.spheres = spheres_;
    view_.object_materials = object_materials_;
    view_.materials = materials_;
    view_.sphere_count = 2;
    materials_[1].albedo[0] = 0.25;
  }

  /// A path along the view axis that hits the front of a sphere.
  static kernel::PathRecord path_to(std::uint32_t sphere, double light = 0) {
    kernel::PathRecord path;
    path.object = sphere;
    path.offset.z = 1;
    path.direction.z = -1;
    std::fill_n(path.light, 3, light);
    return path;
  }

  void add(const kernel::PathRecord& path) {
    kernel::LightEvent event{};
    std::copy_n(path.light, 3, event.value);
    event.lobe = kernel::Lobe::kDiffuseDirect;
    add(path, {event});
  }
  void add(const kernel::PathRecord& path, const std::vector<kernel::LightEvent>& events) {
    sums().layers.add(request_, view_, 0, path);
    ++sums().counts[0];
    if (request_.lights())
      for (const kernel::LightEvent& event : events) sums().layers.add(request_, 0, path, event);
    if (!kernel::is_valid_sample(path.light[0], path.light[1], path.light[2])) return;
    for (int c = 0; c < 3; ++c) beauty().rgb[c] += kernel::to_fixed_point(path.light[c]);
    ++beauty().weight;
  }
  /// The sums of the paths so far, of the layers that are requested when the first is added.
  Sums& sums() {
    if (!sums_) sums_.emplace(1, 1, request_);
    return *sums_;
  }
  kernel::PixelSum& beauty() { return sums().light[0][0]; }
  void clear() { sums_.reset(); }

  /// An image of one pixel from the paths added so far.
  Picture picture() {
    if (request_.deep) deep_ = deep_samples(sums(), 0, !request_.transparent);
    return test::picture_of(sums(), request_, view_);
  }
  static float value(const Picture& picture, const std::string& plane) {
    const Plane* found = picture.find(plane);
    EXPECT_NE(found, nullptr) << plane;
    return found != nullptr ? found->values[0] : std::numeric_limits<float>::quiet_NaN();
  }

  kernel::Sphere spheres_[2] = {{0, 0, -5, 1}, {0, 0, -9, 1}};
  std::uint32_t object_materials_[2] = {0, 1};
  kernel::Material materials_[2];
  kernel::SceneView view_;
  LayerRequest request_;
  std::optional<Sums> sums_;
  std::vector<DeepSample> deep_;
};

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

/// Adds `values` in single precision in several orders and expects the same sum each time.
void expect_sum(std::vector<float> values, float sum, std::mt19937& random, const std::string& what) {
  for (int order = 0; order < 4; ++order) {
    float total = 0;
    for (const float v : values) {
      ASSERT_GE(v, 0) << what;
      total += v;
    }
    ASSERT_EQ(total, sum) << what;
    std::shuffle(values.begin(), values.end(), random);
  }
}

/// Random light in random lobes and groups: the lobes, the groups, and the lobes of the groups each add up to the
/// beauty, the lobes of a group to the group, and the parts of a lobe to the lobe.
TEST_F(FilmLayerPlanes, LightAddsUpToTheBeautyInAnyOrder) {
  request_.diffuse = request_.specular = request_.transmission = request_.background = request_.emission = true;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  // Magnitudes: of common images, below the unit of the sums (2^-60), near the largest sample, and all of these.
  const std::pair<double, double> exponents[] = {{-30, 12}, {-68, -55}, {15, 30}, {-70, 31}};
  for (int trial = 0; trial < 3000; ++trial) {
    clear();
    request_.light_groups = trial % 4 != 0;
    request_.groups.assign(1 + random() % (trial % 50 == 1 ? base::kMaxLightGroups : 4), {"", true, true});
    for (std::size_t g = 0; g < request_.groups.size(); ++g) request_.groups[g].name = "g" + std::to_string(g);
    const auto [low, high] = exponents[trial / 4 % 4];
    std::uniform_real_distribution<double> exponent(low, high);
    // Single precision as in the fast kernel, whose rounded path sums differ from the sum of the events.
    const bool is_fast = random() % 2 == 0;
    const int paths = 1 + static_cast<int>(uniform(random) * 40);
    for (int i = 0; i < paths; ++i) {
      kernel::PathRecord path = path_to(0);
      std::vector<kernel::LightEvent> events(random() % 6);
      for (kernel::LightEvent& e : events) {
        e.lobe = static_cast<kernel::Lobe>(random() % kernel::kLobes);
        e.group = static_cast<std::uint16_t>(random() % request_.groups.size());
        for (int c = 0; c < 3; ++c) {
          e.value[c] = uniform(random) < 0.2 || (c == 2 && trial % 3 == 0) ? 0 : std::exp2(exponent(random));
          if (is_fast) e.value[c] = static_cast<float>(e.value[c]);
          path.light[c] += e.value[c];
          if (is_fast) path.light[c] = static_cast<float>(path.light[c]);
        }
      }
      add(path, events);
    }
    const Picture p = picture();
    for (int c = 0; c < 3; ++c) {
      const std::string channel = std::string(".") + "RGB"[c], what = "trial " + std::to_string(trial) + channel;
      const auto whole = static_cast<float>(mean(beauty().rgb[c], beauty().weight));
      std::vector<float> lobes, groups, products;
      for (const char* lobe : kLobeNames) {
        lobes.push_back(value(p, lobe + channel));
        std::vector<float> parts;
        for (const LightGroup& g : request_.groups)
          if (request_.light_groups) parts.push_back(value(p, g.name + "_" + lobe + channel));
        if (request_.light_groups) expect_sum(parts, lobes.back(), random, what);
        products.insert(products.end(), parts.begin(), parts.end());
      }
      expect_sum(lobes, whole, random, what);
      if (!request_.light_groups) continue;
      for (const LightGroup& g : request_.groups) {
        groups.push_back(value(p, g.name + channel));
        std::vector<float> parts;
        for (const char* lobe : kLobeNames) parts.push_back(value(p, g.name + "_" + lobe + channel));
        expect_sum(parts, groups.back(), random, what);
      }
      expect_sum(groups, whole, random, what);
      expect_sum(products, whole, random, what);
    }
    if (HasFatalFailure()) return;
  }
}

/// The rounding errors of the layers, in units of the whole's last bit, and cells without light.
TEST_F(FilmLayerPlanes, LightIsRoundedToTheLastBitOfTheBeauty) {
  request_.diffuse = request_.emission = request_.light_groups = true;
  request_.groups = {{"a", true, true}, {"b", true, true}, {"c", true, true}};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  double of_cells = 0, of_lobes = 0, of_groups = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    clear();
    double cells[3][kernel::kLobes] = {};
    kernel::PathRecord path = path_to(0);
    std::vector<kernel::LightEvent> events;
    for (std::uint16_t g = 0; g < 2; ++g) {
      for (int lobe = 1; lobe < kernel::kLobes; ++lobe) {
        const double light = uniform(random);
        // The radiance of the path has a relative rounding error, as in single precision; all cells share it.
        cells[g][lobe] = light * (1 + 0x1p-21);
        path.light[0] += cells[g][lobe];
        events.push_back({{light, 0, 0}, 0, g, static_cast<kernel::Lobe>(lobe)});
      }
    }
    add(path, events);
    const Picture p = picture();
    const double unit = std::ldexp(1, std::ilogb(static_cast<float>(path.light[0])) - 23);
    for (std::size_t g = 0; g < 3; ++g) {
      double sum = 0;
      for (int lobe = 0; lobe < kernel::kLobes; ++lobe) {
        const float v = value(p, request_.groups[g].name + "_" + kLobeNames[lobe] + ".R");
        sum += cells[g][lobe];
        of_cells = std::max(of_cells, std::abs(v - cells[g][lobe]) / unit);
        if (cells[g][lobe] == 0) {
          ASSERT_EQ(v, 0);
        }
      }
      of_groups = std::max(of_groups, std::abs(value(p, request_.groups[g].name + ".R") - sum) / unit);
    }
    for (int lobe : {1, 2, 7})
      of_lobes = std::max(
          of_lobes, std::abs(value(p, kLobeNames[lobe] + std::string(".R")) - cells[0][lobe] - cells[1][lobe]) / unit);
  }
  EXPECT_LT(of_cells, 1.001);
  EXPECT_LT(of_lobes, 1.001);
  EXPECT_LT(of_groups, 8);
  EXPECT_GT(of_cells, 0.9) << "as documented";
}

/// Paths whose rounded sums differ from their events, where the mean of a pixel is half way between two floats and the
/// rounding of that difference decides.
TEST_F(FilmLayerPlanes, RoundingErrorsNeitherLoseTheLastBitNorMakeLightNegative) {
  request_.diffuse = true;
  const kernel::Int128 half_way = (kernel::Int128{1} << 60) + (kernel::Int128{1} << 36);  // 1 + 2^-24
  beauty() = {{3 * half_way + 512, 0, 0}, 3};
  sums().layers.light[1][0] = beauty().rgb[0] - 300;
  EXPECT_EQ(value(picture(), "diffuse_direct.R"), 1 + 0x1p-23F);
  beauty() = {{3 * half_way, 0, 0}, 3};
  sums().layers.light[1][0] = beauty().rgb[0] + 300;
  sums().layers.light[2][0] = 1;
  EXPECT_EQ(value(picture(), "diffuse_direct.R"), 1);
  EXPECT_EQ(value(picture(), "diffuse_indirect.R"), 0);
}

/// A lobe layer has the same bits whether or not light groups are requested.
TEST_F(FilmLayerPlanes, LightGroupsDoNotChangeTheLobes) {
  request_.diffuse = request_.specular = request_.background = request_.emission = true;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    kernel::PathRecord path = path_to(0);
    std::vector<kernel::LightEvent> events(1 + random() % 9);
    float sum = 0;
    for (kernel::LightEvent& e : events) {
      const float light = uniform(random);
      e = {{light, light, light}, 0, static_cast<std::uint16_t>(random() % 3), static_cast<kernel::Lobe>(random() % 8)};
      sum += light;
    }
    std::fill_n(path.light, 3, double{sum});
    Picture pictures[2];
    for (const bool with_groups : {false, true}) {
      clear();
      request_.light_groups = with_groups;
      request_.groups.assign(with_groups ? 3 : 0, {"g", true, true});
      add(path, events);
      pictures[with_groups] = picture();
    }
    for (const Plane& plane : pictures[0].planes) EXPECT_EQ(plane.values, pictures[1].find(plane.name)->values);
  }
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

/// Shards have sums of the same paths in two pixels.
TEST_F(FilmLayerPlanes, MergedPixelsAddTheirLight) {
  request_.light_groups = true;
  request_.groups = {{"a", true, true}, {"b", true, true}};
  const kernel::PathRecord path = path_to(0, 0.5);
  add(path, {{{0.5, 0.5, 0.5}, 0, 1, kernel::Lobe::kEmission}});
  const Sums first = sums();
  clear();
  sums().add(first);  // a pixel that this shard does not own
  add(path, {{{0.5, 0.5, 0.5}, 0, 0, kernel::Lobe::kDiffuseDirect}});
  sums().add(Sums(1, 1, request_));
  EXPECT_EQ(value(picture(), "b_emission.R"), 0.25F);
  EXPECT_EQ(value(picture(), "a.G"), 0.25F);
}

TEST_F(FilmLayerPlanes, InvalidRadianceIsIgnored) {
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
TEST_F(FilmLayerPlanes, VarianceIsThatOfTheMean) {
  request_.variance = true;
  for (const double light : {1.0, 2.0, 3.0, 6.0}) add(path_to(0, light));
  EXPECT_FLOAT_EQ(value(picture(), "variance.R"), 14.0F / 12);
  clear();
  add(path_to(0, 4));
  EXPECT_EQ(value(picture(), "variance.R"), 0);  // one path has no sample variance
}

/// Squares below 2^14 are converted in 64 bits, others in two steps.
/// Up to kLargestSquare.
TEST_F(FilmLayerPlanes, SquaresAreExact) {
  request_.variance = true;
  for (const std::int64_t light : {1LL, 127LL, 128LL, 129LL, 200LL, 1LL << 20, 11'863'283LL}) {
    clear();
    add(path_to(0, static_cast<double>(light)));
    EXPECT_TRUE(sums().layers.squares[0][0] == static_cast<kernel::Int128>(light * light) << 48) << light;
  }
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

/// All that two halves of the maximum number of samples can add up to fits into the sums.
TEST_F(FilmLayerPlanes, SumsHoldTheMaximumCountOfTheBrightestPaths) {
  request_.variance = request_.diffuse = true;
  const auto twice = [&] { sums().add(Sums(sums())); };
  for (int bit = 0; bit < 31; ++bit) {
    twice();
    add(path_to(0, kernel::kLargestSample));
  }
  twice();
  EXPECT_EQ(beauty().weight, 2 * ((1U << 31) - 1));
  const Picture p = picture();
  EXPECT_EQ(value(p, "diffuse_direct.R"), 0x1p35F);
  EXPECT_EQ(mean(beauty().rgb[0], beauty().weight), 0x1p35);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_TRUE(sums().layers.squares[0][c] > 0) << "overflow";
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
