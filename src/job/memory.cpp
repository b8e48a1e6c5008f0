// SPDX-License-Identifier: Apache-2.0
#include "job/memory.h"

#include <fmt/core.h>

#include <algorithm>

#include "accel/accel.h"
#include "base/available_memory.h"
#include "base/error.h"
#include "base/text.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "film/layer_film.h"
#include "film/layer_pixel.h"
#include "film/layers.h"
#include "kernel/pixel_sum.h"
#include "scene/scene.h"

namespace orrery::job {
namespace {

using base::bytes_text;

/// Embree's user geometry during the BVH build, one primitive per sphere, in addition to the sphere itself. Measured on
/// clouds of one and three million spheres: peak_memory_bytes of --stats with embree minus that with list.
constexpr std::uint64_t kAcceleratorBytesPerSphere = 130;

/// A SphereBvh under construction, bytes per sphere: 16 for the items being sorted, up to 3 for the part of the
/// finished tree that does not yet replace them, and up to 2 for memory that has not been released yet.
constexpr std::uint64_t kBvhBytesPerSphere = 21;

/// A pixel's sum and the four floats of the finished image.
constexpr std::uint64_t kFilmBytesPerPixel = sizeof(kernel::PixelSum) + 4 * sizeof(float);

/// A layer's value and its copy for the encoder.
constexpr std::uint64_t kBytesPerLayerPlane = 2 * sizeof(float);

/// A pixel's coverage by a sphere; its vector has half as much capacity in reserve on average.
constexpr double kBytesPerShare = 1.5 * sizeof(film::SphereCoverage);

/// A pixel's layer sums, and those of its light, including heap overhead.
std::uint64_t bytes_of_sums(const MemoryNeeds& needs) {
  constexpr std::uint64_t kHeapBytes = 16, kBytesPerCell = sizeof(film::LayerPixel::light[0]);
  return (needs.records ? sizeof(film::LayerPixel) : 0) + (needs.guides ? sizeof(film::Halves) : 0) +
         (needs.light_cells > 0 ? needs.light_cells * kBytesPerCell + kHeapBytes : 0) +
         (needs.shares > 0 ? static_cast<std::uint64_t>(needs.shares * kBytesPerShare) + kHeapBytes : 0);
}

/// The expected number of spheres, or classes of spheres, that the paths of a pixel hit first: those on both sides of
/// an edge, and the share of a pixel in things smaller than itself. The only bound is the number of paths. Measured for
/// deep images of a cloud of a million spheres, by peak_memory_bytes: 0.3 to 0.95 of this.
double expected_shares(const compile::CompiledScene& compiled, const film::LayerRequest& layers) {
  if (!layers.deep && layers.mattes.empty()) return 0;
  const double things =
      static_cast<double>(layers.deep ? compiled.spheres.size() : layers.matte_classes->first_sphere.size());
  const double pixels = static_cast<double>(compiled.width) * compiled.height;
  const double seen = 2 + things / pixels;
  return std::min({things + (layers.deep ? 1 : 0), static_cast<double>(compiled.samples), seen});
}

/// Throws an error that begins with `text` if there is not enough memory.
void require(std::uint64_t needed, const std::string& text, std::uint64_t limit, std::uint64_t held) {
  const std::uint64_t allowed = limit > 0 ? limit : base::available_memory().value_or(needed) + held;
  if (needed <= allowed) return;
  const std::string rest = limit > 0 ? fmt::format("--memory-limit allows {}; raise the limit", bytes_text(allowed))
                                     : bytes_text(allowed) + " is free; free some, or override with --memory-limit";
  throw base::Error(base::ErrorKind::kNoMemory, text + ", and " + rest);
}

}  // namespace

MemoryEstimate estimate_memory(const MemoryNeeds& needs) {
  // Image; sample count and target count; with layers, the sums of their pixel; with adaptive sampling, a second sum
  // and seven numbers for the noise estimate.
  const std::uint64_t bytes_per_pixel = kFilmBytesPerPixel + needs.layer_planes * kBytesPerLayerPlane +
                                        2 * sizeof(std::uint32_t) + bytes_of_sums(needs) +
                                        (needs.is_adaptive ? sizeof(kernel::PixelSum) + 7 * sizeof(float) : 0);
  MemoryEstimate m;
  m.film = static_cast<std::uint64_t>(needs.width) * static_cast<std::uint64_t>(needs.height) * bytes_per_pixel;
  m.spheres = needs.sphere_bytes;
  m.background = needs.background;
  m.textures = needs.textures;
  m.lights = needs.lights;
  m.accelerator = needs.embree ? needs.spheres_in_bvh * kBvhBytesPerSphere +
                                     (needs.spheres - needs.spheres_in_bvh) * kAcceleratorBytesPerSphere
                               : 0;
  return m;
}

MemoryNeeds memory_needs(const compile::CompiledScene& compiled, const film::LayerRequest& layers, bool is_adaptive,
                         bool has_accelerator) {
  MemoryNeeds needs;
  needs.width = compiled.width;
  needs.height = compiled.height;
  needs.spheres = compiled.spheres.size();
  needs.embree = compiled.accelerator == compile::Accelerator::kEmbree && !has_accelerator;
  if (needs.embree) needs.spheres_in_bvh = accel::spheres_in_bvh(compiled.view());
  needs.sphere_bytes = compiled.spheres.bytes() + compiled.sphere_materials.bytes() +
                       (layers.matte_classes ? layers.matte_classes->of_sphere.bytes() : 0);
  if (compiled.environment) needs.background = compiled.environment->bytes();
  needs.textures = compiled.textures.bytes();
  needs.lights = compiled.light_tree.bytes_of_build();
  needs.layer_planes = film::planes_of(layers).size();
  needs.records = layers.records();
  needs.guides = layers.guides();
  needs.light_cells = layers.light_cells();
  needs.shares = expected_shares(compiled, layers);
  needs.is_adaptive = is_adaptive;
  return needs;
}

std::uint64_t held_memory(const MemoryNeeds& needs) { return needs.sphere_bytes + needs.background + needs.textures; }

std::string text_of(const MemoryEstimate& m) {
  std::string out = fmt::format("film {}, spheres {}, accelerator {}", bytes_text(m.film), bytes_text(m.spheres),
                                bytes_text(m.accelerator));
  if (m.background > 0) out += ", background " + bytes_text(m.background);
  if (m.textures > 0) out += ", textures " + bytes_text(m.textures);
  if (m.lights > 0) out += ", lights " + bytes_text(m.lights);
  return out;
}

void require_memory(const MemoryEstimate& needed, std::uint64_t limit, std::uint64_t held) {
  require(needed.total(), fmt::format("the render needs about {} ({})", bytes_text(needed.total()), text_of(needed)),
          limit, held);
}

void require_memory_to_compile(const scene::Scene& scene, std::uint64_t limit) {
  std::uint64_t loaded = 0;
  for (const scene::Points& points : scene.points) loaded += points.bytes();
  const std::uint64_t needed = loaded + compile::SphereStore::bytes_of(scene.points);
  require(needed, "the spheres need about " + bytes_text(needed) + " while they are compiled", limit, loaded);
}

}  // namespace orrery::job
