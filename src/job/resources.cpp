// SPDX-License-Identifier: Apache-2.0
#include "job/resources.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <fmt/core.h>

#include "accel/accel.h"
#include "accel/sphere_bvh.h"
#include "base/available_memory.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/text.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "film/layer_planes.h"
#include "film/layers.h"
#include "film/sums.h"
#include "image/format.h"
#include "kernel/isa.h"
#include "math/pixels.h"
#include "render/render.h"
#include "render/seen_emitters.h"
#include "scene/scene.h"

namespace orrery::job {
namespace {

/// Threads that a scheduler grants; 0 if the variable is unset or not a positive integer.
int granted_by(const char* variable) {
  const char* const text = std::getenv(variable);
  return text != nullptr ? std::max(base::number_of<int>(text).value_or(0), 0) : 0;
}

using base::bytes_text;

/// Embree's user geometry during the BVH build, one primitive per sphere, in addition to the sphere itself. Measured on
/// clouds of one and three million spheres: peak_memory_bytes of --stats with embree minus that with list.
constexpr std::uint64_t kAcceleratorBytesPerSphere = 130;

/// A layer's value and its copy for the encoder.
constexpr std::uint64_t kBytesPerLayerPlane = 2 * sizeof(float);

/// A pixel's coverage by a sphere; its vector has half as much capacity in reserve on average.
constexpr double kBytesPerShare = 1.5 * sizeof(film::SphereCoverage);

/// The expected number of spheres, or classes of spheres, that the paths of a pixel hit first: those on both sides of
/// an edge, and the share of a pixel in things smaller than itself. The only bound is the number of paths. Measured for
/// deep images of a cloud of a million spheres, by peak_memory_bytes: 0.3 to 0.95 of this.
double expected_shares(const compile::CompiledScene& compiled, const film::LayerRequest& layers) {
  if (!layers.deep && layers.mattes.empty()) return 0;
  const double things =
      static_cast<double>(layers.deep ? compiled.object_materials.size() : layers.matte_classes->first_sphere.size());
  const double pixels = static_cast<double>(compiled.width) * compiled.height;
  const double seen = 2 + things / pixels;
  return std::min({things + (layers.deep ? 1 : 0), static_cast<double>(compiled.samples), seen});
}

/// Bytes of a pixel's sums while it is rendered, or of its sums and values when the image is finished; the mean of all
/// pixels.
double film_bytes_per_pixel(const compile::CompiledScene& compiled, const film::LayerRequest& layers,
                            const MemoryUse& use) {
  constexpr double kHeapBytes = 16;
  const film::Sums pixel(1, 1, layers, use.is_adaptive);
  const double shares = expected_shares(compiled, layers);
  double light = 0;  // sums that take no memory in empty pixels, and none when they are finished unless they are kept
  for (const auto& half : pixel.light) light += static_cast<double>(half.size() * sizeof(half[0]));
  for (const auto& half : pixel.guides) light += static_cast<double>(half.size() * sizeof(half[0]));
  const double others =
      static_cast<double>(pixel.bytes()) - light + (shares > 0 ? shares * kBytesPerShare + kHeapBytes : 0);
  light *= use.share_with_objects;
  // The target count; with adaptive sampling, eight numbers for the noise estimate.
  const double rendered = others + light + sizeof(std::uint32_t) + (use.is_adaptive ? 8 * sizeof(float) : 0);
  const double planes = static_cast<double>(4 * sizeof(float) + film::planes_of(layers).size() * kBytesPerLayerPlane);
  return std::max(rendered, others + planes + (use.keeps_sums ? light : 0));
}

std::uint64_t allowed_memory(std::uint64_t needed, std::uint64_t limit, std::uint64_t held) {
  return limit > 0 ? limit : base::available_memory().value_or(needed) + held;
}

/// Throws an error that begins with `text` if there is not enough memory.
void require(std::uint64_t needed, const std::string& text, std::uint64_t limit, std::uint64_t held) {
  const std::uint64_t allowed = allowed_memory(needed, limit, held);
  if (needed <= allowed) return;
  const std::string rest = limit > 0 ? fmt::format("--memory-limit allows {}; raise the limit", bytes_text(allowed))
                                     : bytes_text(allowed) + " is free; free some, or override with --memory-limit";
  throw base::Error(base::ErrorKind::kNoMemory, text + ", and " + rest);
}

// Measured on the book's final scene, 480 x 270, at 4 samples per pixel, and rounded up: noise compresses worst.

/// Compressed size of an EXR channel as a fraction of its size in memory.
double compressed_fraction(const std::string& compression, bool is_float) {
  if (compression == "none") return 1;
  if (compression == "rle") return is_float ? 0.9 : 0.65;
  if (compression.starts_with("dwa")) return 0.3;
  return is_float ? 0.7 : 0.5;
}

/// Bytes per pixel: of a shard with its preview, of the layers of a shard, of a light group in it, of deep samples. A
/// light group with light in one lobe per pixel takes 39 bytes.
constexpr double kShardBytes = 27, kShardLayerBytes = 130, kShardLightGroupBytes = 40, kDeepBytes = 24;

double bytes_per_pixel(const Job& job, image::Format format, const film::LayerRequest& layers) {
  const image::ExrOptions& exr = job.outputs.exr;
  if (format != image::Format::kExr) {
    const image::FormatInfo& info = image::info_of(format);
    return job.outputs.bits == 16 ? info.bytes_per_pixel_16 : info.bytes_per_pixel;
  }
  const std::vector<film::Plane> planes = film::planes_of(layers);
  if (is_shard(job))
    return kShardBytes + (planes.empty() ? 0 : kShardLayerBytes) +
           (layers.light_groups ? kShardLightGroupBytes * static_cast<double>(layers.groups.size()) : 0);
  const double as_float = 4 * compressed_fraction(exr.compression, true);
  const double as_stored = exr.as_float ? as_float : 2 * compressed_fraction(exr.compression, false);
  double bytes = 4 * as_stored;  // R, G, B, A
  for (const film::Plane& plane : planes) bytes += plane.kind == film::PlaneKind::kData ? as_float : as_stored;
  return bytes;
}

}  // namespace

int default_threads(const std::filesystem::path& root) {
  int threads = std::max(1, render::available_threads());
  if (const auto granted = base::granted_cpus(root)) threads = std::min(threads, *granted);
  for (const char* variable : {"SLURM_CPUS_PER_TASK", "CUE_THREADS"})
    if (const int granted = granted_by(variable); granted > 0) threads = std::min(threads, granted);
  return threads;
}

int thread_count(int requested) { return requested > 0 ? requested : default_threads(); }

void choose_isa() {
  const char* const isa = std::getenv("ORRERY_ISA");
  if (!kernel::limit_isa(isa != nullptr ? isa : ""))
    base::refuse(
        fmt::format("$ORRERY_ISA: instruction set {} is not available; this processor and program have {} (a "
                    "build with -DORRERY_ISAS=all has all)",
                    isa, base::joined(kernel::available_isas())));
}

MemoryEstimate estimate_memory(const compile::CompiledScene& compiled, const film::LayerRequest& layers,
                               const MemoryUse& use) {
  MemoryEstimate m;
  m.film = static_cast<std::uint64_t>(static_cast<double>(math::pixel_count(compiled.width, compiled.height)) *
                                      film_bytes_per_pixel(compiled, layers, use));
  m.spheres = compiled.spheres.bytes() + compiled.motion.size() * sizeof(kernel::Sphere) +
              (compiled.rods.size() + compiled.rod_motion.size()) * sizeof(kernel::Rod) +
              compiled.bonds.size() * sizeof(kernel::Bond) + compiled.object_materials.bytes() +
              compiled.opacity.size() * sizeof(compiled.opacity[0]) +
              (layers.matte_classes ? layers.matte_classes->of_sphere.bytes() : 0);
  if (compiled.environment) m.background = compiled.environment->bytes();
  m.textures = compiled.textures.bytes();
  m.lights =
      compiled.light_tree.bytes_of_build() + compiled.caustics.bytes() +
      render::SeenEmitterList::bytes_of_build(compiled.view(), compiled.precision, compiled.width, compiled.height);
  if (compiled.accelerator == compile::Accelerator::kEmbree && !use.has_accelerator) {
    const accel::ObjectCounts in_bvh = accel::objects_in_bvh(compiled.view());
    const std::uint64_t outside = compiled.spheres.size() + compiled.rod_count() - in_bvh.all();
    m.accelerator =
        (in_bvh.all() > 0 ? accel::SphereBvh::bytes_of_build(in_bvh) : 0) + outside * kAcceleratorBytesPerSphere;
  }
  return m;
}

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

void require_memory(const compile::CompiledScene& compiled, const film::LayerRequest& layers, MemoryUse use,
                    std::uint64_t limit, int threads) {
  MemoryEstimate needed = estimate_memory(compiled, layers, use);
  if (needed.total() > allowed_memory(needed.total(), limit, needed.held())) {
    use.share_with_objects = render::share_with_objects(compiled, layers, threads);
    needed = estimate_memory(compiled, layers, use);
  }
  require_memory(needed, limit, needed.held());
}

void require_memory_to_compile(const scene::Scene& scene, std::uint64_t limit) {
  std::uint64_t loaded = 0;
  for (const scene::Points& points : scene.points) loaded += points.bytes();
  for (const scene::RodFile& rods : scene.rod_files) loaded += rods.bytes();
  const std::uint64_t needed =
      loaded + compile::SphereStore::bytes_of_replacing(scene.points) + scene.rod_count() * sizeof(kernel::Rod);
  require(needed, "the spheres need about " + bytes_text(needed) + " while they are compiled", limit, loaded);
}

std::map<std::filesystem::path, double> estimate_disk_space(const Job& job, int width_px, int height_px,
                                                            const film::LayerRequest& layers) {
  const double pixels = static_cast<double>(width_px) * height_px;
  std::map<std::filesystem::path, double> needed;
  for (const auto& [file, format] : job.outputs.images)
    needed[base::folder_of(file)] += pixels * bytes_per_pixel(job, format, layers);
  if (!job.outputs.deep.empty()) needed[base::folder_of(job.outputs.deep)] += pixels * kDeepBytes;
  return needed;
}

void require_disk_space(const Job& job, int width_px, int height_px, const film::LayerRequest& layers) {
  const std::uint64_t limit = job.resources.disk_limit;
  for (const auto& [folder, bytes] : estimate_disk_space(job, width_px, height_px, layers)) {
    std::error_code failed;
    const std::filesystem::space_info space = std::filesystem::space(folder, failed);
    const std::uint64_t allowed = limit > 0 ? limit : space.available;
    if ((failed && limit == 0) || static_cast<double>(allowed) >= bytes) continue;
    const std::string need = base::bytes_text(static_cast<std::uint64_t>(bytes));
    throw base::Error(
        base::ErrorKind::kCannotCreate,
        limit > 0
            ? fmt::format("the images need about {}, but --disk-limit allows only {}; raise the limit", need,
                          base::bytes_text(allowed))
            : fmt::format("the images need about {}, and {} has {} free; free some, or override with --disk-limit",
                          need, folder.string(), base::bytes_text(allowed)));
  }
}

}  // namespace orrery::job
