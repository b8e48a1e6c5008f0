// SPDX-License-Identifier: Apache-2.0
// Compares renders with closed-form images.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "math/vec3.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "support/chi_square.h"

namespace orrery::test {
namespace {

constexpr int kSide = 64;
constexpr int kSeeds = 24;
constexpr double kAlbedo[3] = {0.8, 0.5, 0.2};

/// A single diffuse sphere under the gradient sky, seen from afar so that it covers every pixel.
scene::Scene diffuse_sphere(double albedo_factor) {
  scene::Scene s;
  s.image = {kSide, kSide};
  s.camera.look_from = {300, 400, 1200};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 0.06;  // the sphere subtends 0.088 degrees and covers the corners
  s.render.samples = 64;
  s.background.bottom = {1, 0.9, 0.8};
  s.background.top = {0.2, 0.5, 1};
  s.materials = {
      {"m", scene::Lambertian{{kAlbedo[0] * albedo_factor, kAlbedo[1] * albedo_factor, kAlbedo[2] * albedo_factor}}}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}};
  return s;
}

/// Expected value of a channel, averaged over the pixel's area. The sky is linear in y, so its cosine-weighted mean
/// over the hemisphere around n is the sky at height 2/3 n.y.
double expected(const compile::CompiledScene& compiled, int px, int py, int channel) {
  constexpr int kGrid = 4;
  double sum = 0;
  const kernel::Camera& c = compiled.camera;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const double x = px + (i % kGrid + 0.5) / kGrid - c.half_width, y = py + (i / kGrid + 0.5) / kGrid - c.half_height;
    const math::Vec3d o = c.origin, d = c.forward + x * c.right + y * c.down;
    const double dd = dot(d, d), od = dot(o, d), oo = dot(o, o);
    const double t = (-od - std::sqrt(od * od - dd * (oo - 1))) / dd;
    const double normal_y = o.y + t * d.y;
    const double a = (2.0 / 3.0 * normal_y + 1) / 2;
    const math::Vec3d sky = compiled.background.bottom * (1 - a) + compiled.background.top * a;
    sum += kAlbedo[channel] * std::array{sky.x, sky.y, sky.z}[static_cast<std::size_t>(channel)];
  }
  return sum / (kGrid * kGrid);
}

/// Weighted sums of the residuals over the image, each as a t-statistic over the seeds.
std::vector<double> z_scores(double albedo_factor) {
  constexpr int kTiles = 4;
  constexpr int kSums = 2 + kTiles * kTiles;  // all pixels, all weighted by height, each tile
  std::vector<std::vector<double>> sums(kSums, std::vector<double>(kSeeds, 0.0));
  const compile::CompiledScene compiled = compile::compile(diffuse_sphere(albedo_factor));
  std::vector<double> truth;
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) truth.push_back(expected(compiled, x, y, c));
  for (int seed = 0; seed < kSeeds; ++seed) {
    compile::CompiledScene seeded = compiled;
    seeded.sampler.seed = static_cast<std::uint32_t>(seed + 1);
    const render::Result result = render::render(seeded, {});
    std::size_t i = 0;
    for (std::size_t c = 0; c < 3; ++c)
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x, ++i) {
          const double residual = static_cast<double>(result.picture.planes[c].values[i % (kSide * kSide)]) - truth[i];
          const auto s = static_cast<std::size_t>(seed);
          sums[0][s] += residual;
          sums[1][s] += residual * (kSide / 2 - y);
          sums[static_cast<std::size_t>(2 + y * kTiles / kSide * kTiles + x * kTiles / kSide)][s] += residual;
        }
  }
  std::vector<double> z;
  for (const auto& values : sums) {
    double mean = 0, square = 0;
    for (const double v : values) mean += v / kSeeds;
    for (const double v : values) square += (v - mean) * (v - mean);
    z.push_back(mean / std::sqrt(square / (kSeeds - 1) / kSeeds));
  }
  return z;
}

/// With 23 degrees of freedom a correct renderer exceeds this about once in a hundred thousand statistics.
constexpr double kLargestT = 5.6;

TEST(StatisticalClosedForm, DiffuseSphereUnderAGradientSky) {
  for (const double z : z_scores(1)) EXPECT_LT(std::abs(z), kLargestT);
}

TEST(StatisticalClosedForm, AlbedoErrorOfAThousandthIsDetectedAtSixSigma) {
  EXPECT_GT(std::abs(z_scores(1.001)[0]), 6);
}

}  // namespace
}  // namespace orrery::test
