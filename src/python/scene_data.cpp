// SPDX-License-Identifier: Apache-2.0
#include "python/scene_data.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_set.h"
#include "base/hash.h"
#include "base/input_file.h"
#include "base/text.h"
#include "data/data_file.h"
#include "data/write_table.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "load/write_scene.h"
#include "scene/schema.h"

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
std::string table_file_name(const fs::path& scene_file, const std::string& name, const data::Table& table) {
  const bool is_ply = std::all_of(table.columns.begin(), table.columns.end(), data::is_storable_in_ply);
  return scene_file.stem().string() + "." + name + (is_ply ? ".ply" : ".npy");
}

/// Returns whether save() wrote an existing data file. NPY cannot store the writer's name; such a file belongs to the
/// scene file that names it, which save() replaces.
bool is_saved_data(const fs::path& file, const fs::path& scene_file) {
  if (file.extension() == ".ply") return load::is_ply_of(kWriter, file);
  try {
    const std::vector<scene::Points> points = load::authored_scene({.file = scene_file}).points;
    return std::any_of(points.begin(), points.end(), [&](const auto& p) { return p.file == file.filename(); });
  } catch (const base::Error&) {
    return false;
  }
}

void check_data_file(const fs::path& file, const fs::path& scene_file) {
  std::error_code ignored;
  if (fs::exists(file, ignored) && !is_saved_data(file, scene_file))
    throw base::FileError(base::ErrorKind::kCannotCreate,
                          "cannot create " + file.string() +
                              ": the existing file was not written by save(); move it, or choose another name",
                          file, EEXIST);
}

/// Identifies the contents of a table: the owner of an array may change its values between two renders.
std::string contents_of(const data::Table& table) {
  std::string out;
  for (const data::Column& column : table.columns) {
    base::Hash hash;
    const auto add = [&](auto value) {
      if constexpr (std::is_floating_point_v<decltype(value)>)
        hash.add(static_cast<double>(value));
      else
        hash.add_bits(static_cast<std::uint64_t>(value));
    };
    std::visit(
        [&](const auto& values) {
          if constexpr (requires { values.words; }) {
            for (const std::string& word : values.words) out += word + '\n';
            for (const std::uint32_t index : values.index) add(index);
          } else {
            for (std::size_t i = 0; i < values.size(); ++i) add(values[i]);
          }
        },
        column.values);
    out += fmt::format("{}: {} {} {}\n", column.name, column.values.index(), column.size(), hash.text());
  }
  return out;
}

load::SceneRequest request_of(const SceneData& scene, std::uint64_t memory_limit = 0) {
  load::SceneRequest out;
  out.source = scene.source();
  out.memory_limit = memory_limit;
  return out;
}

}  // namespace

load::SceneSource SceneData::source() const {
  load::SceneSource out;
  out.file = file;
  out.text = std::make_shared<const std::string>(text);
  out.has_file = is_file;
  for (const std::string& setting : overrides) out.overrides.add(setting, true);
  out.frame = frame;
  out.typed_lines = typed_lines;
  if (tables.empty()) return out;
  const auto find = [own = std::make_shared<const Tables>(tables), folder = file.parent_path()](const fs::path& path) {
    const auto found = own->find(path.filename().string());
    return found != own->end() && path == folder / found->first ? &*found : nullptr;
  };
  out.open_data = [find](const fs::path& path, const data::OpenOptions& options) {
    const auto* const own = find(path);
    return own != nullptr ? data::settled(data::open_table(own->first, own->second)) : data::open(path, options);
  };
  out.data_version = [find](const fs::path& path) {
    const auto* const own = find(path);
    return own != nullptr ? contents_of(*own->second) : base::file_version(path);
  };
  return out;
}

std::string read_scene_text(const fs::path& file) {
  std::string text = load::read_file(file, load::kLargestSceneFile);
  static_cast<void>(load::authored_scene({.file = file, .text = std::make_shared<const std::string>(text)}));
  return text;
}

void check_keys(const SceneData& scene) { static_cast<void>(load::read_with_data(request_of(scene))); }

std::vector<base::Diagnostic> check(const SceneData& scene) { return load::load_scene(request_of(scene)).warnings; }

double aspect(const SceneData& scene) {
  const scene::Image image = load::authored_scene(scene.source()).image;
  return image.pixel_aspect * image.width / image.height;
}

double largest_radius(const SceneData& scene, std::uint64_t memory_limit) {
  double out = 0;
  try {
    for (const scene::Points& points : load::read_with_data(request_of(scene, memory_limit)).scene.points)
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
  for (const auto& [name, table] : scene.tables) {
    const fs::path data = folder / table_file_name(file, name, *table);
    files.add_output(data, "points file");
    check_data_file(data, file);
  }
  scene::Scene saved = load::authored_scene(source);
  scene::rename_files(saved, [&](const scene::NamedFile& named) {
    const auto table = scene.tables.find(named.name);
    return table != scene.tables.end() ? table_file_name(file, named.name, *table->second)
                                       : moved(named.name, scene.file.parent_path(), folder);
  });
  const std::string text = load::scene_text(saved, {});
  for (const auto& [name, table] : scene.tables)
    static_cast<void>(data::write_table(folder / table_file_name(file, name, *table), *table, {}, kWriter));
  base::write_text_file(file, text);
}

}  // namespace orrery::python
