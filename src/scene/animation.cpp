// SPDX-License-Identifier: Apache-2.0
#include "scene/animation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include "base/text.h"
#include "scene/schema.h"

namespace orrery::scene {
namespace {

bool is_number(ValueType type) { return type == ValueType::kNumber || type == ValueType::kVector; }

/// True for the tables whose numbers can be animated; those of the other tables apply to the whole animation.
bool is_singleton_table(const std::string& table) { return table == "camera" || table == "background"; }

template <class Target>
const Key<Target>* find_key(const std::vector<Key<Target>>& keys, const std::string& name) {
  for (const Key<Target>& key : keys)
    if (key.name == name && is_number(key.type)) return &key;
  return nullptr;
}

/// Returns the index of the sphere or rod with this index ("3") or name.
template <class Object>
std::optional<std::size_t> find_object(const std::vector<Object>& objects, const std::string& name, bool is_index) {
  if (is_index) {
    std::size_t i = 0;
    return base::from_text(name, i) && i < objects.size() ? std::optional(i) : std::nullopt;
  }
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].name == name) return i;
  return {};
}

template <class Object>
std::optional<Animated> animated_object(const Scene& scene, std::vector<Object> Scene::*objects,
                                        const std::vector<Key<Object>>& keys, const std::string& name, bool is_index,
                                        const std::string& key_name) {
  const auto* key = find_key(keys, key_name);
  const std::optional<std::size_t> i = find_object(scene.*objects, name, is_index);
  if (key == nullptr || !i) return {};
  return Animated{key->type, key->range, [=](Scene& s, const Value& v) { key->set((s.*objects)[*i], v); }};
}

std::optional<Animated> animated_material(const Scene& scene, const std::string& name, const std::string& key_name) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (scene.materials[i].name != name) continue;
    const auto* key = find_key(type_of(scene.materials[i].model).keys, key_name);
    if (key == nullptr) return {};
    for (const TexturedKey& textured : type_of(scene.materials[i].model).textured)
      if (textured.name == key_name && textured.get(scene.materials[i].model)) return {};
    return Animated{key->type, key->range, [key, i](Scene& s, const Value& v) { key->set(s.materials[i].model, v); }};
  }
  return {};
}

/// The parts of "sphere[3].center" or "material.gold.fuzz"; the name is empty in "camera.vfov".
struct TargetParts {
  std::string table, name, key;
  bool is_index = false;
};

std::optional<TargetParts> parts_of(const std::string& target) {
  const std::size_t last = target.rfind('.');
  const std::size_t first = target.find_first_of(".[");
  if (last == std::string::npos || first > last) return {};
  TargetParts out{target.substr(0, first), {}, target.substr(last + 1), target[first] == '['};
  if (first == last) return out;
  out.name = target.substr(first + 1, last - first - 1);
  if (!out.is_index) return out;
  if (out.name.empty() || out.name.back() != ']') return {};
  out.name.pop_back();
  return out;
}

/// Returns the slope at key i from its two neighbours, at the ends from the only one.
Vec3d slope(const Track& t, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, t.frames.size() - 1);
  const double span = t.frames[after] - t.frames[before];
  return span > 0 ? (t.values[after] - t.values[before]) * (1 / span) : Vec3d{0, 0, 0};
}

/// Rotates a vector about a unit axis.
///
/// Precision  sine and cosine are rounded from long double, so that they do not depend on the math library
/// Reference  rodrigues1840
Vec3d rotated(Vec3d v, Vec3d axis, double turns) {
  const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(turns - std::floor(turns));
  const auto c = static_cast<double>(std::cos(angle)), s = static_cast<double>(std::sin(angle));
  return v * c + math::cross(axis, v) * s + axis * (math::dot(axis, v) * (1 - c));
}

}  // namespace

std::optional<Animated> find_animated(const Scene& scene, const std::string& target) {
  const std::optional<TargetParts> parts = parts_of(target);
  if (!parts) return {};
  if (parts->table == "sphere")
    return animated_object(scene, &Scene::spheres, sphere_keys(), parts->name, parts->is_index, parts->key);
  if (parts->table == "rod")
    return animated_object(scene, &Scene::rods, rod_keys(), parts->name, parts->is_index, parts->key);
  if (parts->table == "material" && !parts->is_index) return animated_material(scene, parts->name, parts->key);
  if (!parts->name.empty() || !is_singleton_table(parts->table)) return {};
  for (const Table& t : tables())
    if (t.name == parts->table)
      if (const auto* found = find_key(t.keys, parts->key)) return Animated{found->type, found->range, found->set};
  return {};
}

std::vector<std::string> indexed_targets(const Scene& scene, const std::string& target) {
  const std::optional<TargetParts> parts = parts_of(target);
  std::vector<std::string> out;
  const auto add = [&](const auto& objects) {
    const auto add_one = [&](std::size_t i) { out.push_back(fmt::format("{}[{}].{}", parts->table, i, parts->key)); };
    if (parts->is_index) {
      if (const auto i = find_object(objects, parts->name, true)) add_one(*i);
      return;
    }
    for (std::size_t i = 0; i < objects.size(); ++i)
      if (objects[i].name == parts->name) add_one(i);
  };
  if (parts && parts->table == "sphere") add(scene.spheres);
  if (parts && parts->table == "rod") add(scene.rods);
  return out;
}

std::vector<std::string> animated_names(const Scene& scene) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& owner, const auto& keys) {
    for (const auto& key : keys)
      if (is_number(key.type)) names.push_back(fmt::format("{}.{}", owner, key.name));
  };
  for (const Table& table : tables())
    if (is_singleton_table(table.name)) add(table.name, table.keys);
  for (const Sphere& sphere : scene.spheres)
    if (!sphere.name.empty()) add("sphere." + sphere.name, sphere_keys());
  for (const Rod& rod : scene.rods)
    if (!rod.name.empty()) add("rod." + rod.name, rod_keys());
  for (const Material& material : scene.materials) add("material." + material.name, type_of(material.model).keys);
  return names;
}

Vec3d value_at(const Track& track, double frame) {
  const std::vector<double>& at = track.frames;
  const auto after = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), frame) - at.begin());
  if (after == 0) return track.values.front();
  const std::size_t i = after - 1;
  if (after == at.size() || track.interpolation == Interpolation::kHold) return track.values[i];
  const double span = at[after] - at[i], t = (frame - at[i]) / span;
  const Vec3d a = track.values[i], b = track.values[after];
  if (track.interpolation == Interpolation::kLinear) return a + (b - a) * t;
  const double u = t * t * (3 - 2 * t);
  return a + (b - a) * u + slope(track, i) * (span * t * (1 - t) * (1 - t)) -
         slope(track, after) * (span * t * t * (1 - t));
}

Scene posed(const Scene& scene, double frame) {
  Scene out = scene;
  for (const Track& track : scene.tracks) {
    const std::optional<Animated> target = find_animated(scene, track.target);
    if (!target) continue;
    const Vec3d v = value_at(track, frame);
    target->set(out, target->type == ValueType::kVector ? Value(v) : Value(v.x));
  }
  if (out.animation.turntable != 0) {
    Camera& camera = out.camera;
    const double length = math::length(camera.up);
    camera.look_from = camera.look_at + rotated(camera.look_from - camera.look_at, camera.up * (1 / length),
                                                (frame - 1) / out.animation.turntable);
  }
  return out;
}

}  // namespace orrery::scene
