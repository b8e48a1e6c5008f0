// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/changed_parts.h"
#include "scene/value.h"

/// The schema of scene files: the only description of all keys, used for reading, validation, `--set`, suggestions,
/// `--settings` and the documentation. Defaults are the member initialisers in scene/scene.h.
namespace orrery::scene {

enum class TextureType;
enum class TextureUse;
struct Texture;

/// Formats a window for a scene file: "[0, 0, 640, 360]".
std::string window_text(const Window& window);

/// Formats an interval for a scene file: "[0, 12]".
std::string interval_text(const Interval& interval);

/// One key of a table in a scene file. A dotted name is that of a key in a subtable: "radius.column" is `column` in
/// `radius = { column = "diameter" }`.
template <class Target>
struct Key {
  std::string name;
  ValueType type;
  Range range;                       ///< numbers and vectors
  std::vector<std::string> choices;  ///< kChoice, kChoices
  std::string unit;                  ///< may be empty
  std::string doc;                   ///< description, one line of Markdown
  std::string cost;                  ///< cost in time or memory; may be empty
  bool required;
  std::function<void(Target&, const Value&)> set;
  std::function<std::string(const Target&)> text;  ///< value as written in a scene file
  std::optional<Part> part = {};                   ///< what the key changes; empty: as the other keys of its table
};

/// A table that a scene has at most once; keys in documentation order.
struct Table {
  std::string name;
  Part part;  ///< what its keys change, unless they say otherwise
  std::vector<Key<Scene>> keys;
};
const std::vector<Table>& tables();

/// A type of texture: the keys that a material's key has in addition to `texture` if its value is a texture.
struct TextureTypeKeys {
  std::string name;
  std::string doc;
  TextureType type;
  std::vector<Key<Texture>> keys;
};
const std::vector<TextureTypeKeys>& texture_types(TextureUse use);

/// A key of a material whose value may be a texture.
struct TexturedKey {
  std::string name;
  TextureUse use;
  std::function<TextureSlot&(MaterialModel&)> at;

  /// The texture; null if the key has a constant.
  TextureSlot get(const MaterialModel& model) const { return at(const_cast<MaterialModel&>(model)); }
};

/// A type of material: the keys that [material.NAME] has in addition to `type`.
struct MaterialType {
  std::string name;
  std::string doc;
  MaterialModel model;  ///< default values
  std::vector<Key<MaterialModel>> keys;
  std::vector<TexturedKey> textured = {};  ///< the keys whose values may be textures
};
const std::vector<MaterialType>& material_types();

/// Keys of [[sphere]] and [[points]], except `material`. They change the geometry, unless they say otherwise.
const std::vector<Key<Sphere>>& sphere_keys();
const std::vector<Key<Points>>& points_keys();

}  // namespace orrery::scene
