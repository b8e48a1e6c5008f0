// SPDX-License-Identifier: Apache-2.0
#include "film/motion_vectors.h"

#include <algorithm>
#include <cmath>

#include "film/sums.h"
#include "kernel/scene_view.h"

namespace orrery::film {
namespace {

using kernel::SceneView;
using math::Vec3d;
using math::vector_of;

Vec3d center_of(const kernel::Sphere& s) { return {s.x, s.y, s.z}; }

/// The displacement of a point of a rod: along the axis it keeps its share of the length, around it it turns with the
/// axis by the smallest angle.
Vec3d displacement(const kernel::Rod& from, const kernel::Rod& to, Vec3d at) {
  const Vec3d a = vector_of(from.a), axis = vector_of(from.b) - a, new_axis = vector_of(to.b) - vector_of(to.a);
  const double square = dot(axis, axis);
  const double share = square > 0 ? std::clamp(dot(at - a, axis) / square, 0.0, 1.0) : 0;
  const Vec3d radial = at - a - axis * share;
  Vec3d turned = radial;
  if (square > 0 && dot(new_axis, new_axis) > 0 && !(axis == new_axis)) {
    const Vec3d u = math::normalized(axis), v = math::normalized(new_axis);
    const double cosine = dot(u, v);
    if (cosine > -1) turned = radial - (u + v) * (dot(radial, u + v) / (1 + cosine)) + v * (2 * dot(radial, u));
  }
  return vector_of(to.a) - a + (new_axis - axis) * share + (turned - radial) + turned * (to.radius / from.radius - 1);
}

/// The displacement of a point of an object until a neighbouring frame.
Vec3d displacement(const SceneView& view, const NeighborFrame& neighbor, std::uint32_t id, Vec3d at) {
  SceneView there = view;
  there.motion = neighbor.sphere_motion.data();
  there.moving_count = neighbor.sphere_motion.size();
  there.rods.motion = neighbor.rod_motion.data();
  there.rods.moving_count = neighbor.rod_motion.size();
  there.rods.sphere_motion = there.motion;
  there.rods.moving_spheres = there.moving_count;
  if (view.rods.contains(id)) {
    const std::size_t rod = view.rods.index(id);
    return there.rods.moves(rod) ? displacement(view.rods[rod], there.rods.at(rod, 1), at) : Vec3d{};
  }
  if (id >= there.moving_count) return {};
  const kernel::Sphere from = view.spheres[id], to = sphere_at(there, id, 1);
  return center_of(to) - center_of(from) + (at - center_of(from)) * (to.radius / from.radius - 1);
}

/// 0 where a float has no room for it.
float finite(double px) {
  const auto out = static_cast<float>(px);
  return std::isfinite(out) ? out : 0;
}

}  // namespace

std::optional<FilmPlace> film_place(const kernel::Camera& camera, Vec3d from_camera) {
  const auto along = [&](Vec3d axis) { return dot(from_camera, axis) / dot(axis, axis); };
  const double depth = along(camera.forward), scale = camera.is_orthographic ? 1 : depth;
  if (!(depth > 0)) return {};
  return FilmPlace{along(camera.right) / scale, along(camera.down) / scale};
}

void write_motion_vector(const NeighborFrames& neighbors, const SceneView& view, const Sums& sums, std::size_t pixel,
                         float* xyzw) {
  std::fill_n(xyzw, 4, 0.0F);
  const kernel::Camera& camera = view.camera;
  const std::uint32_t hit = sums.layers.hit[pixel];
  if (hit == 0 && camera.is_orthographic) return;  // all of the background is one point at infinity
  const auto& position = sums.layers.position[pixel];
  const Vec3d at{position[0], position[1], position[2]};
  const auto width = static_cast<std::size_t>(sums.width);
  const double x = static_cast<double>(pixel % width) + 0.5 - camera.half_width;
  const double y = static_cast<double>(pixel / width) + 0.5 - camera.half_height;
  const Vec3d direction = camera.forward + camera.right * x + camera.down * y;
  const std::optional<FilmPlace> here = film_place(camera, hit != 0 ? at - camera.origin : direction);
  for (std::size_t i = 0; here && i < neighbors.size(); ++i) {
    if (neighbors[i] == nullptr) continue;
    const NeighborFrame& frame = *neighbors[i];
    const std::optional<FilmPlace> there = film_place(
        frame.camera, hit != 0 ? at + displacement(view, frame, hit - 1, at) - frame.camera.origin : direction);
    if (!there) continue;
    const auto [before, after] = i == 0 ? std::pair{*there, *here} : std::pair{*here, *there};
    xyzw[2 * i] = finite(before.x - after.x);
    xyzw[2 * i + 1] = finite(after.y - before.y);
  }
}

}  // namespace orrery::film
