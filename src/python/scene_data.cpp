// SPDX-License-Identifier: Apache-2.0
#include "python/scene_data.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/file_set.h"
#include "base/output_file.h"
#include "data/table_file.h"
#include "format/named_files.h"
#include "format/read_result.h"
#include "format/source_text.h"
#include "format/write_ply.h"
#include "format/write_tree.h"
#include "load/load_scene.h"
#include "load/loaded_scene.h"
#include "load/scene_files.h"
#include "particles/open.h"
#include "particles/write_table.h"

namespace orrery::python {
namespace {

namespace fs = std::filesystem;

/// Makes a file name relative to another folder. Absolute names are unchanged.
std::string moved(const std::string& name, const fs::path& from, const fs::path& to) {
  if (fs::path(name).is_absolute()) return name;
  const auto absolute = [](const fs::path& folder) { return fs::absolute(folder / "").lexically_normal(); };
  const fs::path old_folder = absolute(from.empty() ? "." : from), folder = absolute(to.empty() ? "." : to);
  return old_folder == folder ? name : (old_folder / name).lexically_normal().lexically_relative(folder).string();
}

/// Named in the data files of saved scenes, which save() may replace.
constexpr const char* kWriter = "orrery Scene.save";

/// The data file of a table next to the scene file.
std::string table_file_name(const fs::path& scene_file, const std::string& table) {
  return scene_file.stem().string() + "." + table + ".ply";
}

void check_data_file(const fs::path& file) {
  base::check_creatable(file);
  std::error_code ignored;
  if (fs::exists(file, ignored) && !format::is_ply_of(kWriter, file))
    throw base::Error(base::ErrorKind::kCannotCreate,
                      "cannot create " + file.string() +
                          ": the existing file was not written by save(); move it, or choose another name");
}

}  // namespace

load::SceneSource SceneData::source() const {
  load::SceneSource out;
  out.file = file;
  out.text = std::make_shared<const std::string>(text);
  out.has_file = is_file;
  for (const std::string& setting : overrides) out.overrides.add(setting, true);
  out.frame = frame;
  if (!tables.empty())
    out.open_data = [own = tables, folder = file.parent_path()](const fs::path& path,
                                                                const data::OpenOptions& options) {
      for (const auto& [name, table] : own)
        if (path == folder / name) return data::open_table(name, table);
      return particles::open(path, options);
    };
  return out;
}

std::string read_scene_text(const fs::path& file) {
  std::string text = format::read_file(file, format::kLargestSceneFile);
  static_cast<void>(format::named_files(file, {}, &text));
  return text;
}

std::vector<base::Diagnostic> check(const SceneData& scene) {
  load::SceneRequest request;
  request.source = scene.source();
  return load::load_scene(request).warnings;
}

double largest_radius(const SceneData& scene, std::uint64_t memory_limit) {
  load::SceneRequest request;
  request.source = scene.source();
  request.memory_limit = memory_limit;
  double out = 0;
  try {
    for (const scene::Points& points : load::read_with_data(request).scene.points)
      for (const double radius : points.radii) out = std::max(out, std::abs(radius));
  } catch (const base::Error&) {
    return 0;
  }
  return out;
}

void save(const SceneData& scene, const fs::path& file) {
  static_cast<void>(check(scene));
  const load::SceneSource source = scene.source();
  const fs::path folder = file.parent_path();
  base::FileSet files;
  if (scene.is_file) files.add_input(scene.file, "scene");
  load::add_named_files(source, {scene.frame}, files);
  files.add_output(file, "save()");
  base::check_creatable(file);
  for (const auto& [name, table] : scene.tables) {
    files.add_output(folder / table_file_name(file, name), "points file");
    check_data_file(folder / table_file_name(file, name));
  }
  const auto renamed = [&](const std::string& name) {
    return scene.tables.count(name) != 0 ? table_file_name(file, name) : moved(name, scene.file.parent_path(), folder);
  };
  const std::string text = format::merged_text(scene.file, scene.text, source.overrides, renamed);
  for (const auto& [name, table] : scene.tables)
    static_cast<void>(
        particles::write_table(folder / table_file_name(file, name), *table, kWriter));  // all are numbers
  base::write_text_file(file, text);
}

}  // namespace orrery::python
