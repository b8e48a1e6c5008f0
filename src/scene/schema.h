// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "scene/scene.h"
#include "scene/value_text.h"

/// Everything that reading, checking, `--set`, suggestions, `--settings` and the documentation know of the keys of a
/// scene file, in one place. Defaults are not here: they are the values of the members of scene/scene.h.
namespace orrery::scene {

/// What a key of the scene file can hold.
using Value = std::variant<std::int64_t, double, Vec3d, std::string, std::vector<std::string>, Window>;

enum class ValueType { kInteger, kNumber, kVector, kText, kChoice, kChoices, kWindow };

/// Numbers from..to, ends included unless `open` says otherwise; for a vector each component.
struct Range {
  double from = 0, to = 0;
  bool from_open = false, to_open = false;

  bool contains(double x) const { return (from_open ? x > from : x >= from) && (to_open ? x < to : x <= to); }
  /// "0..1", "above 0, below 180".
  std::string text() const;
};

/// "[0, 0, 640, 360]".
std::string window_text(const Window& window);

/// One key of a table of the scene file.
template <class Target>
struct Key {
  std::string name;
  ValueType type;
  Range range;                       ///< numbers and vectors
  std::vector<std::string> choices;  ///< kChoice, kChoices
  std::string unit;                  ///< may be empty
  std::string doc;                   ///< what it is, one line of Markdown
  std::string cost;                  ///< what it costs in time or memory; may be empty
  bool required;
  std::function<void(Target&, const Value&)> set;
  std::function<std::string(const Target&)> text;  ///< as it would stand in the file
};

/// Tables of which a scene has one; keys in the order of the documentation.
struct Table {
  std::string name;
  std::vector<Key<Scene>> keys;
};
const std::vector<Table>& tables();

/// Keys of [material.NAME] beside `type`, for one type.
struct MaterialType {
  std::string name;
  std::string doc;
  MaterialModel model;  ///< with its defaults
  std::vector<Key<MaterialModel>> keys;
};
const std::vector<MaterialType>& material_types();

/// Keys of [[sphere]] and [[points]] beside `material`, which names one.
const std::vector<Key<Sphere>>& sphere_keys();
const std::vector<Key<Points>>& points_keys();

}  // namespace orrery::scene
