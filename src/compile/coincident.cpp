// SPDX-License-Identifier: Apache-2.0
#include "compile/coincident.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/duplicates.h"
#include "compile/compiled_scene.h"
#include "kernel/scene_view.h"
#include "math/scalar.h"

namespace orrery::compile {
namespace {

std::array<double, 4> numbers_of(const kernel::Sphere& s) { return {s.x, s.y, s.z, s.radius}; }
std::array<double, 7> numbers_of(const kernel::Rod& r) {
  return {r.a[0], r.a[1], r.a[2], r.b[0], r.b[1], r.b[2], r.radius};
}

/// The numbers of an object when the shutter opens and, if N has room for it, their change until it closes.
template <std::size_t N, class Object>
std::array<double, N> key_of(const Object& at_opening, const Object& change, Precision precision) {
  const auto opening = numbers_of(at_opening), changes = numbers_of(change);
  std::array<double, N> key;
  std::copy_n(changes.begin(), N - opening.size(), std::copy(opening.begin(), opening.end(), key.begin()));
  if (precision == Precision::kFast)
    for (double& x : key) x = math::in_single_precision(x);
  return key;
}

template <std::size_t N>
std::vector<base::Duplicate> coincident_spheres(const kernel::SceneView& view, Precision precision) {
  return base::find_duplicates<N>(view.sphere_count, [&](std::size_t id) {
    const kernel::Sphere change = id < view.moving_count ? view.motion[id] : kernel::Sphere{0, 0, 0, 0};
    return key_of<N>(view.spheres[id], change, precision);
  });
}

template <std::size_t N>
std::vector<base::Duplicate> coincident_rods(const kernel::RodArray& rods, Precision precision) {
  return base::find_duplicates<N>(rods.count,
                                  [&](std::size_t i) { return key_of<N>(rods[i], rods.change(i), precision); });
}

}  // namespace

std::vector<std::uint32_t> coincident_objects(const CompiledScene& scene) {
  const kernel::SceneView view = scene.view();
  const Precision precision = scene.precision;
  std::vector<std::uint32_t> out;
  const auto add = [&](std::size_t first, const std::vector<base::Duplicate>& found) {
    for (const base::Duplicate& d : found) out.push_back(static_cast<std::uint32_t>(first + d.index));
  };
  // Distinct floats are distinct doubles, too.
  if (!scene.distinct_in || (precision == Precision::kFast && scene.distinct_in != Precision::kFast))
    add(0, view.moving_count > 0 ? coincident_spheres<8>(view, precision) : coincident_spheres<4>(view, precision));
  add(view.sphere_count,
      view.rods.any_moves() ? coincident_rods<14>(view.rods, precision) : coincident_rods<7>(view.rods, precision));
  return out;
}

}  // namespace orrery::compile
