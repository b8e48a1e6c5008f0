// SPDX-License-Identifier: Apache-2.0
// The true error of images with a target noise, in scenes whose noise a pixel's own samples do not show.
// bench_noise_pools and bench_noise_guarantee test more scenes, more often.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/display_error.h"
#include "film/picture.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

/// A dim, constant sky, so that paths end at once, with lamps at random places.
scene::Scene lamps(int count, double distance, double radius, double radiance) {
  scene::Scene s;
  s.image = {32, 18};
  s.camera.vfov = 40;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0.02, 0.02, 0.02};
  s.render.direct_lighting = scene::DirectLighting::kBsdf;  // otherwise most lamps are sampled
  std::mt19937 random(7);
  const auto place = [&] { return (static_cast<double>(random()) * 0x1p-32 - 0.5) * distance; };
  for (int i = 0; i < count; ++i) {
    const double x = place(), y = 0.5 * place();
    test::add_lamp(s, {x, y, -distance}, radius, {radiance, radiance, 0.5 * radiance});
  }
  return s;
}

test::NamedScene distant_lamps() { return {"distant lamps", lamps(12, 100, 0.3, 300)}; }

test::NamedScene blurred_lamps() {
  scene::Scene s = lamps(6, 30, 0.1, 4000);
  s.camera.defocus_angle = 4;
  s.camera.focus_distance = 6;
  return {"blurred lamps", s};
}

test::NamedScene moving_lamps() {
  scene::Scene s = lamps(6, 10, 0.03, 2000);
  scene::Scene closing = s;
  for (scene::Sphere& lamp : closing.spheres) lamp.center.x += 1.5;
  return {"moving lamps", s, closing};
}

/// Half of each image is hidden: what is projected there is not seen.
test::NamedScene half_hidden_lamps() {
  scene::Scene s = lamps(12, 100, 0.3, 300);
  s.materials.push_back({"soot", scene::Lambertian{{0, 0, 0}}});
  s.spheres.push_back({{-1000.5, 0, -10}, 1000, static_cast<std::uint32_t>(s.materials.size() - 1), ""});
  return {"half hidden lamps", s};
}

using Values = std::vector<double>;

Values values_of(const film::Picture& picture) {
  Values out;
  for (std::size_t c = 0; c < 3; ++c)
    out.insert(out.end(), picture.planes[c].values.begin(), picture.planes[c].values.end());
  return out;
}

double error_of(const Values& image, const Values& truth) {
  const std::size_t pixels = truth.size() / 3;
  double sum = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    double squares = 0, light = 0;
    for (std::size_t at = i; at < truth.size(); at += pixels) {
      squares += (image[at] - truth[at]) * (image[at] - truth[at]);
      light += truth[at];
    }
    sum += film::display_error_squared(squares, light);
  }
  return std::sqrt(sum / static_cast<double>(pixels));
}

TEST(NoiseTarget, IsMetWhereFewPathsFindLight) {
  constexpr double kNoise = 0.15;
  constexpr int kSeeds = 8;
  for (const auto& [name, opening, closing] : {distant_lamps(), blurred_lamps(), moving_lamps(), half_hidden_lamps()}) {
    const auto rendered = [&, &s = opening, &c = closing](std::uint32_t seed, int samples, const Settings& settings) {
      compile::CompiledScene compiled = compile::compile(s, c ? &*c : nullptr);
      compiled.sampler.seed = seed;
      compiled.samples = samples;
      return render(compiled, settings);
    };
    const Values truth = values_of(rendered(1000, 1 << 15, {}).picture);
    Settings settings;
    settings.noise = kNoise;
    settings.unlimited = true;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const Result r = rendered(seed, 1, settings);
      EXPECT_EQ(r.statistics.ended_by, "noise") << name;
      EXPECT_LT(error_of(values_of(r.picture), truth), 1.1 * kNoise) << name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace orrery::render
