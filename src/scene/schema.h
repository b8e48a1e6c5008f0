// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/changed_parts.h"
#include "scene/value_text.h"

/// The schema of scene files: the description of all keys, used for reading, writing, validation, `--set`, suggestions,
/// `--settings`, the files that a scene names and the documentation. Defaults are the member initialisers in
/// scene/scene.h. Not in it are five keys that refer to materials by name, `material` of [[sphere]],
/// [[points]], [[rod]] and [[rods]], and `bonds.material` of [[points]]; and what a [[key]] animates.
namespace orrery::scene {

enum class TextureType;
enum class TextureUse;
struct Texture;

/// What a file is to the scene that names it.
struct FileRole {
  const char* name;         ///< for messages
  bool has_frames = false;  ///< the name may be a pattern for a sequence of files
  /// Returns whether a value names a file; null: unless it is empty.
  bool (*names_file)(const std::string& value) = nullptr;
};
extern const FileRole kPointsFile, kTopologyFile, kRodsFile, kColorMapFile, kBackgroundFile, kTextureFile, kFontFile,
    kOcioConfigFile;

/// Documentation of a key.
struct KeyDoc {
  std::string doc;        ///< description, one line of Markdown
  std::string unit = {};  ///< may be empty
  std::string cost = {};  ///< cost in time or memory; may be empty
};

/// What is known of a key, whatever its table holds. A dotted name is that of a key in a subtable: "radius.column" is
/// `column` in `radius = { column = "diameter" }`.
struct KeyFacts : KeyDoc {
  std::string name;
  ValueType type;
  Range range;                       ///< numbers and vectors
  std::vector<std::string> choices;  ///< kChoice, kChoices
  bool required = false;
  std::string otherwise = {};      ///< default of a key that may have no value, for the documentation
  std::optional<Part> part = {};   ///< what the key changes; empty: as the other keys of its table
  const FileRole* file = nullptr;  ///< the value is the name of a file
};

/// One key of a table in a scene file.
template <class Target>
struct Key : KeyFacts {
  std::function<void(Target&, const Value&)> set;
  std::function<std::optional<Value>(const Target&)> get;  ///< nullopt: no value, as if the key were not in the file

  /// The value as written in a scene file.
  std::string text(const Target& target) const {
    const std::optional<Value> value = get(target);
    return value ? value_text(*value) : otherwise;
  }
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
/// In the order of TextureType.
const std::vector<TextureTypeKeys>& texture_types(TextureUse use);
/// The type of a texture.
const TextureTypeKeys& type_of(const Texture& texture, TextureUse use);

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
/// In the order of the alternatives of MaterialModel.
const std::vector<MaterialType>& material_types();
/// The type of a material.
const MaterialType& type_of(const MaterialModel& model);

/// Keys of [[sphere]] and [[points]], except `material`. They change the geometry, unless they say otherwise.
const std::vector<Key<Sphere>>& sphere_keys();
const std::vector<Key<PointsKeys>>& points_keys();
/// Keys of [[rod]] and [[rods]], except `material`.
const std::vector<Key<Rod>>& rod_keys();
const std::vector<Key<RodFile>>& rod_file_keys();
/// Keys of [[key]], except `target`, `frames` and `values`.
const std::vector<Key<Track>>& track_keys();

/// A file that a scene names.
struct NamedFile {
  const FileRole* role;
  std::string name;  ///< as in the scene: relative to its folder
};

/// All files that a scene names.
std::vector<NamedFile> named_files(const Scene& scene);

/// Replaces the name of every file by the one that `renamed` returns.
void rename_files(Scene& scene, const std::function<std::string(const NamedFile& file)>& renamed);

}  // namespace orrery::scene
