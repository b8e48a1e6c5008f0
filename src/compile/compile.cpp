// SPDX-License-Identifier: Apache-2.0
#include "compile/compile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <unordered_map>

#include "compile/camera_basis.h"
#include "compile/daylight.h"
#include "compile/light_tree.h"
#include "compile/pixel_filter.h"
#include "kernel/sobol_columns.h"
#include "scene/layers.h"

namespace orrery::compile {
namespace {

using math::Vec3d;

void set(double (&to)[3], Vec3d from) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

/// Returns R0 of Schlick's approximation, the reflectance at normal incidence, for a ratio of refractive indices.
double normal_reflectance(double eta) {
  const double r = (1 - eta) / (1 + eta);
  return r * r;
}

kernel::Material compile_model(const scene::Lambertian& m) {
  kernel::Material out;
  out.kind = kernel::MaterialKind::kLambertian;
  set(out.albedo, m.albedo);
  return out;
}
kernel::Material compile_model(const scene::Hemisphere& m) {
  kernel::Material out;
  out.kind = kernel::MaterialKind::kHemisphere;
  set(out.albedo, m.albedo);
  return out;
}
kernel::Material compile_model(const scene::Metal& m) {
  kernel::Material out;
  out.kind = kernel::MaterialKind::kMetal;
  set(out.albedo, m.albedo);
  out.fuzz = m.fuzz;
  return out;
}
kernel::Material compile_model(const scene::Dielectric& m) {
  kernel::Material out;
  out.kind = kernel::MaterialKind::kDielectric;
  out.eta[0] = 1 / m.ior;
  out.eta[1] = m.ior;
  out.r0[0] = normal_reflectance(out.eta[0]);
  out.r0[1] = normal_reflectance(out.eta[1]);
  out.fuzz = m.fuzz;
  switch (m.fresnel) {
    case scene::Fresnel::kSchlick: out.fresnel = kernel::FresnelKind::kSchlick; break;
    case scene::Fresnel::kExact: out.fresnel = kernel::FresnelKind::kExact; break;
    case scene::Fresnel::kNone: out.fresnel = kernel::FresnelKind::kNone; break;
  }
  return out;
}

kernel::Material compile_model(const scene::Emitter&) {
  kernel::Material out;
  out.kind = kernel::MaterialKind::kEmitter;
  set(out.albedo, {0, 0, 0});
  return out;
}

/// Returns the number of a light group, and adds the group if it is new.
std::uint16_t light_group(CompiledScene& compiled, const std::string& name) {
  if (name == scene::kDefaultLightGroup) return 0;
  std::vector<std::string>& names = compiled.light_groups;
  const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  if (index == names.size()) names.push_back(name);
  return static_cast<std::uint16_t>(index);
}

/// Precision  rounded from long double, so that it does not depend on the math library
double stops_to_factor(double stops) { return static_cast<double>(std::exp2(static_cast<long double>(stops))); }

kernel::Emission emission_of(const scene::MaterialModel& model, CompiledScene& compiled) {
  const auto* emitter = std::get_if<scene::Emitter>(&model);
  if (emitter == nullptr) return {};
  kernel::Emission out;
  set(out.radiance, emitter->radiance * stops_to_factor(emitter->exposure));
  out.group = light_group(compiled, emitter->light_group);
  return out;
}

/// Compiles the textures of a material, and sets the constants that they replace to their means.
void set_textures(const scene::MaterialModel& model, CompiledScene& compiled, kernel::Material& material,
                  kernel::Emission& emission) {
  TextureStore& store = compiled.textures;
  kernel::MaterialTextures out;
  std::visit(
      [&](const auto& m) {
        if constexpr (requires { m.albedo_texture; })
          if (m.albedo_texture) {
            out.albedo = store.add(*m.albedo_texture);
            set(material.albedo, mean_of(*m.albedo_texture));
          }
        if constexpr (requires { m.fuzz_texture; })
          if (m.fuzz_texture) {
            out.fuzz = store.add(*m.fuzz_texture);
            material.fuzz = mean_of(*m.fuzz_texture).x;
          }
        if constexpr (requires { m.radiance_texture; })
          if (m.radiance_texture) {
            const double factor = stops_to_factor(m.exposure);
            out.radiance = store.add(*m.radiance_texture, {factor, factor, factor});
            set(emission.radiance, mean_of(*m.radiance_texture) * factor);
          }
      },
      model);
  store.add_material(out);
  if (!store.textures().empty() || (material.kind == kernel::MaterialKind::kDielectric && material.fuzz > 0))
    compiled.features.extended = true;
}

/// Returns the material for a sphere whose normal points inward: its inside and outside are exchanged.
kernel::Material turned_inside_out(kernel::Material m) {
  std::swap(m.eta[0], m.eta[1]);
  std::swap(m.r0[0], m.r0[1]);
  return m;
}

/// Compiles materials on first use, so that unused ones are left out.
class MaterialTable {
 public:
  MaterialTable(const scene::Scene& scene, CompiledScene& compiled)
      : scene_(scene), out_(compiled), compiled_(scene.materials.size(), {kNone, kNone}) {}

  /// Returns the index of a material whose colour is replaced by one of a palette.
  std::uint32_t colored_index(std::uint32_t authored, bool inside_out, std::size_t points, std::uint16_t color,
                              Vec3d rgb) {
    const std::uint32_t plain = index(authored, inside_out);
    if (out_.materials[plain].kind == kernel::MaterialKind::kDielectric) return plain;  // has no colour
    const std::uint64_t key = (std::uint64_t{plain} << 32 | points << 16) | color;
    const auto [at, is_new] = colored_.try_emplace(key, static_cast<std::uint32_t>(out_.materials.size()));
    if (!is_new) return at->second;
    kernel::Material m = out_.materials[plain];
    kernel::Emission e = out_.emission[plain];
    kernel::MaterialTextures textures = out_.textures.material(plain);
    if (m.kind == kernel::MaterialKind::kEmitter) {
      for (int k = 0; k < 3; ++k) e.radiance[k] *= k == 0 ? rgb.x : k == 1 ? rgb.y : rgb.z;
      if (textures.radiance != kernel::MaterialTextures::kNone)
        textures.radiance = out_.textures.add_scaled(textures.radiance, rgb);
    } else {
      set(m.albedo, rgb);
      textures.albedo = kernel::MaterialTextures::kNone;
    }
    out_.materials.push_back(m);
    out_.emission.push_back(e);
    out_.textures.add_material(textures);
    return at->second;
  }

  std::uint32_t index(std::uint32_t authored, bool inside_out) {
    std::uint32_t& at = compiled_[authored][inside_out ? 1 : 0];
    if (at != kNone) return at;
    kernel::Material m =
        std::visit([](const auto& model) { return compile_model(model); }, scene_.materials[authored].model);
    // Only dielectrics have two different sides; other materials are the same from both.
    if (inside_out && m.kind != kernel::MaterialKind::kDielectric) return at = index(authored, false);
    if (inside_out) m = turned_inside_out(m);
    at = static_cast<std::uint32_t>(out_.materials.size());
    kernel::Emission emission = emission_of(scene_.materials[authored].model, out_);
    set_textures(scene_.materials[authored].model, out_, m, emission);
    out_.materials.push_back(m);
    out_.emission.push_back(emission);
    if (m.kind == kernel::MaterialKind::kHemisphere) out_.features.hemisphere = true;
    return at;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  const scene::Scene& scene_;
  CompiledScene& out_;
  std::vector<std::array<std::uint32_t, 2>> compiled_;
  std::unordered_map<std::uint64_t, std::uint32_t> colored_;  ///< by plain material, points table and colour
};

kernel::Sphere sphere_of(Vec3d center, double radius) { return {center.x, center.y, center.z, std::abs(radius)}; }

void add_spheres(const scene::Scene& scene, CompiledScene& compiled) {
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
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const kernel::Sphere s = spheres[i];
    b.lower = {std::min(b.lower.x, s.x - s.radius), std::min(b.lower.y, s.y - s.radius),
               std::min(b.lower.z, s.z - s.radius)};
    b.upper = {std::max(b.upper.x, s.x + s.radius), std::max(b.upper.y, s.y + s.radius),
               std::max(b.upper.z, s.z + s.radius)};
  }
  return b;
}

/// Adds the motion of the camera and of [[sphere]] tables from shutter open to shutter close.
void add_motion(const scene::Scene& opening, const scene::Scene& closing, CompiledScene& compiled) {
  for (std::size_t i = opening.spheres.size(); i-- > 0;) {
    const scene::Sphere &from = opening.spheres[i], &to = closing.spheres[i];
    const Vec3d displacement = to.center - from.center;
    const kernel::Sphere change{displacement.x, displacement.y, displacement.z,
                                std::abs(to.radius) - std::abs(from.radius)};
    const bool rests = change.x == 0 && change.y == 0 && change.z == 0 && change.radius == 0;
    if (compiled.motion.empty() && !rests) compiled.motion.resize(i + 1, kernel::Sphere{0, 0, 0, 0});
    if (!rests) compiled.motion[i] = change;
  }
  const kernel::Camera last = compile_camera(closing.camera, closing.image);
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

EnvironmentSampling sampling_of(scene::DirectLighting lighting) {
  switch (lighting) {
    case scene::DirectLighting::kMis: return EnvironmentSampling::kCompensated;
    case scene::DirectLighting::kBsdf: return EnvironmentSampling::kNone;
    case scene::DirectLighting::kLight: return EnvironmentSampling::kComplete;
  }
  return EnvironmentSampling::kNone;
}

/// Compiles an image background or a sky; without one, the gradient or constant colour.
void set_background(const scene::Scene& scene, CompiledScene& compiled) {
  const scene::Background& from = scene.background;
  std::shared_ptr<const scene::EnvironmentImage> image = from.image;
  if (!image && from.type == scene::BackgroundType::kSky)
    image = std::make_shared<const scene::EnvironmentImage>(bake_sky(from));
  if (image) {
    EnvironmentSettings settings;
    settings.rotation = from.rotation;
    settings.scale = stops_to_factor(from.exposure);
    settings.sampling = sampling_of(scene.render.direct_lighting);
    settings.light_group = light_group(compiled, from.light_group);
    settings.visible = from.visible;
    compiled.environment = std::make_shared<const EnvironmentMap>(image, settings);
    set(compiled.background.bottom, {0, 0, 0});
    set(compiled.background.top, {0, 0, 0});
    return;
  }
  const bool gradient = from.type == scene::BackgroundType::kGradient;
  set(compiled.background.bottom, gradient ? from.bottom : from.color);
  set(compiled.background.top, gradient ? from.top : from.color);
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
  }
  v.lights = light_tree.view();
  v.direct_lighting = direct_lighting;
  v.motion = motion.data();
  v.moving_count = motion.size();
  v.camera_motion = camera_motion;
  v.camera = camera;
  v.background = background;
  v.environment = environment ? &environment->view() : nullptr;
  v.background_visible = !environment || environment->view().visible;
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
  compiled.accelerator = scene.render.accelerator;
  compiled.camera = compile_camera(scene.camera, scene.image);
  compiled.features.lens = scene.camera.defocus_angle > 0 || (closing != nullptr && closing->camera.defocus_angle > 0);
  compiled.light_groups = {""};
  compiled.filter = compile_filter(scene.render);
  add_spheres(scene, compiled);
  set_background(scene, compiled);
  light_group(compiled, scene::background_light_group(scene.background));
  const auto is_dark = [](const kernel::Material& m) { return m.kind != kernel::MaterialKind::kEmitter; };
  if (std::all_of(compiled.materials.begin(), compiled.materials.end(), is_dark)) compiled.emission.clear();
  compiled.features.lit = !compiled.emission.empty() || compiled.environment != nullptr;
  if (closing != nullptr) add_motion(scene, *closing, compiled);
  switch (scene.render.direct_lighting) {
    case scene::DirectLighting::kMis: compiled.direct_lighting = kernel::DirectLighting::kMis; break;
    case scene::DirectLighting::kBsdf: compiled.direct_lighting = kernel::DirectLighting::kBsdf; break;
    case scene::DirectLighting::kLight: compiled.direct_lighting = kernel::DirectLighting::kLight; break;
  }
  if (!compiled.emission.empty() && compiled.direct_lighting != kernel::DirectLighting::kBsdf)
    compiled.light_tree = build_light_tree(compiled.view());
  compiled.bounds = bounds_of(compiled.spheres);
  return compiled;
}

}  // namespace orrery::compile
