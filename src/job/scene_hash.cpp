// SPDX-License-Identifier: Apache-2.0
#include "job/scene_hash.h"

#include <algorithm>
#include <cstring>

#include "base/hash.h"
#include "base/stop_point.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"

namespace orrery::job {
namespace {

using base::Hash;

template <std::size_t N>
void add_all(Hash& hash, const double (&values)[N]) {
  for (const double v : values) hash.add(v);
}

void add_all(Hash& hash, const math::Vec3d& v) {
  for (const double x : {v.x, v.y, v.z}) hash.add(x);
}

/// `texels`   see kernel::Environment
void add_texels(Hash& hash, const float* texels, std::uint32_t width, std::uint32_t height) {
  // Two values per word.
  const std::size_t count = 3 * std::size_t{width} * height;
  for (std::size_t i = 0; i < count; i += 2) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, texels + i, std::min<std::size_t>(2, count - i) * sizeof(float));
    hash.add_bits(bits);
  }
}

void add_map(Hash& hash, const kernel::Environment& map) {
  for (const double v : {double(map.width), double(map.height), map.scale, map.turn, map.visible ? 1.0 : 0.0,
                         double(map.light_group), map.sun_one_minus_cos})
    hash.add(v);
  add_all(hash, map.sun);
  add_all(hash, map.sun_radiance);
  add_texels(hash, map.texels, map.width, map.height);
}

/// Adds everything about lights. Scenes without lights keep the hash that they had before there were lights, and
/// those without pairs of balls and lights the one from before caustics were sampled.
void add_lights(Hash& hash, const compile::CompiledScene& compiled) {
  if (compiled.emission.empty() && !compiled.environment) return;
  hash.add_bits(static_cast<std::uint64_t>(compiled.direct_lighting));
  for (const kernel::Emission& e : compiled.emission) {
    add_all(hash, e.radiance);
    hash.add(e.group);
  }
  if (compiled.environment) add_map(hash, compiled.environment->view());
  if (compiled.features.caustics) hash.add_bits(compiled.caustics.balls.size());
}

/// Scenes without textures keep the hash that they had before there were textures.
void add_textures(Hash& hash, const compile::TextureStore& store) {
  if (store.textures().empty()) return;
  for (const kernel::MaterialTextures& m : store.materials()) {
    hash.add_bits(std::uint64_t{m.albedo} << 32 | m.fuzz);
    hash.add_bits(m.radiance);
  }
  for (const kernel::Texture& t : store.textures()) {
    hash.add_bits(static_cast<std::uint64_t>(t.kind) << 32 | t.seed);
    hash.add(t.scale);
    add_all(hash, t.low);
    add_all(hash, t.high);
    if (t.image == nullptr) continue;
    const kernel::TextureLevel& image = t.image->levels[0];
    for (const double v : {double(image.width), double(image.height), t.image->turn}) hash.add(v);
    if (t.image->level_count > 1) hash.add(compile::kConeWidth);
    add_texels(hash, image.texels, image.width, image.height);
  }
}

}  // namespace

void add_motion(Hash& hash, const std::vector<kernel::Sphere>& spheres, const std::vector<kernel::Rod>& rods,
                const kernel::Camera& camera) {
  for (const kernel::Sphere& s : spheres)
    for (const double v : {s.x, s.y, s.z, s.radius}) hash.add(v);
  for (const kernel::Rod& r : rods) {
    add_all(hash, r.a);
    add_all(hash, r.b);
    hash.add(r.radius);
  }
  for (const auto vector : kernel::kCameraVectors) add_all(hash, camera.*vector);
}

Hash hash_of_spheres(const compile::CompiledScene& compiled) {
  Hash hash;
  hash.add_bits(compiled.spheres.size());
  const base::StopPoint stop;
  for (std::size_t i = 0; i < compiled.spheres.size(); ++i) {
    stop.check(i);
    for (const kernel::Sphere s = compiled.spheres[i]; const double v : {s.x, s.y, s.z, s.radius}) hash.add(v);
  }
  const kernel::RodArray rods = compiled.view().rods;
  for (std::size_t i = 0; i < rods.count; ++i) {
    stop.check(i);
    const kernel::Rod r = rods[i];
    add_all(hash, r.a);
    add_all(hash, r.b);
    hash.add(r.radius);
  }
  for (std::size_t i = 0; i < compiled.object_materials.size(); ++i) hash.add_bits(compiled.object_materials[i]);
  for (const float opacity : compiled.opacity) hash.add(opacity);
  return hash;
}

SceneHashes scene_hashes(const compile::CompiledScene& compiled, Hash hash) {
  hash.add_bits(compiled.materials.size());
  for (const kernel::Material& m : compiled.materials) {
    add_all(hash, m.albedo);
    add_all(hash, m.eta);
    hash.add(m.fuzz);
    hash.add_bits(static_cast<std::uint64_t>(m.kind) << 32 | static_cast<std::uint64_t>(m.fresnel));
  }
  const kernel::Camera& c = compiled.camera;
  hash.add(c.half_width);
  hash.add(c.half_height);
  if (c.is_orthographic) hash.add_bits(1);  // others keep the hash that they had before there was a choice
  for (const auto vector : kernel::kCameraVectors) add_all(hash, c.*vector);
  if (compiled.features.motion) {
    add_motion(hash, compiled.motion, compiled.rod_motion, compiled.camera_motion);
  }
  add_all(hash, compiled.background.bottom);
  add_all(hash, compiled.background.top);
  if (compiled.page != kernel::kNone) hash.add_bits(compiled.page);
  if (!(compiled.background.up == math::Vec3d{0, 1, 0})) add_all(hash, compiled.background.up);
  if (compiled.features.depth_cue) {
    for (const kernel::DepthCue& cue : {compiled.depth_cue, compiled.page_fade}) {
      add_all(hash, cue.slope);
      hash.add(cue.offset);
      hash.add(cue.strength);
    }
  }
  if (compiled.backdrop) add_all(hash, *compiled.backdrop);  // others keep the hash that they had before there was one
  for (const std::uint64_t v :
       {std::uint64_t(compiled.width), std::uint64_t(compiled.height), std::uint64_t{compiled.max_depth},
        std::uint64_t{compiled.roulette_depth}, std::uint64_t{compiled.sampler.seed},
        std::uint64_t(compiled.sampler.kind), std::uint64_t(compiled.shading), std::uint64_t(compiled.precision)})
    hash.add_bits(v);
  for (const double v : compiled.filter) hash.add(v);
  add_lights(hash, compiled);
  add_textures(hash, compiled.textures);
  SceneHashes out;
  out.of_samples = hash.text();
  hash.add_bits(static_cast<std::uint64_t>(compiled.samples));
  out.of_image = hash.text();
  return out;
}

}  // namespace orrery::job
