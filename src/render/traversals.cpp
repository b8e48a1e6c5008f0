// SPDX-License-Identifier: Apache-2.0
#include "render/traversals.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "compile/compiled_scene.h"
#include "kernel/path_stream.h"
#include "kernel/render_tile.h"
#include "render/recorded_rays.h"

namespace orrery::render {
namespace {

/// A trial path costs about five ordinary ones: it is rendered, and its rays are traced twice by each traversal.
constexpr double kTrialShare = 0.002;
constexpr double kMaxTrialPaths = 32 * 1024;

/// Fewer tiles than this would sample only a corner of the image.
constexpr std::size_t kMinTrialTiles = 4;

/// Larger BVHs are not compared with one primitive per sphere: building these would take longer than they could gain.
constexpr std::size_t kMaxCompared = 100'000;

/// Every n-th tile of the trial of traversals is in that of structures, which traces each ray four times.
constexpr std::size_t kStructureStride = 4;

/// Number of spheres above which, without a trial, secondary rays are assumed to be too incoherent for packets.
constexpr std::size_t kManySpheres = 1000;

/// A deterministic set of tiles, spread over the image. Each fills a whole path stream; otherwise packets of secondary
/// rays would be less full than in a render. As in a render, a packet of camera rays spans as many pixels as it needs.
std::vector<kernel::Tile> trial_tiles(const compile::CompiledScene& compiled) {
  const double paths = static_cast<double>(compiled.width) * compiled.height * compiled.samples;
  const int count = static_cast<int>(std::min(paths * kTrialShare, kMaxTrialPaths) / kernel::kStreamSize);
  const int samples = std::min(compiled.samples, kernel::kPacketSize);
  const int width = std::min(kernel::kStreamSize / samples, compiled.width);
  std::vector<kernel::Tile> tiles;
  if (count < static_cast<int>(kMinTrialTiles)) return tiles;
  for (int i = 0; i < count; ++i) {
    kernel::Tile tile;
    // Evenly spaced vertically, and horizontally by multiples of the golden ratio, which spread well.
    const double across = 0.6180339887498949 * i;
    tile.x = static_cast<int>((across - static_cast<int>(across)) * (compiled.width - width + 1));
    tile.y = static_cast<int>((i + 0.5) / count * compiled.height);
    tile.width = width;
    tile.height = 1;
    tile.sample_end = static_cast<std::uint32_t>(samples);
    tiles.push_back(tile);
  }
  return tiles;
}

/// The faster traversal for these packets, each by the better of two alternating runs.
template <class Packet>
accel::Traversal faster_traversal(accel::Accel& accel, std::vector<Packet>& packets) {
  double best[2] = {1e300, 1e300};
  for (int i = 0; i < 4; ++i) {
    const auto traversal = static_cast<accel::Traversal>(i % 2);
    accel.use({traversal, traversal});
    best[i % 2] = std::min(best[i % 2], trace_again(accel.tracer(), packets));
  }
  return best[1] < best[0] ? accel::Traversal::kSingle : accel::Traversal::kPacket;
}

template <class Packet>
accel::Traversals faster_traversal(accel::Accel& accel, RecordedRays<Packet> rays) {
  return {faster_traversal(accel, rays.camera), faster_traversal(accel, rays.secondary)};
}

/// Seconds to trace the packets once more, by the faster traversal.
template <class Packet>
double best_seconds(accel::Accel& accel, std::vector<Packet>& packets) {
  double best = 1e300;
  for (const auto traversal : {accel::Traversal::kPacket, accel::Traversal::kSingle}) {
    accel.use({traversal, traversal});
    best = std::min(best, trace_again(accel.tracer(), packets));
  }
  return best;
}

/// Returns whether `accel` traces these rays faster than `other`, each by its faster traversals.
template <class Packet>
bool is_faster(accel::Accel& accel, accel::Accel& other, RecordedRays<Packet> rays) {
  const auto seconds = [&](accel::Accel& a) { return best_seconds(a, rays.camera) + best_seconds(a, rays.secondary); };
  return seconds(accel) < seconds(other);
}

accel::Traversals unmeasured(const compile::CompiledScene& compiled) {
  const bool many = compiled.spheres.size() >= kManySpheres;
  return {accel::Traversal::kPacket, many ? accel::Traversal::kSingle : accel::Traversal::kPacket};
}

const char* name_of(accel::Traversal traversal) { return traversal == accel::Traversal::kPacket ? "packet" : "single"; }

}  // namespace

accel::Traversals choose_traversals(const compile::CompiledScene& compiled, accel::Accel& accel,
                                    std::optional<accel::Traversal> requested) {
  if (requested) return {*requested, *requested};
  if (compiled.accelerator == compile::Accelerator::kList) return unmeasured(compiled);
  const std::vector<kernel::Tile> tiles = trial_tiles(compiled);
  if (tiles.empty()) return unmeasured(compiled);
  accel.use(unmeasured(compiled));
  return compiled.precision == compile::Precision::kFast
             ? faster_traversal(accel, record_rays_fast(compiled.view(), accel, tiles))
             : faster_traversal(accel, record_rays(compiled.view(), accel, compiled.precision, tiles));
}

std::unique_ptr<accel::Accel> build_embree(const compile::CompiledScene& compiled, const accel::BuildMonitor& monitor) {
  std::unique_ptr<accel::Accel> bvh = accel::make_embree(compiled.view(), compiled.precision, monitor);
  const std::size_t many = accel::spheres_in_bvh(compiled.view());
  if (many == 0 || many > kMaxCompared) return bvh;
  const std::vector<kernel::Tile> all = trial_tiles(compiled);
  if (all.size() < kMinTrialTiles * kStructureStride) return bvh;
  std::vector<kernel::Tile> tiles;
  for (std::size_t i = kStructureStride / 2; i < all.size(); i += kStructureStride) tiles.push_back(all[i]);
  // The second build can be cancelled as well, but has no progress to report.
  const accel::BuildMonitor go_on = [&monitor](double) { return !monitor || monitor(1); };
  std::unique_ptr<accel::Accel> separate =
      accel::make_embree(compiled.view(), compiled.precision, go_on, accel::kNoBvh);
  const bool is_separate_faster =
      compiled.precision == compile::Precision::kFast
          ? is_faster(*separate, *bvh, record_rays_fast(compiled.view(), *bvh, tiles))
          : is_faster(*separate, *bvh, record_rays(compiled.view(), *bvh, compiled.precision, tiles));
  return is_separate_faster ? std::move(separate) : std::move(bvh);
}

std::string planned_traversal(const compile::CompiledScene& compiled) {
  if (compiled.accelerator == compile::Accelerator::kList || compiled.spheres.empty()) return "list";
  return trial_tiles(compiled).empty() ? name_of(unmeasured(compiled))
                                       : "packet or single, chosen by a trial of the scene's rays";
}

std::string name_of(accel::Traversals traversals) {
  const std::string camera = name_of(traversals.camera);
  return traversals.camera == traversals.secondary ? camera : camera + ", secondary " + name_of(traversals.secondary);
}

}  // namespace orrery::render
