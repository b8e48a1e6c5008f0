// SPDX-License-Identifier: Apache-2.0
// The path loop. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_RENDER_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_RENDER_TILE_INL_H_
#undef ORRERY_KERNEL_RENDER_TILE_INL_H_
#else
#define ORRERY_KERNEL_RENDER_TILE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "kernel/camera-inl.h"
#include "kernel/caustic_rays-inl.h"
#include "kernel/render_tile.h"
#include "kernel/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Enumerates a tile's paths: all samples of a pixel, then the next pixel, so that the rays of a packet are coherent.
class PathCounter {
 public:
  PathCounter(const Tile& tile, const SceneView& scene)
      : tile_(tile), scene_(scene), sample_(tile.sample_begin), place_(tile.pixel(0)) {}

  template <class Id>
  void take(Id& pixel, Id& sample) {
    const std::uint32_t x = static_cast<std::uint32_t>(tile_.x + place_.x) + scene_.window_x;
    const std::uint32_t y = static_cast<std::uint32_t>(tile_.y + place_.y) + scene_.window_y;
    pixel = static_cast<Id>(y << 16 | (x & 0xffff));
    sample = static_cast<Id>(sample_);
    if (++sample_ < tile_.sample_end) return;
    sample_ = tile_.sample_begin;
    if (++pixel_ < tile_.pixel_count()) place_ = tile_.pixel(pixel_);
  }

 private:
  const Tile& tile_;
  const SceneView& scene_;
  std::uint32_t sample_;
  int pixel_ = 0;
  PixelPlace place_;
};

/// Fills the packet with the camera rays of the next paths.
///
/// `records`  records paths
template <class D, Loop kLoop, class Packet, class Carried>
HWY_INLINE void load_camera_rays(D d, const SceneView& scene, bool records, PathCounter& counter, int count,
                                 Packet& packet, Carried& carried) {
  const Features features = features_of<kLoop>(scene);
  using T = hn::TFromD<D>;
  using Id = IdOf<T>;
  const IdTag<D> du;
  for (int i = 0; i < count; ++i) counter.take(carried.pixel[i], carried.sample[i]);
  for (int i = count; i < kPacketSize; ++i) {  // pads the packet, since whole vectors are computed
    carried.pixel[i] = carried.pixel[0];
    carried.sample[i] = carried.sample[0];
  }
  packet.count = count;
  const auto one = set(d, 1);
  for (int v = 0; v < kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
    const auto pixels = hn::Load(du, carried.pixel + v);
    const auto samples = hn::Load(du, carried.sample + v);
    auto random = random_at_vertex(d, scene.sampler, pixels, samples, 0, features.lens);
    if (scene.filter.above != nullptr) filter_place(d, scene.filter, samples, random);
    const auto place = [&](hn::Vec<IdTag<D>> at, std::uint32_t begin) {
      return to_real(d, hn::And(at - begin, hn::Set(du, Id{0xffff})));
    };
    const auto x = place(pixels, scene.window_x);
    const auto y = place(hn::template ShiftRight<16>(pixels), scene.window_y);
    const auto store = [&](const auto& value, auto& to) { store3(d, value, to, v); };
    T* const times = features.motion ? packet.time + v : nullptr;
    if (times != nullptr) hn::Store(time_of_path(d, scene.sampler, pixels, samples), d, times);
    const auto camera = camera_vectors(d, scene, times);
    if (features.opacity)
      store_keys(d, keys_at_vertex(du, scene.sampler.seed, pixels, samples, 0).next, packet.key + v);
    const auto ray = camera_ray(d, scene, camera, x, y, random);
    store_rays(d, camera.origin, ray.offset, ray.direction, set(du, kCamera), packet, v);
    store(Vec3<hn::Vec<D>>{one, one, one}, carried.throughput);
    if (records) hn::Store(set(du, kOnlyDeltaBit), du, carried.history + v);
    if (features.rich_materials && scene.cone_width > 0) {
      const auto cone = camera_cone(d, scene, camera, ray.direction, scene.cone_width);
      store(Vec3<hn::Vec<D>>{cone.width2, cone.mixed, cone.slope2}, carried.cone);
    }
  }
}

/// Fills the packet with the next rays of the stream's paths first .. first + count, which are at a vertex.
template <class D, Loop kLoop, class Stream, class Packet, class Carried>
HWY_INLINE void load_secondary_rays(D d, const SceneView& scene, bool records, const Stream& stream,
                                    std::uint32_t vertex, int first, int count, Packet& packet, Carried& carried) {
  const Features features = features_of<kLoop>(scene);
  const IdTag<D> du;
  packet.count = count;
  for (int v = 0; v < count; v += static_cast<int>(hn::Lanes(d))) {
    const int i = first + v;
    const auto at = [&](const auto& component) { return loadu3(d, component, i); };
    const auto store = [&](const auto& value, auto& to) { store3(d, value, to, v); };
    store_rays(d, at(stream.base), at(stream.offset), at(stream.direction), hn::LoadU(du, stream.self + i), packet, v);
    store(at(stream.throughput), carried.throughput);
    const auto pixels = hn::LoadU(du, stream.pixel + i), samples = hn::LoadU(du, stream.sample + i);
    hn::Store(pixels, du, carried.pixel + v);
    hn::Store(samples, du, carried.sample + v);
    if (features.motion) hn::Store(time_of_path(d, scene.sampler, pixels, samples), d, packet.time + v);
    if (features.opacity)
      store_keys(d, keys_at_vertex(du, scene.sampler.seed, pixels, samples, vertex).next, packet.key + v);
    if (records) hn::Store(hn::LoadU(du, stream.history + i), du, carried.history + v);
    if (kLoop.full) hn::Store(hn::LoadU(du, stream.lit.path + i), du, carried.path + v);
    if (features.lit) hn::Store(hn::LoadU(d, stream.lit.pdf + i), d, carried.pdf + v);
    if (features.rich_materials && scene.cone_width > 0) store(at(stream.cone), carried.cone);
  }
}

/// The path loop, instantiated for each lane type and each Loop in use.
template <class D, Loop kLoop>
TileCounts render_tile(const SceneView& scene, const Tracer& tracer, const Tile& tile, PathStream& memory) {
  const D d;
  using T = hn::TFromD<D>;
  auto& stream = memory.as<T>();
  PathPayload<T> carried[kPacketsInFlight];
  TileCounts counts;
  counts.target = HWY_TARGET;
  const bool records = kLoop.full && tile.is_recorded();
  const std::int64_t weight = scene.filter.weight(tile.sample_begin, tile.sample_end);
  for (int i = 0; i < tile.pixel_count(); ++i) {
    const PixelPlace at = tile.pixel(i);
    tile.sums[at.y * tile.row_stride + at.x].weight += weight;
    if (kLoop.full && tile.guides != nullptr) tile.guides[at.y * tile.row_stride + at.x].weight += weight;
  }

  PathCounter counter(tile, scene);
  std::uint64_t to_start = tile.path_count();
  auto& shadow = stream.lit.shadow;
  const auto trace_shadows = [&](int waiting) {
    if (kLoop.full && shadow.count >= waiting) trace_shadow_batch(d, scene, tracer, tile, stream.lit, counts);
  };
  // After the shadow rays of the same vertices, so that a path's light is summed in the same order in every batch.
  const auto trace_caustics = [&](std::uint32_t depth, int waiting, int fewest) {
    if (!kLoop.full || !scene.features.caustics || stream.lit.vertices.count < waiting) return;
    trace_shadows(1);
    sample_caustics<D>(scene, tile.has_events(), stream.lit, sampled_events(scene, depth));
    trace_chains<D, kLoop.precision>(scene, tracer, tile, stream, fewest, counts);
  };
  const auto trace_and_shade = [&](std::uint32_t depth, int packets, int alive) {
    for (int i = 0; i < packets; ++i) {
      reset_hits(stream.packets[i]);
      counts.rays += static_cast<std::uint64_t>(stream.packets[i].count);
    }
    kernel::trace(tracer, stream.packets, packets);
    for (int i = 0; i < packets; ++i) {
      alive = Shader<D, kLoop>(scene, tile, depth, stream, counts).shade(stream.packets[i], carried[i], alive);
      trace_shadows(shadow.kBatch);
      trace_caustics(depth, kCausticBatch, kPacketSize);
    }
    return alive;
  };
  // Survivors overwrite paths that have already been read, because a packet never grows.
  const auto advance = [&](std::uint32_t depth, int count, auto load) {
    int alive = 0, loaded = 0;
    for (int i = 0; i < count; i += kPacketSize) {
      load(i, std::min(kPacketSize, count - i), stream.packets[loaded], carried[loaded]);
      if (++loaded < kPacketsInFlight && i + kPacketSize < count) continue;
      alive = trace_and_shade(depth, loaded, alive);
      loaded = 0;
    }
    // Shadow rays do not wait for the next depth, so that a path's light is summed in the same order in every batch.
    trace_shadows(1);
    trace_caustics(depth, 0, 1);
    return alive;
  };
  shadow.count = stream.lit.vertices.count = stream.lit.chains.count = 0;
  while (to_start > 0) {
    const int batch = static_cast<int>(std::min<std::uint64_t>(to_start, kStreamSize));
    to_start -= static_cast<std::uint64_t>(batch);
    int alive = advance(0, batch, [&](int first, int count, auto& packet, auto& payload) {
      load_camera_rays<D, kLoop>(d, scene, records, counter, count, packet, payload);
      if (kLoop.full) begin_paths(d, first, payload, stream.lit);
    });
    for (std::uint32_t depth = 1; alive > 0; ++depth)
      alive = advance(depth, alive, [&](int first, int count, auto& packet, auto& payload) {
        load_secondary_rays<D, kLoop>(d, scene, records, stream, depth, first, count, packet, payload);
      });
    if (kLoop.full) deposit_paths(d, batch, scene, tile, stream.lit, counts);
  }
  return counts;
}

/// The instance for these options.
template <class D, Precision kPrecision>
RenderTile instance(bool full) {
  return full ? render_tile<D, Loop{kPrecision, true}> : render_tile<D, Loop{kPrecision}>;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
