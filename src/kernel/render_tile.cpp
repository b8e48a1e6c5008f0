// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#include <algorithm>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/render_tile.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "kernel/camera-inl.h"
#include "kernel/shade-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

template <class T>
using IdFor = hwy::MakeUnsigned<T>;

/// The pixels and samples of a tile in order: all samples of a pixel, then the next pixel, so that the rays of a
/// packet lie close together.
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

/// Fills the packet with the first rays of the next paths.
template <class D, bool kRecords, bool kMoves, class Packet, class Carried>
HWY_INLINE void load_camera_rays(D d, const SceneView& scene, PathCounter& counter, int count, Packet& packet,
                                 Carried& carried) {
  using T = hn::TFromD<D>;
  using Id = IdFor<T>;
  const IdTag<D> du;
  for (int i = 0; i < count; ++i) counter.take(carried.pixel[i], carried.sample[i]);
  for (int i = count; i < kPacketSize; ++i) {  // a whole vector is computed even where it is not in use
    carried.pixel[i] = carried.pixel[0];
    carried.sample[i] = carried.sample[0];
  }
  packet.count = count;
  const auto one = hn::Set(d, T(1));
  for (int v = 0; v < kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
    const auto pixels = hn::Load(du, carried.pixel + v);
    const auto samples = hn::Load(du, carried.sample + v);
    auto random = random_at_vertex(d, scene.sampler, pixels, samples, 0, scene.features.lens);
    if (scene.filter.above != nullptr) filter_place(d, scene.filter, samples, random);
    const auto place = [&](hn::Vec<IdTag<D>> at, std::uint32_t begin) {
      return to_real(d, hn::And(at - hn::Set(du, static_cast<Id>(begin)), hn::Set(du, Id{0xffff})));
    };
    const auto x = place(pixels, scene.window_x);
    const auto y = place(hn::template ShiftRight<16>(pixels), scene.window_y);
    const auto store = [&](const auto& value, auto& to) {
      hn::Store(value.x, d, to[0] + v);
      hn::Store(value.y, d, to[1] + v);
      hn::Store(value.z, d, to[2] + v);
    };
    auto camera = camera_vectors(d, scene.camera);
    if constexpr (kMoves) {
      const auto time = time_of_path(d, scene.sampler, pixels, samples);
      hn::Store(time, d, packet.time + v);
      camera = moved(camera, camera_vectors(d, scene.camera_motion), time);
    }
    const auto ray = camera_ray(d, scene, camera, x, y, random);
    const auto origin = camera.origin + ray.offset;
    store(origin, packet.origin);
    store(sum_error(camera.origin, ray.offset, origin), packet.origin_low);
    store(ray.offset, packet.offset);
    store(ray.direction, packet.direction);
    store(Vec3<hn::Vec<D>>{one, one, one}, carried.throughput);
    hn::Store(one / dot(ray.direction, ray.direction), d, packet.inverse_square + v);
    hn::Store(hn::Set(du, static_cast<Id>(kNoSphere)), du, packet.self + v);
    if constexpr (kRecords) hn::Store(hn::Set(du, static_cast<Id>(kOnlyDeltaBit)), du, carried.history + v);
  }
}

/// Fills the packet with the next rays of paths first .. first + count of the stream.
template <class D, bool kRecords, bool kMoves, class Stream, class Carried>
HWY_INLINE void load_bounced_rays(D d, const SceneView& scene, Stream& stream, int first, int count, Carried& carried) {
  using T = hn::TFromD<D>;
  const IdTag<D> du;
  auto& packet = stream.packet;
  packet.count = count;
  const auto one = hn::Set(d, T(1));
  for (int v = 0; v < count; v += static_cast<int>(hn::Lanes(d))) {
    const int i = first + v;
    const auto at = [&](const auto& component) {
      return Vec3<hn::Vec<D>>{hn::LoadU(d, component[0] + i), hn::LoadU(d, component[1] + i),
                              hn::LoadU(d, component[2] + i)};
    };
    const auto store = [&](const auto& value, auto& to) {
      hn::Store(value.x, d, to[0] + v);
      hn::Store(value.y, d, to[1] + v);
      hn::Store(value.z, d, to[2] + v);
    };
    const auto base = at(stream.base), offset = at(stream.offset), direction = at(stream.direction);
    const auto origin = base + offset;
    store(origin, packet.origin);
    store(sum_error(base, offset, origin), packet.origin_low);
    store(offset, packet.offset);
    store(direction, packet.direction);
    store(at(stream.throughput), carried.throughput);
    hn::Store(one / dot(direction, direction), d, packet.inverse_square + v);
    hn::Store(hn::LoadU(du, stream.self + i), du, packet.self + v);
    const auto pixels = hn::LoadU(du, stream.pixel + i), samples = hn::LoadU(du, stream.sample + i);
    hn::Store(pixels, du, carried.pixel + v);
    hn::Store(samples, du, carried.sample + v);
    if constexpr (kMoves) hn::Store(time_of_path(d, scene.sampler, pixels, samples), d, packet.time + v);
    if constexpr (kRecords) hn::Store(hn::LoadU(du, stream.history + i), du, carried.history + v);
  }
}

template <class D, Precision kPrecision, bool kRecords, bool kMoves, class Stream>
TileCounts render_tile(const SceneView& scene, const Tracer& tracer, const Tile& tile, Stream& stream) {
  const D d;
  using T = hn::TFromD<D>;
  PathPayload<T, IdFor<T>> carried;
  TileCounts counts;
  counts.target = HWY_TARGET;
  const std::int64_t weight = scene.filter.weight(tile.sample_begin, tile.sample_end);
  for (int i = 0; i < tile.pixel_count(); ++i) {
    const PixelPlace at = tile.pixel(i);
    tile.sums[at.y * tile.row_stride + at.x].weight += weight;
  }

  PathCounter counter(tile, scene);
  std::uint64_t to_start = tile.path_count();
  const auto trace_and_shade = [&](std::uint32_t depth, int alive) {
    reset_hits(stream.packet);
    counts.rays += static_cast<std::uint64_t>(stream.packet.count);
    trace(tracer, stream.packet);
    return shade<D, kPrecision, kRecords, kMoves>(d, scene, tile, depth, carried, stream, alive, counts);
  };
  while (to_start > 0) {
    const int batch = static_cast<int>(std::min<std::uint64_t>(to_start, kStreamSize));
    to_start -= static_cast<std::uint64_t>(batch);
    int alive = 0;
    for (int i = 0; i < batch; i += kPacketSize) {
      load_camera_rays<D, kRecords, kMoves>(d, scene, counter, std::min(kPacketSize, batch - i), stream.packet,
                                            carried);
      alive = trace_and_shade(0, alive);
    }
    for (std::uint32_t depth = 1; alive > 0; ++depth) {
      // Survivors are written over paths that were already read: a packet never grows.
      int survivors = 0;
      for (int i = 0; i < alive; i += kPacketSize) {
        load_bounced_rays<D, kRecords, kMoves>(d, scene, stream, i, std::min(kPacketSize, alive - i), carried);
        survivors = trace_and_shade(depth, survivors);
      }
      alive = survivors;
    }
  }
  return counts;
}

using One = hn::FixedTag<double, 1>;
using All = hn::ScalableTag<double>;
using AllFast = hn::ScalableTag<float>;

template <class D, bool kRecords, bool kMoves>
RenderTile instance(Precision precision) {
  if (precision == Precision::kBook) return render_tile<D, Precision::kBook, kRecords, kMoves, PathStream>;
  return render_tile<D, Precision::kExact, kRecords, kMoves, PathStream>;
}
template <bool kRecords, bool kMoves>
RenderTileFast fast_instance() {
  return render_tile<AllFast, Precision::kFast, kRecords, kMoves, PathStreamFast>;
}

RenderTile render_instance(bool moves, Precision precision, Lanes lanes) {
  if (lanes == Lanes::kOne)
    return moves ? instance<One, false, true>(precision) : instance<One, false, false>(precision);
  return moves ? instance<All, false, true>(precision) : instance<All, false, false>(precision);
}
RenderTile record_instance(bool moves, Precision precision) {
  return moves ? instance<All, true, true>(precision) : instance<All, true, false>(precision);
}
RenderTileFast render_fast_instance(bool moves) {
  return moves ? fast_instance<false, true>() : fast_instance<false, false>();
}
RenderTileFast record_fast_instance(bool moves) {
  return moves ? fast_instance<true, true>() : fast_instance<true, false>();
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::kernel {

HWY_EXPORT(render_instance);
HWY_EXPORT(record_instance);
HWY_EXPORT(render_fast_instance);
HWY_EXPORT(record_fast_instance);

RenderTile render_tile_function(const Features& features, Precision precision, Lanes lanes) {
  return ORRERY_BEST(render_instance)(features.motion, precision, lanes);
}
RenderTileFast render_tile_fast_function(const Features& features) {
  return ORRERY_BEST(render_fast_instance)(features.motion);
}

RenderTile record_tile_function(const Features& features, Precision precision) {
  return ORRERY_BEST(record_instance)(features.motion, precision);
}
RenderTileFast record_tile_fast_function(const Features& features) {
  return ORRERY_BEST(record_fast_instance)(features.motion);
}

}  // namespace orrery::kernel
#endif
