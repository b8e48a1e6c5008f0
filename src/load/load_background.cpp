// SPDX-License-Identifier: Apache-2.0
#include "load/load_background.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"
#include "compile/environment.h"
#include "display/color_space.h"
#include "load/load_map.h"
#include "scene/scene.h"
#include "sky/daylight.h"

namespace orrery::load {
namespace {

namespace fs = std::filesystem;

compile::EnvironmentSampling sampling_of(const scene::Scene& scene) {
  return scene.render.direct_lighting == scene::DirectLighting::kBsdf ? compile::EnvironmentSampling::kNone
                                                                      : compile::EnvironmentSampling::kComplete;
}

MapRequest map_request(const BackgroundRequest& request, const scene::Scene& scene) {
  MapRequest out;
  out.file = request.file;
  out.file_key = "background.file";
  out.space_key = "background.color_space";
  out.color_space = scene.background.color_space;
  out.default_space = scene.color.space;
  out.working_space = scene.color.working_space();
  out.ocio_config = request.ocio_config;
  out.sampling = sampling_of(scene);
  out.memory_limit = request.memory_limit;
  out.skips_large = request.skips_large;
  return out;
}

/// Converts a colour, and replaces negative components by 0.
math::Vec3d converted(const display::PixelConversion& convert, math::Vec3d color) {
  if (!convert) return color;
  float rgb[3] = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
  convert(rgb, 1);
  const auto component = [](float v) { return static_cast<double>(std::max(v, 0.0F)); };
  return {component(rgb[0]), component(rgb[1]), component(rgb[2])};
}

}  // namespace

LoadedBackground load_sky(const std::string& ocio_config, const scene::Scene& scene) {
  LoadedBackground out;
  out.color_space = "lin_rec709";
  display::PixelConversion to_sky, to_working;
  try {
    to_sky = display::pixel_conversion(ocio_config, scene.color.space, out.color_space);
    to_working = display::pixel_conversion(ocio_config, out.color_space, scene.color.working_space());
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kUsage) throw;
    out.diagnostics.push_back({base::Severity::kError, "background.type",
                               std::string("a sky needs linear Rec.709: ") + error.what(), base::ErrorKind::kBadData});
    return out;
  }
  scene::Background background = scene.background;
  const math::Vec3d albedo = converted(to_sky, background.ground_albedo);
  background.ground_albedo = {std::min(albedo.x, 1.0), std::min(albedo.y, 1.0), std::min(albedo.z, 1.0)};
  const auto image = std::make_shared<scene::EnvironmentImage>(sky::bake_sky(background));
  if (to_working) {
    const auto width = static_cast<std::size_t>(image->width());
    for (int y = 0; y < image->height(); ++y) {
      float* const row = image->row(y);
      to_working(row, width);
      for (std::size_t i = 0; i < 3 * width; ++i) row[i] = std::max(row[i], 0.0F);
    }
    image->sun.radiance = converted(to_working, image->sun.radiance);
  }
  const math::Vec3d sun = image->sun.radiance;
  out.brightest = static_cast<float>(std::max({sun.x, sun.y, sun.z}));
  for (int y = 0; y < image->height(); ++y)
    out.brightest = std::max(out.brightest, *std::max_element(image->row(y), image->row(y) + 3 * image->width()));
  out.width = image->width();
  out.height = image->height();
  out.bytes = compile::environment_bytes(out.width, out.height, sampling_of(scene));
  out.image = image;
  return out;
}

LoadedBackground load_background(const BackgroundRequest& request, const scene::Scene& scene) {
  std::string version = background_version(request, scene);
  LoadedBackground out = load_map(map_request(request, scene));
  out.version = std::move(version);
  return out;
}

std::string background_version(const BackgroundRequest& request, const scene::Scene& scene) {
  return fmt::format("{}\n{}\n{}\n{}\n{}", base::file_version(request.file), request.ocio_config,
                     scene.background.color_space, scene.color.space, scene.color.working_space());
}

}  // namespace orrery::load
