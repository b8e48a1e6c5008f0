// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::scene {
namespace {

/// Calls `visit(key, file)` for each key that names a file.
template <class Target, class Visit>
void visit_files(const std::vector<Key<Target>>& keys, const Target& target, Visit visit) {
  for (const Key<Target>& key : keys) {
    if (key.file == nullptr) continue;
    const std::optional<Value> value = key.get(target);
    const std::string name = value ? std::get<std::string>(*value) : "";
    if (key.file->names_file != nullptr ? key.file->names_file(name) : !name.empty())
      visit(key, NamedFile{key.file, name});
  }
}

}  // namespace

std::vector<NamedFile> named_files(const Scene& scene) {
  std::vector<NamedFile> out;
  const auto add = [&](const auto&, const NamedFile& file) { out.push_back(file); };
  for (const Table& table : tables()) visit_files(table.keys, scene, add);
  for (const NamedTexture& t : textures(scene)) visit_files(type_of(*t.texture, t.use).keys, *t.texture, add);
  for (const PointsKeys& points : scene.points) visit_files(points_keys(), points, add);
  for (const RodFile& rods : scene.rod_files) visit_files(rod_file_keys(), rods, add);
  return out;
}

void rename_files(Scene& scene, const std::function<std::string(const NamedFile& file)>& renamed) {
  const auto rename_in = [&](const auto& keys, auto& target) {
    visit_files(keys, target, [&](const auto& key, const NamedFile& file) { key.set(target, renamed(file)); });
  };
  for (const Table& table : tables()) rename_in(table.keys, scene);
  modify_textures(scene, [&](Texture& texture, TextureUse use) { rename_in(type_of(texture, use).keys, texture); });
  for (PointsKeys& points : scene.points) rename_in(points_keys(), points);
  for (RodFile& rods : scene.rod_files) rename_in(rod_file_keys(), rods);
}

}  // namespace orrery::scene
