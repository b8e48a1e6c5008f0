// SPDX-License-Identifier: Apache-2.0
#include "compile/compile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "base/stop_point.h"
#include "compile/camera_basis.h"
#include "compile/compiled_scene.h"
#include "compile/daylight.h"
#include "compile/environment.h"
#include "compile/light_tree.h"
#include "compile/material_table.h"
#include "compile/pixel_filter.h"
#include "kernel/sobol_columns.h"
#include "scene/layers.h"

namespace orrery::compile {
namespace {

using math::set;
using math::Vec3d;

kernel::Sphere sphere_of(Vec3d center, double radius) { return {center.x, center.y, center.z, std::abs(radius)}; }

void add_spheres(const scene::Scene& scene, CompiledScene& compiled) {
  const base::StopPoint stop;
  const std::size_t count = scene.sphere_count();
  compiled.sphere_materials.reserve(count);
  MaterialTable table(scene, compiled);
  for (const scene::Sphere& s : scene.spheres) {
    compiled.spheres.push_back(sphere_of(s.center, s.radius));
    compiled.sphere_materials.push_back(table.index(s.material, s.radius < 0));
  }
  compiled.spheres.append(scene.points);
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    const scene::Points& points = scene.points[p];
    for (std::size_t i = 0; i < points.centers.size(); ++i) {
      stop.check(i);
      const std::uint32_t material = points.materials.empty() ? points.material : points.materials[i];
      const bool inside_out = points.radii[i] < 0;
      compiled.sphere_materials.push_back(
          points.colors.empty()
              ? table.index(material, inside_out)
              : table.colored_index(material, inside_out, p, points.colors[i], points.palette[points.colors[i]]));
    }
  }
}

Bounds bounds_of(const SphereStore& spheres) {
  if (spheres.empty()) return {};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Bounds b{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  const base::StopPoint stop;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    stop.check(i);
    const kernel::Sphere s = spheres[i];
    b.lower = {std::min(b.lower.x, s.x - s.radius), std::min(b.lower.y, s.y - s.radius),
               std::min(b.lower.z, s.z - s.radius)};
    b.upper = {std::max(b.upper.x, s.x + s.radius), std::max(b.upper.y, s.y + s.radius),
               std::max(b.upper.z, s.z + s.radius)};
  }
  return b;
}

/// Adds the motion of the camera and of [[sphere]] tables from shutter open to shutter close.
void add_motion(const scene::Scene& opening, const scene::Scene& closing, double view_scale, CompiledScene& compiled) {
  for (std::size_t i = opening.spheres.size(); i-- > 0;) {
    const scene::Sphere &from = opening.spheres[i], &to = closing.spheres[i];
    const Vec3d displacement = to.center - from.center;
    const kernel::Sphere change{displacement.x, displacement.y, displacement.z,
                                std::abs(to.radius) - std::abs(from.radius)};
    const bool rests = change.x == 0 && change.y == 0 && change.z == 0 && change.radius == 0;
    if (compiled.motion.empty() && !rests) compiled.motion.resize(i + 1, kernel::Sphere{0, 0, 0, 0});
    if (!rests) compiled.motion[i] = change;
  }
  const kernel::Camera last = compile_camera(closing.camera, closing.image, view_scale);
  kernel::Camera& change = compiled.camera_motion;
  bool camera_moves = false;
  const auto subtract = [&](const double(&to)[3], const double(&from)[3], double(&out)[3]) {
    for (int k = 0; k < 3; ++k) {
      out[k] = to[k] - from[k];
      camera_moves = camera_moves || out[k] != 0;
    }
  };
  subtract(last.origin, compiled.camera.origin, change.origin);
  subtract(last.forward, compiled.camera.forward, change.forward);
  subtract(last.right, compiled.camera.right, change.right);
  subtract(last.down, compiled.camera.down, change.down);
  subtract(last.lens_u, compiled.camera.lens_u, change.lens_u);
  subtract(last.lens_v, compiled.camera.lens_v, change.lens_v);
  compiled.features.motion = camera_moves || !compiled.motion.empty();
}

/// Compiles an image background or a sky; without one, the gradient or constant colour.
void set_background(const scene::Scene& scene, CompiledScene& compiled) {
  const scene::Background& from = scene.background;
  compiled.backdrop = from.backdrop;
  std::shared_ptr<const scene::EnvironmentImage> image = from.image;
  if (!image && from.type == scene::BackgroundType::kSky)
    image = std::make_shared<const scene::EnvironmentImage>(bake_sky(from));
  if (image) {
    EnvironmentSettings settings;
    settings.rotation = from.rotation;
    settings.scale = stops_to_factor(from.exposure);
    settings.sampling = environment_sampling(compiled.direct_lighting);
    settings.light_group = light_group(compiled, from.light_group);
    settings.visible = from.visible;
    compiled.environment = std::make_shared<const EnvironmentMap>(image, settings);
    compiled.background = {{0, 0, 0}, {0, 0, 0}};
    return;
  }
  const bool gradient = from.type == scene::BackgroundType::kGradient;
  compiled.background.bottom = gradient ? from.bottom : from.color;
  compiled.background.top = gradient ? from.top : from.color;
  compiled.features.sky = gradient && !(from.bottom == from.top);
}

/// With blue noise, a pixel owns a power of two of consecutive points of the sequence, at least as many as its samples;
/// its neighbours own the next ones.
kernel::Sampler compile_sampler(const scene::Render& render) {
  kernel::Sampler out;
  out.seed = render.seed;
  switch (render.sampler) {
    case scene::Sampler::kIndependent: out.kind = kernel::SamplerKind::kIndependent; break;
    case scene::Sampler::kSobol: out.kind = kernel::SamplerKind::kSobol; break;
    case scene::Sampler::kBlueNoise: out.kind = kernel::SamplerKind::kBlueNoise; break;
  }
  out.blue_noise_bits = blue_noise_bits(render.samples);
  return out;
}

}  // namespace

kernel::SceneView CompiledScene::view() const noexcept {
  kernel::SceneView v;
  v.spheres = spheres.view();
  v.sphere_materials = sphere_materials.view();
  v.materials = materials.data();
  v.sphere_count = spheres.size();
  v.emission = emission.empty() ? nullptr : emission.data();
  if (!textures.textures().empty()) {
    v.textures = textures.textures().data();
    v.material_textures = textures.materials().data();
    if (textures.has_levels()) v.cone_width = kConeWidth;
  }
  v.lights = light_tree.view();
  v.direct_lighting = direct_lighting;
  v.motion = motion.data();
  v.moving_count = motion.size();
  v.distinct = distinct_in.has_value();
  v.distinct_in_single = distinct_in == scene::Precision::kFast;
  v.camera_motion = camera_motion;
  v.camera = camera;
  v.background = background;
  v.environment = environment ? &environment->view() : nullptr;
  v.background_visible = backdrop || !environment || environment->view().visible;
  v.has_backdrop = backdrop.has_value();
  v.backdrop = backdrop.value_or(math::Vec3d());
  v.features = features;
  v.shading = shading;
  v.max_depth = max_depth;
  v.roulette_depth = roulette_depth;
  v.sampler = sampler;
  v.filter = filter.view();
  v.window_x = static_cast<std::uint32_t>(window_x) & 0xffff;
  v.window_y = static_cast<std::uint32_t>(window_y) & 0xffff;
  return v;
}

void update_lights(CompiledScene& scene) {
  const auto is_fast = [](Precision precision) { return precision == Precision::kFast; };
  const std::optional<Precision> built = scene.light_tree.precision;
  if (scene.emission.empty() || scene.direct_lighting == kernel::DirectLighting::kBsdf) {
    scene.light_tree = {};
  } else if (!built || (is_fast(*built) != is_fast(scene.precision) && scene.distinct_in != scene::Precision::kFast)) {
    scene.light_tree = build_light_tree(scene.view(), scene.precision);
  }
}

int blue_noise_bits(int samples) noexcept {
  return std::min(static_cast<int>(std::bit_width(static_cast<unsigned>(samples) - 1)), kernel::kSobolBits);
}

CompiledScene compile(const scene::Scene& scene, const scene::Scene* closing) {
  CompiledScene compiled;
  const scene::Window window = scene.image.data_window();
  compiled.window_x = window.x;
  compiled.window_y = window.y;
  compiled.frame_width = scene.image.width;
  compiled.frame_height = scene.image.height;
  compiled.pixel_aspect = scene.image.pixel_aspect;
  compiled.width = window.width;
  compiled.height = window.height;
  compiled.samples = scene.render.samples;
  compiled.max_depth = static_cast<std::uint32_t>(scene.render.max_depth);
  if (scene.render.roulette_depth > 0)
    compiled.roulette_depth = static_cast<std::uint32_t>(scene.render.roulette_depth);
  compiled.sampler = compile_sampler(scene.render);
  switch (scene.render.precision) {
    case scene::Precision::kExact: compiled.precision = Precision::kExact; break;
    case scene::Precision::kFast: compiled.precision = Precision::kFast; break;
    case scene::Precision::kBook: compiled.precision = Precision::kBook; break;
  }
  switch (scene.render.shading) {
    case scene::Shading::kPath: compiled.shading = kernel::Shading::kPath; break;
    case scene::Shading::kNormal: compiled.shading = kernel::Shading::kNormal; break;
    case scene::Shading::kFlat: compiled.shading = kernel::Shading::kFlat; break;
  }
  switch (scene.render.direct_lighting) {
    case scene::DirectLighting::kMis: compiled.direct_lighting = kernel::DirectLighting::kMis; break;
    case scene::DirectLighting::kBsdf: compiled.direct_lighting = kernel::DirectLighting::kBsdf; break;
    case scene::DirectLighting::kLight: compiled.direct_lighting = kernel::DirectLighting::kLight; break;
  }
  compiled.accelerator = scene.render.accelerator;
  compiled.features.lens = scene.camera.defocus_angle > 0 || (closing != nullptr && closing->camera.defocus_angle > 0);
  const double scale = compiled.features.lens ? 1 : view_scale(scene.camera);
  compiled.camera = compile_camera(scene.camera, scene.image, scale);
  compiled.light_groups = {""};
  compiled.filter = compile_filter(scene.render);
  add_spheres(scene, compiled);
  compiled.distinct_in = scene.distinct_in;
  set_background(scene, compiled);
  light_group(compiled, scene::background_light_group(scene.background));
  const auto is_dark = [](const kernel::Material& m) { return m.kind != kernel::MaterialKind::kEmitter; };
  if (std::all_of(compiled.materials.begin(), compiled.materials.end(), is_dark)) compiled.emission.clear();
  compiled.features.lit = !compiled.emission.empty() || compiled.environment != nullptr;
  if (closing != nullptr) add_motion(scene, *closing, scale, compiled);
  update_lights(compiled);
  compiled.bounds = bounds_of(compiled.spheres);
  return compiled;
}

}  // namespace orrery::compile
