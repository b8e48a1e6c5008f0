// SPDX-License-Identifier: Apache-2.0
#include "accel/accel.h"
#include "accel/duplicates.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/list.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include <algorithm>
#include <memory>
#include <type_traits>

#include "kernel/intersect-inl.h"
#include "kernel/scene_view.h"
#include "math/dispatch.h"

#ifndef ORRERY_ACCEL_LIST_ONCE
#define ORRERY_ACCEL_LIST_ONCE
namespace orrery::accel {

/// A scene, and the ids of its duplicate spheres, which are never hit.
struct DistinctSpheres {
  kernel::SceneView view;
  std::vector<std::uint32_t> duplicates;
};

}  // namespace orrery::accel
#endif

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class T, kernel::Precision kPrecision, bool kMoves, class Packet>
void trace_list(const void* self, Packet& packet) {
  namespace k = kernel::HWY_NAMESPACE;
  using D = hn::FixedTag<T, 1>;
  const D d;
  const auto& [scene, duplicates] = *static_cast<const DistinctSpheres*>(self);
  for (int i = 0; i < packet.count; ++i) {
    const auto ray = k::load_rays(d, packet, i);
    std::size_t id = 0;
    const auto trace_up_to = [&](std::size_t end) {
      for (; id < end; ++id) {
        const auto is_self = packet.self[i] == id ? hn::FirstN(d, 1) : hn::FirstN(d, 0);
        const auto found = k::closest_distance<D, kPrecision>(
            d, ray, k::sphere_at<kMoves>(d, scene, static_cast<std::uint32_t>(id), packet, i), is_self);
        if (hn::AllFalse(d, found.mask)) continue;
        const T distance = hn::GetLane(found.value);
        if (distance >= packet.distance[i]) continue;  // ids ascend, so at equal distance the smaller id was first
        packet.distance[i] = distance;
        packet.hit[i] = static_cast<std::remove_reference_t<decltype(packet.hit[0])>>(id);
      }
    };
    for (const std::uint32_t duplicate : duplicates) {
      trace_up_to(duplicate);
      ++id;
    }
    trace_up_to(scene.sphere_count);
  }
}

template <class T, kernel::Precision kPrecision, bool kMoves, class Packet>
void occlude_list(const void* self, Packet& packet) {
  namespace k = kernel::HWY_NAMESPACE;
  using D = hn::FixedTag<T, 1>;
  const D d;
  using Id = std::remove_reference_t<decltype(packet.occluded[0])>;
  const auto& [scene, duplicates] = *static_cast<const DistinctSpheres*>(self);
  std::fill_n(packet.occluded, kernel::kPacketSize, Id{0});
  for (int i = 0; i < packet.count; ++i) {
    const auto ray = k::load_rays(d, packet, i);
    auto duplicate = duplicates.begin();
    for (std::size_t id = 0; id < scene.sphere_count && packet.occluded[i] == 0; ++id) {
      if (duplicate != duplicates.end() && *duplicate == id) {
        ++duplicate;
        continue;
      }
      if (packet.target[i] == id) continue;
      const auto is_self = packet.self[i] == id ? hn::FirstN(d, 1) : hn::FirstN(d, 0);
      const auto found = k::closest_distance<D, kPrecision>(
          d, ray, k::sphere_at<kMoves>(d, scene, static_cast<std::uint32_t>(id), packet, i), is_self);
      if (!hn::AllFalse(d, found.mask) && hn::GetLane(found.value) < packet.distance[i])
        packet.occluded[i] = static_cast<Id>(~Id{0});
    }
  }
}

template <bool kMoves>
kernel::Tracer instance(kernel::Precision precision) {
  using kernel::Precision, kernel::RayPacket, kernel::RayPacketFast, kernel::ShadowPacket, kernel::ShadowPacketFast;
  kernel::Tracer t;
  t.target = HWY_TARGET;
  t.trace = precision == Precision::kBook ? trace_list<double, Precision::kBook, kMoves, RayPacket>
                                          : trace_list<double, Precision::kExact, kMoves, RayPacket>;
  t.trace_fast = trace_list<float, Precision::kFast, kMoves, RayPacketFast>;
  t.occlude = precision == Precision::kBook ? occlude_list<double, Precision::kBook, kMoves, ShadowPacket>
                                            : occlude_list<double, Precision::kExact, kMoves, ShadowPacket>;
  t.occlude_fast = occlude_list<float, Precision::kFast, kMoves, ShadowPacketFast>;
  return t;
}

kernel::Tracer list_tracer(kernel::Precision precision, bool moves) {
  return moves ? instance<true>(precision) : instance<false>(precision);
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::accel {
namespace {

HWY_EXPORT(list_tracer);

class List final : public Accel {
 public:
  List(const kernel::SceneView& view, kernel::Precision precision)
      : scene_{view, duplicates(view, precision)}, precision_(precision) {}

  kernel::Tracer tracer() const noexcept override {
    kernel::Tracer t = ORRERY_BEST(list_tracer)(precision_, scene_.view.moving_count > 0);
    t.self = &scene_;
    return t;
  }
  std::string name() const override { return "list"; }
  std::size_t bytes() const noexcept override { return scene_.duplicates.size() * sizeof(scene_.duplicates[0]); }

 private:
  DistinctSpheres scene_;
  kernel::Precision precision_;
};

}  // namespace

std::unique_ptr<Accel> make_list(const kernel::SceneView& scene, kernel::Precision precision) {
  return std::make_unique<List>(scene, precision);
}

}  // namespace orrery::accel
#endif
