// SPDX-License-Identifier: Apache-2.0
// Checks that the baseline and orrery compute the same image of the final scene; only then is a speed ratio meaningful.
#include <cmath>
#include <cstdio>
#include <exception>
#include <utility>

#include "baseline/program.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/picture.h"
#include "generate/generate.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::bench {
namespace {

constexpr int kWidth = 48, kHeight = 27, kSamples = 256;

/// The mean of many thousand independent differences is normally distributed. Five sigma is one false alarm in a
/// million seeds, and the seeds are fixed.
constexpr double kSigmas = 5;

/// Tests for each colour channel whether the mean difference over the pixels is zero.
bool holds(const std::vector<math::Vec3d>& baseline, const film::Picture& picture) {
  bool same = true;
  const char* const names[3] = {"R", "G", "B"};
  double math::Vec3d::*const components[3] = {&math::Vec3d::x, &math::Vec3d::y, &math::Vec3d::z};
  for (int c = 0; c < 3; ++c) {
    const film::Plane& plane = *picture.find(names[c]);
    double sum = 0, squares = 0, level = 0;
    for (std::size_t i = 0; i < baseline.size(); ++i) {
      const double difference = baseline[i].*components[c] - static_cast<double>(plane.values[i]);
      sum += difference;
      squares += difference * difference;
      level += static_cast<double>(plane.values[i]);
    }
    const auto n = static_cast<double>(baseline.size());
    const double mean = sum / n, error = std::sqrt(squares) / n;
    std::printf("%s: mean %.4f, baseline differs by %+.5f +- %.5f\n", names[c], level / n, mean, error);
    same = same && std::abs(mean) < kSigmas * error;
  }
  return same;
}

int run() {
  scene::Scene scene = generate::make_final_scene({});
  scene.image = {kWidth, kHeight};
  scene.render.samples = kSamples;
  const render::Result result = render::render(compile::compile(scene), {});
  for (const auto& [name, spheres] : {std::pair{"the baseline", baseline::Spheres::kList},
                                      std::pair{"the baseline on sphere points", baseline::Spheres::kNativePoints}}) {
    baseline::Program program(scene, spheres);
    if (holds(program.render(1), result.picture)) continue;
    std::fprintf(stderr, "%s computes a different image: speed ratios to it are meaningless\n", name);
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace orrery::bench

int main() try { return orrery::bench::run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "bench_same_picture: error: %s\n", error.what());
  return 1;
}
