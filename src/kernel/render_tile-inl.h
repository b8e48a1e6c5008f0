// SPDX-License-Identifier: Apache-2.0
// The path loop.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "kernel/camera-inl.h"
#include "kernel/caustic_transport-inl.h"
#include "kernel/cone-inl.h"
#include "kernel/deposit-inl.h"
#include "kernel/direct_light-inl.h"
#include "kernel/render_tile.h"
#include "kernel/seen_emitters-inl.h"
#include "kernel/shade-inl.h"

// For a path at a time, the loop is
//
//     for each pixel and sample of the tile
//       ray = camera ray, throughput = 1
//       radiance = light of an emitter of the pixel, seen directly or in a ball, unless something is in front
//       for depth = 0, 1 .. max_depth - 1
//         hit = closest hit of the ray
//         if there is none: radiance += throughput background, end
//         radiance += throughput emission(hit), unless it has been sampled before
//         surface = point, normal and material of the hit
//         radiance += throughput albedo light(sampled point of a light), unless a shadow ray is occluded
//         radiance += throughput albedo light(sampled direction to a light by way of a ball)
//         direction, albedo = sample of the BSDF; if it is absorbed: end
//         throughput *= albedo; if Russian roulette ends the path: end
//         ray = from the surface along the direction
//       sum of the pixel += radiance
//
// It runs a batch of up to kStreamSize paths in lock-step: each step of the inner loop handles the rays of all paths
// that are alive, 16 in a packet, a vector at a time. Invariants:
//
// * A path's index within the batch never changes; its position in the stream falls as paths before it end. The stream
//   stays in the order of the indices.
// * Survivors never overtake: those of a vector are stored at or before its position, when all of it has been read.
//   Hence the stream needs no second copy. A compacted store overwrites a whole vector's length from its destination,
//   which ends before the next vector that is read.
// * A path's radiance is summed in the order of its vertices: the pixel's emitters, then at each vertex found light,
//   then light samples, then those by way of balls. Neither of them waits for the next depth. The order does not depend
//   on what else is in the batch, so that a pixel's bits depend neither on the tile nor on the number of lanes.
// * The radiance of a path is added to its pixel as integers, once, when the batch has ended.

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Enumerates a tile's paths: all samples of a pixel, then the next pixel, so that the rays of a packet are coherent.
class PathCounter {
 public:
  PathCounter(const Tile& tile, const SceneView& scene)
      : tile_(tile), scene_(scene), sample_(tile.sample_begin), end_(tile.sample_end), id_(id_of(tile.pixel(0))) {}

  template <class Id>
  void take(Id& pixel, Id& sample) {
    pixel = Id{id_};
    sample = Id{sample_};
    if (++sample_ == end_) start_run();
  }

 private:
  /// The second half of a pixel, or the next pixel. Not inlined.
  HWY_NOINLINE void start_run() {
    const bool is_second = tile_.has_both_halves && end_ == tile_.sample_end;
    const std::uint32_t first = is_second ? Sampler::kSecondHalf : 0;
    sample_ = first + tile_.sample_begin;
    end_ = first + tile_.sample_end;
    if (!is_second && ++pixel_ < tile_.pixel_count()) id_ = id_of(tile_.pixel(pixel_));
  }
  std::uint32_t id_of(PixelPlace place) const {
    const std::uint32_t x = static_cast<std::uint32_t>(tile_.x + place.x) + scene_.window_x;
    const std::uint32_t y = static_cast<std::uint32_t>(tile_.y + place.y) + scene_.window_y;
    return y << 16 | (x & 0xffff);
  }

  const Tile& tile_;
  const SceneView& scene_;
  std::uint32_t sample_, end_;  ///< of a run
  int pixel_ = 0;
  std::uint32_t id_;  ///< of the pixel
};

/// The path loop over a tile, in the order in which its steps run.
template <class D, Loop kLoop>
class TileLoop {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using Id = IdOf<T>;

 public:
  TileLoop(const SceneView& scene, const Tracer& tracer, const Tile& tile, PathsOf<T>& paths)
      : scene_(scene), tracer_(tracer), tile_(tile), paths_(paths), stream_(paths.stream) {}

  TileCounts run() {
    counts_.target = HWY_TARGET;
    count_paths();
    PathCounter counter(tile_, scene_);
    paths_.shadow.count = paths_.vertices.count = paths_.caustic_rays.count = 0;
    for (std::uint64_t left = tile_.path_count(); left > 0;) {
      const int batch = static_cast<int>(std::min<std::uint64_t>(left, kStreamSize));
      left -= static_cast<std::uint64_t>(batch);
      begin(batch, counter);
      if (kLoop.full && scene_.seen_emitters.begins != nullptr)
        SeenEmitterSampler<D, kLoop.precision>(scene_, tracer_, tile_, paths_, counts_).sample(batch);
      int alive = batch;
      for (depth_ = 0; alive > 0; ++depth_) alive = advance(alive);
      if (kLoop.full && tile_.covered != nullptr) add_coverage(paths_.batch, batch, scene_, tile_);
      deposit(d, paths_.batch, batch, scene_, tile_, counts_);
      if (tile_.largest != nullptr) raise_largest(paths_.batch, batch, scene_, tile_);
      if (kLoop.full) record_light(paths_.batch, batch, scene_, tile_);
    }
    return counts_;
  }

 private:
  static constexpr D d{};
  static constexpr IdTag<D> du{};
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

  HWY_INLINE Features features() const { return features_of<kLoop>(scene_); }

  /// Adds the tile's paths to the weights of their pixels.
  HWY_INLINE void count_paths() {
    const std::uint32_t weight = tile_.sample_end - tile_.sample_begin;
    const auto add = [&](std::int64_t to) {
      tile_.sums[to].weight += weight;
      if (kLoop.full && tile_.guides != nullptr) tile_.guides[to].weight += weight;
    };
    for (int i = 0; i < tile_.pixel_count(); ++i) {
      const PixelPlace at = tile_.pixel(i);
      const std::int64_t to = at.y * tile_.row_stride + at.x;
      add(to);
      if (tile_.has_both_halves) add(to + tile_.half_stride);
    }
  }

  /// Starts the next paths of the tile. The last vector is padded with the first path.
  HWY_INLINE void begin(int count, PathCounter& counter) {
    auto& batch = paths_.batch;
    for (int i = 0; i < count; ++i) counter.take(batch.pixel[i], batch.sample[i]);
    std::fill_n(batch.pixel + count, kPacketSize, batch.pixel[0]);
    std::fill_n(batch.sample + count, kPacketSize, batch.sample[0]);
    const Vec3<V> black = {hn::Zero(d), hn::Zero(d), hn::Zero(d)}, one = {set(d, 1), set(d, 1), set(d, 1)};
    for (int i = 0; i < count; i += kLanes) {
      store3(d, black, batch.radiance, i);
      store3(d, one, stream_.throughput, i);
      hn::Store(hn::Load(du, batch.pixel + i), du, stream_.pixel + i);
      hn::Store(hn::Load(du, batch.sample + i), du, stream_.sample + i);
      hn::Store(hn::Iota(du, static_cast<Id>(i)), du, stream_.path + i);
      if (kLoop.full && tile_.is_recorded()) hn::Store(set(du, kOnlyDeltaBit), du, stream_.history + i);
    }
  }

  /// Takes the stream's paths to their next vertices.
  ///
  /// Result     number of survivors
  HWY_INLINE int advance(int count) {
    Shader<D, kLoop> shader(scene_, tile_, depth_, paths_);
    int alive = 0;
    for (int first = 0; first < count; first += kPacketsInFlight * kPacketSize) {
      const int packets = load(first, std::min(count - first, kPacketsInFlight * kPacketSize));
      kernel::trace(tracer_, paths_.packets, packets);
      for (int i = 0; i < packets; ++i) {
        alive = shader.shade(paths_.packets[i], first + i * kPacketSize, alive);
        connect(false);
      }
    }
    connect(true);
    return alive;
  }

  /// Fills packets with rays of the stream from `first` on.
  ///
  /// Result     number of packets
  HWY_INLINE int load(int first, int count) {
    int packets = 0;
    for (int begin = 0; begin < count; begin += kPacketSize) {
      RayPacket<T>& packet = paths_.packets[packets++];
      packet.count = std::min(kPacketSize, count - begin);
      for (int v = 0; v < packet.count; v += kLanes) {
        const int i = first + begin + v;
        const auto pixels = hn::Load(du, stream_.pixel + i), samples = hn::Load(du, stream_.sample + i);
        if (features().motion || features().opacity) {
          const auto numbers = numbers_of_path(d, scene_.sampler, pixels, samples);
          if (features().motion) hn::Store(numbers.time, d, packet.time + v);
          if (features().opacity) store_floats(d, numbers.threshold, packet.threshold + v);
        }
        if (depth_ == 0)
          load_camera_rays(pixels, samples, i, v, packet);
        else
          store_rays(d, load3(d, stream_.base, i), load3(d, stream_.offset, i), load3(d, stream_.direction, i),
                     hn::Load(du, stream_.self + i), packet, v);
      }
      reset_hits(packet);
    }
    counts_.rays += static_cast<std::uint64_t>(count);
    return packets;
  }

  /// Samples camera rays.
  HWY_INLINE void load_camera_rays(hn::Vec<IdTag<D>> pixels, hn::Vec<IdTag<D>> samples, int i, int v,
                                   RayPacket<T>& packet) {
    auto random = random_at_vertex(d, scene_.sampler, pixels, samples, 0, features().lens);
    if (scene_.filter.places != nullptr) filter_place(d, scene_.filter, random);
    const auto place = [&](hn::Vec<IdTag<D>> at, std::uint32_t begin) {
      return to_real(d, hn::And(at - begin, hn::Set(du, Id{0xffff})));
    };
    const auto x = place(pixels, scene_.window_x);
    const auto y = place(hn::template ShiftRight<16>(pixels), scene_.window_y);
    const auto camera = camera_vectors(d, scene_, features().motion ? packet.time + v : nullptr);
    const auto ray = camera_ray(d, scene_, camera, x, y, random);
    store_rays(d, camera.origin, ray.offset, ray.direction, set(du, kCamera), packet, v);
    if (features().rich_materials && scene_.cone_width > 0) {
      const auto cone = camera_cone(d, scene_, camera, ray.direction, scene_.cone_width);
      store3(d, Vec3<V>{cone.width2, cone.mixed, cone.slope2}, stream_.cone, i);
    }
  }

  /// Traces shadow rays and samples light by way of balls.
  ///
  /// `all`      false: only as many as fill packets
  HWY_INLINE void connect(bool all) {
    if (!kLoop.full) return;
    const bool has_vertices = features().caustics && (all || paths_.vertices.count >= kCausticBatch);
    const int fewest = all || has_vertices ? 1 : ShadowStreamOf<T>::kBatch;
    while (paths_.shadow.count >= fewest) trace_shadow_batch(d, scene_, tracer_, tile_, paths_, counts_);
    if (!has_vertices) return;
    sample_caustics<D>(scene_, tile_.has_events(), paths_, sampled_events(scene_, depth_));
    trace_caustic_rays<D, kLoop.precision>(scene_, tracer_, tile_, paths_, all ? 1 : kPacketSize, counts_);
  }

  const SceneView& scene_;
  const Tracer& tracer_;
  const Tile& tile_;
  PathsOf<T>& paths_;
  PathStreamOf<T>& stream_;
  std::uint32_t depth_ = 0;
  TileCounts counts_;
};

template <class D, Loop kLoop>
TileCounts render_tile(const SceneView& scene, const Tracer& tracer, const Tile& tile, PathStream& memory) {
  return TileLoop<D, kLoop>(scene, tracer, tile, memory.as<hn::TFromD<D>>()).run();
}

/// The instance for these options.
template <class D, Precision kPrecision>
RenderTile instance(bool full) {
  return full ? render_tile<D, Loop{kPrecision, true}> : render_tile<D, Loop{kPrecision}>;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
