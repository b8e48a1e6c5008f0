// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "accel/embree_scene.h"
#include "accel/sphere_bvh.h"
#include "accel/sphere_classes.h"
#include "base/error.h"
#include "base/stop_point.h"
#include "kernel/scene_view.h"

namespace orrery::accel {
namespace {

/// Maps the progress of one stage to the range from `begin` to `end` of the whole.
BuildMonitor part_of(const BuildMonitor& whole, double begin, double end) {
  if (!whole) return {};
  return [&whole, begin, end](double fraction) { return whole(begin + (end - begin) * fraction); };
}

/// Most primitives of a rod, and the extent of one across its longest axis in radii, above which it is divided. The box
/// of a long diagonal is nearly empty; those of bonds, and of rods parallel to an axis, are not
/// (measured: docs/decisions/0034-rods.md).
constexpr double kMostPieces = 16, kPieceWidth = 12;

/// Adds the primitives of a rod.
void add_pieces(const kernel::Rod& rod, std::uint32_t id, std::vector<RodPiece>& pieces) {
  double extent[3];
  for (int k = 0; k < 3; ++k) extent[k] = std::abs(rod.b[k] - rod.a[k]);
  std::sort(extent, extent + 3);
  const double wanted = std::ceil(extent[1] / (kPieceWidth * rod.radius));
  const auto count = static_cast<std::uint16_t>(std::clamp(wanted, 1.0, kMostPieces));
  for (std::uint16_t i = 0; i < count; ++i) pieces.push_back({id, i, count});
}

struct BuildState {
  const EmbreeScene* scene;
  std::uint32_t geometry;
  std::atomic<std::uint64_t> refused{0};  ///< boxes that Embree would drop silently
};

void set_bounds(const BoxFrame::Box& box, BuildState& state, RTCBounds& out) {
  out.lower_x = box.lower[0];
  out.lower_y = box.lower[1];
  out.lower_z = box.lower[2];
  out.upper_x = box.upper[0];
  out.upper_y = box.upper[1];
  out.upper_z = box.upper[2];
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.lower[axis] < box.upper[axis] && std::isfinite(box.lower[axis]) && std::isfinite(box.upper[axis])))
      state.refused.fetch_add(1, std::memory_order_relaxed);
}

void sphere_bounds(const RTCBoundsFunctionArguments* arguments) {
  auto& state = *static_cast<BuildState*>(arguments->geometryUserPtr);
  const auto& scene = *state.scene;
  const std::uint32_t id = scene.sphere_id(state.geometry, arguments->primID);
  RTCBounds& out = *arguments->bounds_o;
  if (scene.view.is_duplicate(id)) {
    // Embree skips primitives with an empty box.
    out.lower_x = out.lower_y = out.lower_z = std::numeric_limits<float>::infinity();
    out.upper_x = out.upper_y = out.upper_z = -std::numeric_limits<float>::infinity();
    return;
  }
  set_bounds(scene.frame.box(scene.bounded.at(id, static_cast<int>(arguments->timeStep))), state, out);
}

void rod_bounds(const RTCBoundsFunctionArguments* arguments) {
  auto& state = *static_cast<BuildState*>(arguments->geometryUserPtr);
  const auto& scene = *state.scene;
  const RodPiece piece = scene.rod_pieces[arguments->primID];
  const BoundedRods rods{scene.view.rods, scene.bounded.in_single};
  const double count = piece.count;
  set_bounds(scene.frame.box(rods.at(piece.rod, static_cast<int>(arguments->timeStep)), piece.index / count,
                             (piece.index + 1) / count),
             state, *arguments->bounds_o);
}

void bvh_bounds(const RTCBoundsFunctionArguments* arguments) {
  const BoxFrame::Box& box = static_cast<const SphereBvh*>(arguments->geometryUserPtr)->box;
  *arguments->bounds_o = {box.lower[0], box.lower[1], box.lower[2], 0, box.upper[0], box.upper[1], box.upper[2], 0};
}

class Embree final : public Accel {
 public:
  Embree(const kernel::SceneView& view, kernel::Precision precision, const BuildMonitor& monitor,
         std::size_t bvh_threshold)
      : functions_(embree_functions(precision)), scene_(make_scene(view, precision)) {
    // Not empty without rods: outliers are defined relative to other objects.
    std::vector<std::uint32_t> ids = ordinary_spheres(view, scene_.outliers);
    const std::size_t primitives = view.sphere_count - scene_.outliers.size();
    const auto share = [all = primitives + view.rods.count](std::size_t count) {
      return static_cast<double>(count) / static_cast<double>(all);
    };
    const BoundedRods rods{view.rods, precision == kernel::Precision::kFast};
    scene_.frame = BoxFrame(scene_.bounded, ids, rods);
    ids = take_for_bvh(view, std::move(ids), bvh_threshold);
    for (std::uint32_t i = 0; i < view.rods.count; ++i)
      if (!is_short(view, i, largest_in_bvh_) && !view.is_duplicate(view.rods.id(i)))
        add_pieces(view.rods[i], i, scene_.rod_pieces);
    if (!ids.empty()) {
      const double end = share(ids.size());
      bvh_ = SphereBvh(scene_.bounded, std::move(ids), scene_.frame, part_of(monitor, 0, end), rods);
    }
    build(primitives, part_of(monitor, share(bvh_.count), 1));
    if (!scene_.has_packets) return;
    packets_.traversals = {Traversal::kPacket, Traversal::kPacket};
    fastest_.traversals = fastest_traversals(view, !bvh_.empty());
  }

  kernel::Tracer tracer(std::optional<Traversal> requested) const noexcept override {
    return functions_.tracer_of(traced(requested));
  }
  std::string traversal_name(std::optional<Traversal> requested) const override {
    return name_of(traced(requested).traversals);
  }
  void set_opacity(const float* opacity) noexcept override { scene_.view.opacity = opacity; }
  std::string name() const override { return "embree " + embree_.version(); }
  std::size_t bytes() const noexcept override {
    return embree_.bytes() + bvh_.bytes() + scene_.rod_pieces.size() * sizeof(RodPiece);
  }

 private:
  const TracedScene& traced(std::optional<Traversal> requested) const noexcept {
    return !requested ? fastest_ : requested == Traversal::kPacket ? packets_ : singles_;
  }

  static EmbreeScene make_scene(const kernel::SceneView& view, kernel::Precision precision) {
    EmbreeScene scene;
    scene.view = view;
    scene.bounded = {view.spheres, precision == kernel::Precision::kFast, view.motion, view.moving_count};
    scene.outliers = find_outliers(view);
    const auto moving_outliers = std::lower_bound(scene.outliers.begin(), scene.outliers.end(), view.moving_count);
    scene.moving_primitives = static_cast<std::uint32_t>(view.moving_count) -
                              static_cast<std::uint32_t>(moving_outliers - scene.outliers.begin());
    return scene;
  }

  /// Selects the spheres and static rods of similar size for a BVH, if there are enough of them.
  ///
  /// `ids`      ascending ids of all spheres that are neither outliers nor duplicates
  /// Result     empty: each sphere and rod is a primitive
  std::vector<std::uint32_t> take_for_bvh(const kernel::SceneView& view, std::vector<std::uint32_t> ids,
                                          std::size_t threshold) {
    const std::size_t static_rods = view.rods.count - view.rods.moving_count;
    if (ids.size() + static_rods < threshold || ids.size() + static_rods > SphereBvh::kMaxSpheres) return {};
    const double limit = giant_radius(view);
    std::vector<std::uint32_t> giants;
    const base::StopPoint stop;
    for (const std::uint32_t id : ids) {
      stop.check(id);
      if (!is_compact(view, id, limit)) giants.push_back(id);
    }
    const std::size_t rods = short_rods(view, limit);
    if (ids.size() - giants.size() + rods < threshold) return {};
    std::erase_if(ids, [&](std::uint32_t id) { return !is_compact(view, id, limit); });
    if (threshold > 1 && ids.size() <= kMaxInSmallLayer && is_layer(view)) return {};
    scene_.moving_primitives =
        static_cast<std::uint32_t>(std::lower_bound(giants.begin(), giants.end(), view.moving_count) - giants.begin());
    scene_.singles = std::move(giants);
    scene_.bvh = &bvh_;
    largest_in_bvh_ = limit;
    for (std::size_t i = 0; i < view.rods.count; ++i)
      if (is_short(view, i, limit)) ids.push_back(view.rods.id(i));
    return ids;
  }

  /// Moving spheres get a separate geometry, since the others need no second time step.
  void build(std::size_t primitives, const BuildMonitor& monitor) {
    BuildState moving{&scene_, 0}, still{&scene_, scene_.moving_primitives > 0 ? 1u : 0u};
    if (scene_.moving_primitives > 0)
      add_geometry(functions_.spheres, sphere_bounds, scene_.moving_primitives, 2, &moving);
    const std::size_t rest = (bvh_.empty() ? primitives : scene_.singles.size()) - scene_.moving_primitives;
    if (rest > 0) add_geometry(functions_.spheres, sphere_bounds, rest, 1, &still);
    if (!bvh_.empty()) add_geometry(functions_.bvh, bvh_bounds, 1, 1, &bvh_);
    scene_.is_bvh_alone =
        !bvh_.empty() && scene_.moving_primitives == 0 && scene_.singles.empty() && scene_.rod_pieces.empty();
    if (!scene_.rod_pieces.empty())
      add_geometry(functions_.rods, rod_bounds, scene_.rod_pieces.size(), scene_.view.rods.any_moves() ? 2 : 1, &still);
    if (monitor)
      rtcSetSceneProgressMonitorFunction(
          embree_.get(),
          [](void* self, double fraction) { return (*static_cast<const BuildMonitor*>(self))(fraction); },
          const_cast<BuildMonitor*>(&monitor));
    embree_.commit();
    rtcSetSceneProgressMonitorFunction(embree_.get(), nullptr, nullptr);
    if (moving.refused + still.refused > 0)
      throw base::Error(base::ErrorKind::kInternal,
                        "Embree would silently drop " + std::to_string(moving.refused + still.refused) + " primitives");
    scene_.scene = embree_.get();
    scene_.has_packets = embree_.has_packets_of(functions_.width);
  }

  void add_geometry(const EmbreeFunctions::Callbacks& callbacks, RTCBoundsFunction bounds, std::size_t primitives,
                    unsigned time_steps, void* data) {
    RTCGeometry geometry = rtcNewGeometry(embree_.device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(primitives));
    rtcSetGeometryTimeStepCount(geometry, time_steps);
    rtcSetGeometryUserData(geometry, data);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, callbacks.intersect);
    rtcSetGeometryOccludedFunction(geometry, callbacks.occluded);
    rtcSetGeometryMask(geometry, ~0u);  // the default differs between Embree 3 and 4
    embree_.attach(geometry);
  }

  EmbreeFunctions functions_;
  EmbreeScene scene_;
  TracedScene singles_{&scene_, {Traversal::kSingle, Traversal::kSingle}}, packets_ = singles_, fastest_ = singles_;
  double largest_in_bvh_ = 0;  ///< radius; 0: there is no BVH
  SphereBvh bvh_;
  OwnedScene embree_;
};

}  // namespace

std::unique_ptr<Accel> make_embree(const kernel::SceneView& scene, kernel::Precision precision,
                                   const BuildMonitor& monitor, std::size_t threshold) {
  if (scene.sphere_count == 0 && scene.rods.empty())
    return make_list(scene, precision);  // there is nothing to build a BVH from
  return std::make_unique<Embree>(scene, precision, monitor, std::max<std::size_t>(1, threshold));
}

std::string embree_version() {
  static const std::string version = OwnedScene().version();
  return version;
}

}  // namespace orrery::accel
