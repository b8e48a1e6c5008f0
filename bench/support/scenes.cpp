// SPDX-License-Identifier: Apache-2.0
#include "support/scenes.h"
#include "compile/compiled_scene.h"

#include "compile/compile.h"
#include "generate/generate.h"

namespace orrery::bench {
namespace {

scene::Precision authored(kernel::Precision precision) {
  switch (precision) {
    case kernel::Precision::kFast: return scene::Precision::kFast;
    case kernel::Precision::kBook: return scene::Precision::kBook;
    case kernel::Precision::kExact: break;
  }
  return scene::Precision::kExact;
}

scene::Scene sized(scene::Scene scene, int width_px, int height_px, int samples) {
  scene.image = {width_px, height_px};
  scene.render.samples = samples;
  return scene;
}

}  // namespace

scene::Scene final_scene(int width_px, int height_px, int samples) {
  return sized(generate::make_final_scene({}), width_px, height_px, samples);
}

scene::Scene cloud_scene(std::uint64_t count, int width_px, int height_px, int samples) {
  generate::Cloud cloud;
  cloud.count = count;
  return sized(generate::make_cloud(cloud), width_px, height_px, samples);
}

compile::CompiledScene compile_for(scene::Scene scene, kernel::Precision precision) {
  scene.render.precision = authored(precision);
  return compile::compile(scene);
}

std::string name_of(kernel::Precision precision) {
  switch (precision) {
    case kernel::Precision::kFast: return "fast";
    case kernel::Precision::kBook: return "book";
    case kernel::Precision::kExact: break;
  }
  return "exact";
}

}  // namespace orrery::bench
