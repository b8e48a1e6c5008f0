// SPDX-License-Identifier: Apache-2.0
#include "study/study_renderer.h"

#include <algorithm>

#include "base/error.h"
#include "compile/compile.h"
#include "denoise/denoise.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "study/study.h"

namespace orrery::study {

double StudyRenderer::elapsed() const {
  return request_.paths_per_s > 0 ? paths_ / request_.paths_per_s : since_start_.seconds();
}

double StudyRenderer::seconds_of(const render::Statistics& did) const {
  return request_.paths_per_s > 0 ? static_cast<double>(did.paths) / request_.paths_per_s : did.render_s;
}

accel::Accel& StudyRenderer::accel_of(const compile::CompiledScene& scene) {
  // The accelerator depends on the spheres alone, whose storage does not move when it is lent.
  std::unique_ptr<accel::Accel>& accel = accels_[{scene.precision, scene.accelerator}];
  if (!accel) {
    const double begin = elapsed();
    accel = render::build(scene, threads_);
    build_s_ = std::max(build_s_, elapsed() - begin);
  }
  return *accel;
}

render::Result StudyRenderer::render(compile::CompiledScene& scene, double noise,
                                     std::optional<accel::Traversal> traversal, bool is_denoised) {
  spheres_.swap(scene);
  struct Return {
    Spheres& spheres;
    compile::CompiledScene& from;
    ~Return() { spheres.swap(from); }
  } const end{spheres_, scene};
  compile::update_lights(scene);
  render::Settings settings;
  settings.threads = threads_;
  settings.noise = noise;
  settings.unlimited = noise > 0;
  settings.traversal = traversal;
  settings.layers.halves = is_denoised;
  settings.cancel = request_.cancel;
  render::Result result = render::render(scene, accel_of(scene), settings);
  if (!result.completed) throw base::Error(base::ErrorKind::kStopped, "stopped; the study is incomplete");
  if (is_denoised) {
    const base::Stopwatch watch;
    denoise::denoise(result.picture, threads_);
    result.statistics.render_s += watch.seconds();
  }
  result.picture.planes.resize(3);
  isa_ = result.statistics.isa;
  paths_ += static_cast<double>(result.statistics.paths);
  return result;
}

double StudyRenderer::measure_speed(compile::CompiledScene pilot) {
  pilot.samples = 1;
  render(pilot);  // builds the BVH and warms up
  if (request_.paths_per_s > 0) return request_.paths_per_s;
  const double begin = elapsed();
  double paths = 0;
  while (elapsed() - begin < std::min(0.5, request_.budget_s / 50)) {
    pilot.samples *= 2;
    paths += static_cast<double>(render(pilot).statistics.paths);
  }
  return paths / (elapsed() - begin);
}

}  // namespace orrery::study
