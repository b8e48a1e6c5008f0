// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::scene {

struct FileRole;

/// A file that a scene names.
struct NamedFile {
  const FileRole* role;  ///< see scene/schema.h
  std::string name;      ///< as in the scene: relative to its folder
};

/// All files that a scene names, as the schema says of each key.
std::vector<NamedFile> named_files(const Scene& scene);

/// Replaces the name of every file by the one that `renamed` returns.
void rename_files(Scene& scene, const std::function<std::string(const NamedFile& file)>& renamed);

}  // namespace orrery::scene
