// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "load/load_scene.h"

namespace orrery::python {

/// Tables of arrays, by the name that [[points]] gives as its file.
using Tables = std::map<std::string, std::shared_ptr<const data::Table>>;

/// A scene as Python holds it: the text of a scene file, overrides, and tables of arrays in place of data files.
struct SceneData {
  std::filesystem::path file;  ///< scene file
  bool is_file = false;        ///< false: the scene was made in Python, and `file` is only its name
  std::string text;
  int typed_lines = 0;  ///< lines at the beginning of `text` that are those of the scene file
  std::vector<std::string> overrides;
  int frame = 1;
  Tables tables;

  /// The scene as a job reads it. The memory of the arrays must outlive the result's use.
  load::SceneSource source() const;
};

/// Reads the text of a scene file and checks that it is TOML.
///
/// Errors     base::Error: those of load::load_scene, except those for keys and data files
std::string read_scene_text(const std::filesystem::path& file);

/// Checks the keys of [[sphere]] and [[points]], and the names of columns and colour maps.
///
/// Errors     those of load::load_scene
void check_keys(const SceneData& scene);

/// Returns the width of the image divided by its height, as displayed. Keys that cannot be read have their defaults.
///
/// Errors     those of load::authored_scene
double aspect(const SceneData& scene);

/// Checks everything that a render would reject.
///
/// Result     warnings
/// Errors     those of load::load_scene
std::vector<base::Diagnostic> check(const SceneData& scene);

/// Returns the largest absolute radius of the spheres of all [[points]], scene units; 0 if there are none, or if the
/// scene has errors, which a render reports.
///
/// `memory_limit`   maximum memory for reading the spheres, bytes; 0: the free memory
double largest_radius(const SceneData& scene, std::uint64_t memory_limit);

/// Writes the scene as a scene file, and its arrays as PLY files next to it, or as NPY files if they have strings. Both
/// read back to the same scene. A data file is replaced only if save() wrote it.
///
/// Errors     those of check(); base::Error: kUsage if a file is an input of the scene; kCannotCreate; kIo
void save(const SceneData& scene, const std::filesystem::path& file);

}  // namespace orrery::python
