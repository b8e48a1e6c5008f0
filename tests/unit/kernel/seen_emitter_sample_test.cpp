// SPDX-License-Identifier: Apache-2.0
#include "kernel/seen_emitter_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "kernel/scene_view.h"

namespace orrery::kernel {
namespace {

using math::Vec3d;

/// A camera that looks along -z, a lamp whose image touches a pixel, and a filter.
struct SeenLamp {
  SceneView scene;
  Sphere lamp;
  std::vector<double> places;
  double pixel[2];
};

class SeenLampMaker {
 public:
  SeenLampMaker() : engine_(11) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  void disc(double (&to)[2]) {
    const double radius = std::sqrt(number(0, 1)), angle = number(0, 2 * std::numbers::pi);
    to[0] = radius * std::cos(angle);
    to[1] = radius * std::sin(angle);
  }

  void make(SeenLamp& out, bool by_lens) {
    Camera& camera = out.scene.camera;
    const double focus = number(2, 8);
    camera.origin = {1, 2, 3};
    camera.forward = {0, 0, -focus};
    camera.right = {0.01 * focus, 0, 0};
    camera.down = {0, -0.012 * focus, 0};
    const double z =
        by_lens ? focus * (number(0, 1) < 0.5 ? number(0.4, 0.7) : number(1.5, 4)) : focus * number(0.8, 2);
    const double radius = 0.01 * z * number(0.05, 0.5), lens = by_lens ? radius * number(4, 15) : number(0, 1) * 0.02;
    camera.lens_u = {lens, 0, 0};
    camera.lens_v = {0, lens, 0};
    const double x = number(-0.6, 0.6) * z, y = number(-0.4, 0.4) * z;
    out.lamp = {camera.origin.x + x, camera.origin.y + y, camera.origin.z - z, radius};
    out.scene.spheres = SphereArray(&out.lamp);
    out.scene.sphere_count = 1;
    out.scene.features.lens = true;
    out.places.clear();
    if (number(0, 1) < 0.5)
      for (int i = 0; i <= PixelFilter::kSteps; ++i)
        out.places.push_back(1.5 * std::pow(static_cast<double>(i) / PixelFilter::kSteps, 1.5));
    out.scene.filter.places = out.places.empty() ? nullptr : out.places.data();
    const FilmDisc image = film_disc(camera, out.lamp);
    double off[2];
    disc(off);
    out.pixel[0] = std::round(image.x + off[0] * (image.radius + 0.5)) + 0.5;
    out.pixel[1] = std::round(image.y + off[1] * (image.radius + 0.5)) + 0.5;
  }

  SeenEmitterNumbers numbers() {
    SeenEmitterNumbers out{};
    for (double& u : out.film) u = number(0, 1);
    for (double& u : out.other) u = number(0, 1);
    disc(out.lens);
    disc(out.disc);
    return out;
  }

 private:
  std::mt19937_64 engine_;
};

double along_filter(const std::vector<double>& places, double u) {
  if (places.empty()) return u - 0.5;
  const double at = std::abs(2 * u - 1) * PixelFilter::kSteps;
  const auto step = std::min(static_cast<std::size_t>(at), places.size() - 2);
  return std::copysign(places[step] + (places[step + 1] - places[step]) * (at - static_cast<double>(step)), u - 0.5);
}

/// 1 if a camera ray hits the lamp.
double hit(const SeenLamp& c, const SeenEmitterNumbers& n) {
  const Camera& camera = c.scene.camera;
  const double x = c.pixel[0] + along_filter(c.places, n.film[0]), y = c.pixel[1] + along_filter(c.places, n.film[1]);
  const Vec3d lens = camera.lens_u * n.lens[0] + camera.lens_v * n.lens[1];
  const Vec3d direction = normalized(camera.forward + camera.right * x + camera.down * y - lens);
  const Vec3d to = Vec3d{c.lamp.x, c.lamp.y, c.lamp.z} - camera.origin - lens;
  return length(cross(to, direction)) < c.lamp.radius ? 1 : 0;
}

/// The mean weight is the fraction of the camera rays that hit the lamp.
TEST(KernelSeenEmitterSample, WeightsAreUnbiased) {
  constexpr int kCases = 150, kSamples = 40000;
  SeenLampMaker make;
  double squares = 0, gain = 0;
  int tested = 0;
  for (int i = 0; i < kCases; ++i) {
    SeenLamp c;
    const bool by_lens = i % 2 == 0;
    make.make(c, by_lens);
    const SeenEmitter lamp{0, 1, by_lens};
    double sum[2] = {}, square[2] = {};
    for (int k = 0; k < kSamples; ++k) {
      const SeenEmitterNumbers n = make.numbers();
      const double values[2] = {sample_seen_emitter(c.scene, lamp, c.pixel, n).weight, hit(c, n)};
      for (int j = 0; j < 2; ++j) {
        sum[j] += values[j] / kSamples;
        square[j] += values[j] * values[j] / kSamples;
      }
    }
    if (sum[1] * kSamples < 50) continue;
    const double sampled = (square[0] - sum[0] * sum[0]) / kSamples, found = (square[1] - sum[1] * sum[1]) / kSamples;
    const double z = (sum[0] - sum[1]) / std::sqrt(sampled + found);
    EXPECT_LT(std::abs(z), 4.5) << i << ": " << sum[0] << " against " << sum[1];
    squares += z * z;
    gain += std::log(found / sampled);
    ++tested;
  }
  ASSERT_GT(tested, kCases / 3);
  EXPECT_NEAR(std::sqrt(squares / tested), 1, 0.25);
  EXPECT_GT(std::exp(gain / tested), 5) << "the variance of hits by chance, relative";
}

/// Rays hit the lamp, from a point of the lens.
TEST(KernelSeenEmitterSample, RaysReachTheEmitter) {
  SeenLampMaker make;
  int rays = 0;
  for (int i = 0; i < 2000; ++i) {
    SeenLamp c;
    make.make(c, i % 2 == 0);
    const SeenEmitter lamp{0, 1, i % 2 == 0};
    const SeenEmitterSample s = sample_seen_emitter(c.scene, lamp, c.pixel, make.numbers());
    if (!(s.weight > 0)) continue;
    ++rays;
    const Vec3d end = c.scene.camera.origin + s.offset + s.reach;
    EXPECT_NEAR(length(end - Vec3d{c.lamp.x, c.lamp.y, c.lamp.z}) / c.lamp.radius, 1, 1e-6);
    EXPECT_LE(length(s.offset), length(c.scene.camera.lens_u) * (1 + 1e-12));
  }
  EXPECT_GT(rays, 300);
}

/// Where the whole ellipse is on the lens, the weight hardly varies.
TEST(KernelSeenEmitterSample, BlurredLampsHaveHardlyAnyNoise) {
  SeenLampMaker make;
  SeenLamp c;
  Camera& camera = c.scene.camera;
  camera.forward = {0, 0, -6};
  camera.right = {0.06, 0, 0};
  camera.down = {0, -0.06, 0};
  camera.lens_u = {0.2, 0, 0};
  camera.lens_v = {0, 0.2, 0};
  c.lamp = {0, 0, -30, 0.2};
  c.scene.spheres = SphereArray(&c.lamp);
  c.scene.features.lens = true;
  const SeenEmitter lamp{0, 1, true};
  const double pixel[2] = {0.5, 0.5};
  for (int i = 0; i < 1000; ++i) {
    const double weight = sample_seen_emitter(c.scene, lamp, pixel, make.numbers()).weight;
    EXPECT_NEAR(weight, 0.2 * 0.2 / (0.8 * 0.8), 0.02 * weight);  // the blur has four times the lens's radius
  }
}

TEST(KernelSeenEmitterSample, EmittersAreChosenByTheirShares) {
  const SeenEmitter pair[2] = {{3, 0.25f, false}, {4, 1, false}};
  for (const double choice : {0.0, 0.2, 0.3, 1.0}) {
    const SeenEmitterChoice chosen = choose_seen_emitter(pair, choice);
    EXPECT_EQ(chosen.emitter.id, choice < 0.25 ? 3u : 4u);
    EXPECT_EQ(chosen.probability, choice < 0.25 ? 0.25 : 0.75);
  }
}

/// Over all directions from a point of the lens, the density of camera rays is 1.
TEST(KernelSeenEmitterSample, CameraRaysHaveADensity) {
  SeenLampMaker make;
  for (int i = 0; i < 8; ++i) {
    SeenLamp c;
    make.make(c, i % 2 == 0);
    const Camera& camera = c.scene.camera;
    const Vec3d lens = camera.lens_u * 0.6 - camera.lens_v * 0.3;
    const Vec3d axis = normalized(camera.forward + camera.right * c.pixel[0] + camera.down * c.pixel[1] - lens);
    const Vec3d across = normalized(cross(axis, {0, 1, 0})), up = cross(across, axis);
    // A square of the plane that touches the unit sphere.
    constexpr int kSteps = 400;
    constexpr double kSide = 0.08, kCell = kSide / kSteps;
    double sum = 0;
    for (int y = 0; y < kSteps; ++y)
      for (int x = 0; x < kSteps; ++x) {
        const Vec3d to = axis + across * ((x + 0.5) * kCell - kSide / 2) + up * ((y + 0.5) * kCell - kSide / 2);
        const double away = length(to);
        sum += camera_ray_density(c.scene, c.pixel, lens, to / away) * kCell * kCell / (away * away * away);
      }
    EXPECT_NEAR(sum, 1, 0.02) << i;
    EXPECT_EQ(camera_ray_density(c.scene, c.pixel, lens, -axis), 0) << i;
  }
}

}  // namespace
}  // namespace orrery::kernel
