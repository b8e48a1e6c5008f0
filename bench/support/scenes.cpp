// SPDX-License-Identifier: Apache-2.0
#include "support/scenes.h"

#include <utility>

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

scene::Scene layer_scene(int grid, int width_px, int height_px, int samples) {
  generate::FinalScene layer;
  layer.grid = grid;
  return sized(generate::make_final_scene(layer), width_px, height_px, samples);
}

scene::Scene crystal_scene(int cells, int width_px, int height_px, int samples) {
  scene::Scene scene;
  const double middle = cells / 2.0;
  scene.camera.look_from = {2.0 * cells, 1.5 * cells, 2.5 * cells};
  scene.camera.look_at = {middle, middle, middle};
  scene.camera.vfov = 30;
  scene.background.bottom = scene.background.top = {1, 1, 1};
  scene.materials = {{"white", scene::Lambertian{{0.8, 0.8, 0.8}}}};
  scene::Points points;
  points.file = "crystal.ply";
  constexpr double kOffsets[4][3] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
  for (int i = 0; i < cells * cells * cells; ++i) {
    for (const auto& offset : kOffsets) {
      points.centers.push_back({i % cells + offset[0], i / cells % cells + offset[1], i / (cells * cells) + offset[2]});
      points.radii.push_back(0.3464);
    }
  }
  scene.points.push_back(std::move(points));
  return sized(std::move(scene), width_px, height_px, samples);
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
