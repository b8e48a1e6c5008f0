// SPDX-License-Identifier: Apache-2.0
#include "film/layer_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "film/layers.h"
#include "kernel/path_record.h"
#include "kernel/scene_view.h"

namespace orrery::film {
namespace {

using kernel::PathRecord;
using math::Vec3d;
using math::vector_of;

bool is_valid(const double (&light)[3]) { return kernel::is_valid_sample(light[0], light[1], light[2]); }

kernel::Int128 square(double v) {
  const double units = std::min(v * v, kLargestSquare) * (1 / kSquareUnit);
  if (units < 0x1p62) return static_cast<std::int64_t>(units);  // the common case stays in 64 bits
  // Converted in two steps, since values of up to 2^96 do not fit into 64 bits.
  const double high = std::floor(units * 0x1p-48);
  return (static_cast<kernel::Int128>(static_cast<std::int64_t>(high)) << 48) +
         static_cast<std::int64_t>(units - high * 0x1p48);
}

template <class Sum, class T>
void add3(Sum& sum, const T& value) {
  for (std::size_t k = 0; k < 3; ++k) sum[k] += kernel::to_fixed_point(static_cast<double>(value[k]));
}

/// The coverage entry of a sphere, inserted if there is none.
SphereCoverage& share_of(std::vector<SphereCoverage>& shares, std::uint32_t sphere) {
  const auto at = std::lower_bound(shares.begin(), shares.end(), sphere,
                                   [](const SphereCoverage& share, std::uint32_t id) { return share.sphere < id; });
  if (at != shares.end() && at->sphere == sphere) return *at;
  SphereCoverage fresh;
  fresh.sphere = sphere;
  return *shares.insert(at, fresh);
}

/// Position of a path's first hit.
struct Hit {
  double distance;  ///< distance from the camera, or from the plane of an orthographic camera, scene units
  double z;         ///< distance along the view axis, scene units
  double exit_z;    ///< distance along the view axis of the point where the ray leaves the sphere
};

Vec3d fma(Vec3d a, double s, Vec3d b) { return {std::fma(a.x, s, b.x), std::fma(a.y, s, b.y), std::fma(a.z, s, b.z)}; }

/// The point to which a record's offset is added, at a shutter time.
Vec3d base_of(const kernel::SceneView& scene, std::uint32_t id, double time) {
  if (scene.rods.contains(id)) return vector_of(scene.rods.at(scene.rods.index(id), time).a);
  const kernel::Sphere s = kernel::sphere_at(scene, id, time);
  return {s.x, s.y, s.z};
}

/// A rod at a path's time, with a unit axis.
struct HitRod {
  Vec3d axis;  ///< 0 if the length is 0
  double length, radius;

  HitRod(const kernel::SceneView& scene, const PathRecord& path) {
    const kernel::Rod rod = scene.rods.at(scene.rods.index(path.object), path.time);
    axis = vector_of(rod.b) - vector_of(rod.a);
    length = math::length(axis);
    radius = rod.radius;
    if (length > 0) axis = axis * (1 / length);
  }

  /// The vector from the closest point of the axis to a hit, from its offset from a.
  Vec3d from_axis(Vec3d offset) const { return offset - axis * std::clamp(dot(offset, axis), 0.0, length); }

  /// Distance from an entry to the exit along a unit direction.
  ///
  /// The distance at which the ray leaves the sphere around a point of the axis is a concave function of that point:
  /// the exit is that of the infinite cylinder if it is between the ends, or else that of the sphere at the nearer end.
  double chord(Vec3d offset, Vec3d direction) const {
    const double along = dot(direction, axis), sine2 = 1 - along * along;
    const auto exit_of = [&](Vec3d f, double square) {  // |f + t direction|^2 = radius^2, in this plane
      const double half = dot(f, direction);
      return (std::sqrt(std::max(half * half - square * (dot(f, f) - radius * radius), 0.0)) - half) / square;
    };
    const double entry = dot(offset, axis);
    const double t = sine2 > 0 ? exit_of(offset - axis * entry, sine2) : std::numeric_limits<double>::infinity();
    const double exit = entry + t * along;
    if (exit > 0 && exit < length) return std::max(t, 0.0);
    const bool at_b = exit >= length && length > 0;
    return std::max(exit_of(at_b ? offset - axis * length : offset, 1), 0.0);
  }
};

/// Origin and viewing direction of the camera at a shutter time.
std::pair<Vec3d, Vec3d> camera_at(const kernel::SceneView& scene, double time) {
  const kernel::Camera &camera = scene.camera, &change = scene.camera_motion;
  if (!scene.features.motion) return {camera.origin, camera.forward};
  return {fma(change.origin, time, camera.origin), fma(change.forward, time, camera.forward)};
}

/// False if a path's first hit is certainly not closer than this; cheaper than locating the hit.
bool may_be_nearer(const kernel::SceneView& scene, const PathRecord& path, double than) {
  if (scene.camera.is_orthographic || scene.features.motion) return true;
  const Vec3d from_camera = base_of(scene, path.object, 0) - scene.camera.origin + path.offset;
  constexpr double kRounding = 1 + 0x1p-50;  // of both squares and the root
  return !(dot(from_camera, from_camera) > than * than * kRounding);
}

Hit locate(const kernel::SceneView& scene, const PathRecord& path) {
  const auto [origin, forward] = camera_at(scene, path.time);
  const Vec3d from_camera = base_of(scene, path.object, path.time) - origin + path.offset;
  const double forward_length = length(forward);
  Hit hit{};
  hit.z = dot(from_camera, forward) / forward_length;
  hit.distance = scene.camera.is_orthographic ? hit.z : length(from_camera);
  // The far end of the chord. From inside the sphere the first hit is the exit.
  const double chord = scene.rods.contains(path.object) ? HitRod(scene, path).chord(path.offset, path.direction)
                                                        : std::max(0.0, -2 * dot(path.direction, path.offset));
  hit.exit_z = hit.z + chord * dot(path.direction, forward) / forward_length;
  return hit;
}

/// The normal at a first hit, on the side of the camera.
Vec3d normal_of(const kernel::SceneView& scene, const PathRecord& path) {
  if (scene.rods.contains(path.object)) {
    const HitRod rod(scene, path);
    return rod.from_axis(path.offset) * (1 / rod.radius);
  }
  // Decided per ray, since the lens can straddle the surface.
  const double along = dot(path.direction, path.offset);
  const double radius = kernel::sphere_at(scene, path.object, path.time).radius;
  return path.offset * (along > 0 ? -1 / radius : 1 / radius);
}

}  // namespace

LayerSums::LayerSums(const LayerRequest& request, std::size_t pixels)
    : light(request.light_cells() * pixels),
      squares(request.variance ? pixels : 0),
      normal(request.normal ? pixels : 0),
      albedo(request.albedo ? pixels : 0),
      covered(request.coverage ? pixels : 0),
      hit(request.nearest() ? pixels : 0),
      depth(hit.size()),
      z(request.z ? pixels : 0),
      position(request.position || request.vector ? pixels : 0),
      shares(request.deep || !request.mattes.empty() ? pixels : 0) {}

void LayerSums::add(const LayerRequest& request, const kernel::SceneView& scene, std::size_t pixel,
                    const PathRecord& path) {
  if (request.variance && is_valid(path.light))
    for (std::size_t k = 0; k < 3; ++k) squares[pixel][k] += square(path.light[k]);
  const bool hits = path.object != kernel::kNone;
  Hit at{};
  const double nearest = request.nearest() && hit[pixel] != 0 ? depth[pixel] : std::numeric_limits<double>::infinity();
  const bool is_candidate = hits && request.nearest() && may_be_nearer(scene, path, nearest);
  if (is_candidate || (hits && request.deep)) at = locate(scene, path);
  if (request.deep || (hits && !request.mattes.empty())) {
    SphereCoverage& share = share_of(shares[pixel], request.coverage_key(path.object));
    ++share.weight;
    if (request.deep && is_valid(path.light)) add3(share.light, path.light);
    share.front = std::min(share.front, hits ? at.z : double{kNothingHit});
    share.back = std::max(share.back, hits ? at.exit_z : double{kNothingHit});
  }
  if (!hits) return;

  if (request.albedo) {
    const double* const constant = scene.materials[scene.object_materials[path.object]].albedo;
    if (scene.features.rich_materials) {
      add3(albedo[pixel], path.albedo);
    } else {
      add3(albedo[pixel], constant);
    }
  }
  if (request.normal) {
    const Vec3d n = normal_of(scene, path);
    add3(normal[pixel], std::array{n.x, n.y, n.z});
  }
  if (!is_candidate || !(at.distance < nearest)) return;
  hit[pixel] = path.object + 1;
  depth[pixel] = at.distance;
  if (request.z) z[pixel] = static_cast<float>(at.z);
  if (position.empty()) return;
  const Vec3d p = base_of(scene, path.object, path.time) + path.offset;
  position[pixel] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

void LayerSums::add(const LayerRequest& request, std::size_t pixel, const PathRecord& path,
                    const kernel::LightEvent& event) {
  if (is_valid(path.light))
    add3(light[pixel * request.light_cells() + request.light_cell(event.group, event.lobe)], event.value);
}

void LayerSums::add(const LayerSums& other) {
  const auto add_all = [](auto& to, const auto& from) {
    for (std::size_t i = 0; i < to.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) to[i][k] += from[i][k];
  };
  add_all(light, other.light);
  add_all(squares, other.squares);
  add_all(normal, other.normal);
  add_all(albedo, other.albedo);
  for (std::size_t i = 0; i < covered.size(); ++i) covered[i] += other.covered[i];
  for (std::size_t i = 0; i < shares.size(); ++i)
    for (const SphereCoverage& from : other.shares[i]) {
      SphereCoverage& to = share_of(shares[i], from.sphere);
      to.weight += from.weight;
      for (std::size_t k = 0; k < 3; ++k) to.light[k] += from.light[k];
      to.front = std::min(to.front, from.front);
      to.back = std::max(to.back, from.back);
    }
  for (std::size_t i = 0; i < hit.size(); ++i) {
    if (other.hit[i] == 0 || (hit[i] != 0 && !(other.depth[i] < depth[i]))) continue;
    hit[i] = other.hit[i];
    depth[i] = other.depth[i];
    if (!z.empty()) z[i] = other.z[i];
    if (!position.empty()) position[i] = other.position[i];
  }
}

}  // namespace orrery::film
