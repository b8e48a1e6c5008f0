// SPDX-License-Identifier: Apache-2.0
// Renders positions: a PNG that shows the image while it is rendered, Ctrl+C to stop, and the image at the end.
//
//   spiral IMAGE.png [SAMPLES]      samples per pixel
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "display/develop.h"
#include "image/write.h"
#include "preview/preview.h"
#include "render/render.h"

namespace {

std::atomic<bool> stop{false};

/// A thousand spheres in the order of a sunflower's seeds, coloured from the centre outwards.
orrery::scene::Points sunflower() {
  orrery::scene::Points points;
  for (int i = 0; i < 1000; ++i) {
    const double radius = 0.1 * std::sqrt(i), angle = 2.39996 * i;
    points.centers.push_back({radius * std::cos(angle), 0.6 * std::exp(-radius * radius), radius * std::sin(angle)});
    points.radii.push_back(0.1);
    points.colors.push_back(static_cast<std::uint16_t>(i / 10));  // index into the palette
  }
  for (int i = 0; i < 100; ++i) points.palette.push_back({0.6, 0.02 + 0.004 * i, 0.02});  // linear Rec.709
  return points;
}

}  // namespace

int main(int argc, char** argv) try {
  const char* const file = argc > 1 ? argv[1] : "spiral.png";
  orrery::scene::Scene scene;
  scene.image = {320, 180};
  scene.render.samples = argc > 2 ? std::atoi(argv[2]) : 64;
  scene.camera.look_from = {0, 5, 6};
  scene.camera.look_at = {0, 0, 1};
  scene.camera.vfov = 38;
  scene.background.bottom = {0.02, 0.02, 0.03};  // light from above, before a dark background
  scene.background.top = {1.6, 1.6, 1.6};
  scene.materials = {{"seed", orrery::scene::Plastic{}}};
  scene.points = {sunflower()};

  orrery::preview::Preview preview(file, {});
  preview.begin({scene.image.width, scene.image.height, {}});
  orrery::render::Settings settings;
  settings.on_pixels = [&](const auto& state, const auto& rendered) { preview.write(state, rendered); };
  settings.on_progress = [](const auto& progress) {
    std::printf("\r%.0f %%", 100.0 * progress.samples_done / progress.samples_total);
    std::fflush(stdout);
  };
  settings.cancel = &stop;
  std::signal(SIGINT, [](int) { stop = true; });
  const orrery::render::Result result = orrery::render::render(orrery::compile::compile(scene), settings);
  preview.end();
  std::printf("\n");
  if (!result.completed) return 130;
  orrery::image::write_encoded(file, orrery::display::develop(result.picture, {}, 8), "spiral");
  return 0;
} catch (const orrery::base::Error& error) {
  std::fprintf(stderr, "spiral: %s\n", error.what());
  return orrery::base::exit_status(error.kind());
}
