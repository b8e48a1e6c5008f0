// SPDX-License-Identifier: Apache-2.0
#include "scene/changed_parts.h"

#include <algorithm>
#include <variant>
#include <vector>

#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::scene {
namespace {

/// Adds what the keys change that have different values.
template <class Target>
void compare(const std::vector<Key<Target>>& keys, Part otherwise, const Target& before, const Target& after,
             Parts& parts) {
  for (const Key<Target>& key : keys)
    if (key.text(before) != key.text(after)) parts.add(key.part.value_or(otherwise));
}

bool is_same(TextureUse use, const TextureSlot& before, const TextureSlot& after) {
  if (!before || !after || before == after) return before == after;
  if (before->type != after->type) return false;
  const std::vector<Key<Texture>>& keys = type_of(*before, use).keys;
  return std::all_of(keys.begin(), keys.end(),
                     [&](const Key<Texture>& key) { return key.text(*before) == key.text(*after); });
}

/// Materials are numbered in the order of the file, and only dielectrics have two sides and no colour: which ones
/// exist, and whether they are dielectrics, decides what the spheres refer to.
void compare_materials(const std::vector<Material>& before, const std::vector<Material>& after, Parts& parts) {
  const auto has_same_role = [](const Material& a, const Material& b) {
    return a.name == b.name &&
           std::holds_alternative<Dielectric>(a.model) == std::holds_alternative<Dielectric>(b.model);
  };
  if (!std::equal(before.begin(), before.end(), after.begin(), after.end(), has_same_role))
    return parts.add(Part::kAssignment);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const MaterialModel &a = before[i].model, &b = after[i].model;
    if (a.index() != b.index()) {
      parts.add(Part::kLook);
      if (opacity_of(a) != opacity_of(b)) parts.add(Part::kAssignment);
      continue;
    }
    const MaterialType& type = type_of(a);
    compare(type.keys, Part::kLook, a, b, parts);
    for (const TexturedKey& key : type.textured)
      if (!is_same(key.use, key.get(a), key.get(b))) parts.add(Part::kLook);
  }
}

/// Compares the elements of two lists; another number of them changes the geometry.
template <class Item, class Compare>
void compare_lists(const std::vector<Item>& before, const std::vector<Item>& after, Parts& parts, Compare compare) {
  if (before.size() != after.size()) return parts.add(Part::kGeometry);
  for (std::size_t i = 0; i < before.size(); ++i) compare(before[i], after[i], parts);
}

/// The keys of [[sphere]], compared as members: there may be a million tables.
void compare_spheres(const Sphere& a, const Sphere& b, Parts& parts) {
  parts.geometry = parts.geometry || !(a.center == b.center) || a.radius != b.radius;
  parts.assignment = parts.assignment || a.material != b.material;
  parts.output = parts.output || a.name != b.name || a.group != b.group;
}

/// The keys of [[rod]].
void compare_rods(const Rod& a, const Rod& b, Parts& parts) {
  parts.geometry = parts.geometry || !(a.from == b.from) || !(a.to == b.to) || a.radius != b.radius;
  parts.assignment = parts.assignment || a.materials != b.materials;
  parts.output = parts.output || a.name != b.name || a.group != b.group;
}

void compare_rod_files(const RodFile& before, const RodFile& after, Parts& parts) {
  compare(rod_file_keys(), Part::kGeometry, before, after, parts);
  if (before.materials != after.materials) parts.add(Part::kAssignment);
}

void compare_points(const PointsKeys& before, const PointsKeys& after, Parts& parts) {
  compare(points_keys(), Part::kGeometry, before, after, parts);
  if (before.bonds.are_drawn != after.bonds.are_drawn) parts.add(Part::kGeometry);
  if (before.material != after.material || before.bonds.material != after.bonds.material) parts.add(Part::kAssignment);
}

void compare_scenes(const Scene& before, const Scene& after, Parts& parts) {
  for (const Table& table : tables()) compare(table.keys, table.part, before, after, parts);
  compare_lists(before.spheres, after.spheres, parts, compare_spheres);
  compare_lists(before.rods, after.rods, parts, compare_rods);
}

}  // namespace

void Parts::add(Part part) {
  constexpr bool Parts::*kMembers[] = {&Parts::geometry, &Parts::assignment, &Parts::look, &Parts::view,
                                       &Parts::output};
  this->*kMembers[static_cast<std::size_t>(part)] = true;
}

Parts changed_parts(const Scene& before, const Scene* closing_before, const Scene& after, const Scene* closing_after) {
  Parts parts;
  compare_scenes(before, after, parts);
  compare_materials(before.materials, after.materials, parts);
  compare_lists(before.rod_files, after.rod_files, parts, compare_rod_files);
  compare_lists(before.points, after.points, parts, compare_points);
  if ((closing_before == nullptr) != (closing_after == nullptr)) {
    parts.add(Part::kGeometry);
    parts.add(Part::kView);
  } else if (closing_before != nullptr) {
    compare_scenes(*closing_before, *closing_after, parts);
  }
  return parts;
}

}  // namespace orrery::scene
