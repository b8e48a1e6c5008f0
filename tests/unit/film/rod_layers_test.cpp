// SPDX-License-Identifier: Apache-2.0
// Layers of paths whose first hit is a rod.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "film/layer_sums.h"
#include "film/layers.h"
#include "kernel/path_record.h"
#include "kernel/scene_view.h"

namespace orrery::film {
namespace {

using math::Vec3d;

struct Random {
  std::mt19937_64 engine{3};
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(engine() >> 11) * 0x1p-53; }
  Vec3d direction() {
    for (;;) {
      const Vec3d d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      if (const double l = length(d); l > 0.1 && l < 1) return d * (1 / l);
    }
  }
};

Vec3d end_a(const kernel::Rod& rod) { return math::vector_of(rod.a); }

/// The vector from the closest point of a rod's axis.
Vec3d off_axis(const kernel::Rod& rod, Vec3d point) {
  const Vec3d u = math::vector_of(rod.b) - end_a(rod), f = point - end_a(rod);
  const double square = dot(u, u);
  return f - u * (square > 0 ? std::clamp(dot(f, u) / square, 0.0, 1.0) : 0);
}

/// Rods of any length, and rays in any direction, also along the axis.
TEST(FilmRodLayers, PositionNormalAndExit) {
  Random random;
  const kernel::Sphere sphere;
  const kernel::Material material;
  const std::uint32_t materials[3] = {0, 0, 0};
  LayerRequest request;
  request.z = request.depth = request.normal = request.position = request.deep = true;
  int through_ends = 0;
  for (int i = 0; i < 20000; ++i) {
    kernel::Rod rod;
    const Vec3d a = random.direction() * 3, u = random.direction();
    const double length_of_rod = i % 50 == 0 ? 0 : std::exp(random.uniform(-3, 3));
    math::set(rod.a, a);
    math::set(rod.b, a + u * length_of_rod);
    rod.radius = random.uniform(0.2, 1);
    // A point of the surface.
    const double place = std::clamp(random.uniform(-0.3, 1.3), 0.0, 1.0);
    Vec3d out = random.direction();
    if (place > 0 && place < 1) out = math::normalized(out - u * dot(out, u));
    if (place == 0 && dot(out, u) > 0 && length_of_rod > 0) out = out * -1;
    if (place == 1 && dot(out, u) < 0 && length_of_rod > 0) out = out * -1;
    const Vec3d point = a + u * (length_of_rod * place) + out * rod.radius;
    Vec3d direction = i % 7 == 0 ? u * (dot(u, out) > 0 ? -1 : 1) : random.direction();
    if (dot(direction, out) > 0) direction = direction * -1;
    if (dot(direction, out) > -1e-3) continue;  // grazing: the exit is where the entry is

    kernel::SceneView view;
    view.spheres = &sphere;
    view.sphere_count = 1;
    view.materials = &material;
    view.object_materials = materials;
    view.rods = {&rod, 1, nullptr, 0, 1};
    view.camera.is_orthographic = true;
    view.camera.forward = direction;
    view.camera.origin = point - direction * 5;
    kernel::PathRecord path;
    path.object = 1 + static_cast<std::uint32_t>(i % 2);
    path.offset = point - a;
    path.direction = direction;
    LayerSums sums(request, 1);
    sums.add(request, view, 0, path);

    EXPECT_FLOAT_EQ(sums.z[0], 5);
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = k == 0 ? point.x : k == 1 ? point.y : point.z;
      EXPECT_FLOAT_EQ(sums.position[0][k], static_cast<float>(at));
      EXPECT_NEAR(kernel::from_fixed_point(sums.normal[0][k]), k == 0 ? out.x : k == 1 ? out.y : out.z, 1e-12);
    }
    ASSERT_EQ(sums.shares[0].size(), 1u);
    const SphereCoverage& share = sums.shares[0][0];
    EXPECT_EQ(share.sphere, path.object);
    EXPECT_NEAR(share.front, 5, 1e-12);
    const double chord = share.back - share.front;
    const Vec3d exit = point + direction * chord;
    ASSERT_GT(chord, 0);
    ASSERT_NEAR(length(off_axis(rod, exit)), rod.radius, 1e-12 * (1 + chord)) << i;
    ASSERT_LT(length(off_axis(rod, point + direction * (chord / 2))), rod.radius);
    through_ends += std::abs(dot(off_axis(rod, exit), u)) > 1e-9;
  }
  EXPECT_GT(through_ends, 1000);
}

}  // namespace
}  // namespace orrery::film
