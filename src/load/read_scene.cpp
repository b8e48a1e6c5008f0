// SPDX-License-Identifier: Apache-2.0
#include "load/read_scene.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "base/input_file.h"
#include "base/text.h"
#include "data/data_file.h"
#include "display/settings.h"
#include "load/load_images.h"
#include "load/read_keys.h"
#include "scene/animation.h"
#include "scene/layers.h"
#include "scene/limits.h"
#include "scene/validate.h"

namespace orrery::load {
namespace {

/// Returns an array of tables; null if it is absent, or if it is not an array of tables, which is reported once.
const toml::array* tables_under(ReadState& state, const toml::table& root, const char* name) {
  const toml::node* node = root.get(name);
  if (node == nullptr) return nullptr;
  const toml::array* array = node->as_array();
  if (array == nullptr || (!array->empty() && !array->is_array_of_tables())) {
    state.error(place_of(*node), fmt::format("`{}` must be an array of tables", name),
                fmt::format("write [[{}]]", name));
    return nullptr;
  }
  return array;
}

void read_single_tables(ReadState& state, const toml::table& root, scene::Scene& scene) {
  for (const scene::Table& table : scene::tables()) {
    const toml::node* node = root.get(table.name);
    if (node == nullptr) continue;
    if (const toml::table* found = node->as_table()) {
      read_keys(state, *found, table.name, table.keys, {}, scene);
    } else {
      state.error(place_of(*node), fmt::format("`{}` must be a table", table.name),
                  fmt::format("write [{}]", table.name));
    }
  }
}

/// Calls `read(table, its full name)` for each table of an array of tables.
template <class Read>
void for_each_table(ReadState& state, const toml::table& root, const char* name, Read read) {
  const toml::array* const list = tables_under(state, root, name);
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
    read(*list->get(i)->as_table(), fmt::format("{}[{}]", name, i));
}

/// Reads the keys that name materials, as indices into the materials of the scene. A name that is not defined, which is
/// reported, has index 0.
class MaterialNames {
 public:
  MaterialNames(ReadState& state, const std::vector<scene::Material>& materials) : state_(state) {
    for (const scene::Material& material : materials) {
      index_.emplace(material.name, static_cast<std::uint32_t>(index_.size()));
      names_.push_back(material.name);
    }
  }

  /// The material that a node names.
  std::uint32_t at(const toml::node& node, const std::string& full_name) {
    if (node.is_table()) {
      state_.error(place_of(node), full_name + " must be the name of a material, not a table",
                   "write the table as [material.NAME], and here material = \"NAME\"");
      state_.unread.insert(full_name);
      return 0;
    }
    const auto value = read_value(state_, node, full_name, scene::ValueType::kText, {}, {});
    if (value) {
      const auto& name = std::get<std::string>(*value);
      if (const auto found = index_.find(name); found != index_.end()) return found->second;
      constexpr std::size_t kMaxNamed = 12;
      std::string remedy = base::did_you_mean(name, names_);
      if (remedy.empty() && names_.empty()) remedy = "the scene defines no materials";
      if (remedy.empty() && names_.size() <= kMaxNamed) remedy = "defined are " + base::joined(names_);
      state_.error(place_of(node), fmt::format("{} is \"{}\", which is not defined", full_name, name), remedy);
    }
    state_.unread.insert(full_name);
    return 0;
  }

  /// The material of a sphere or a points file.
  std::uint32_t of(const toml::table& table, const std::string& table_name) {
    const toml::node* const node = node_of(table, table_name);
    return node != nullptr ? at(*node, table_name + ".material") : 0;
  }

  /// The materials of a rod's halves, which may have one name for both.
  std::array<std::uint32_t, 2> of_halves(const toml::table& table, const std::string& table_name) {
    const toml::node* const node = node_of(table, table_name);
    if (node == nullptr) return {0, 0};
    const std::string full_name = table_name + ".material";
    const toml::array* const names = node->as_array();
    if (names == nullptr) {
      const std::uint32_t both = at(*node, full_name);
      return {both, both};
    }
    if (names->size() == 2) return {at(*names->get(0), full_name + "[0]"), at(*names->get(1), full_name + "[1]")};
    state_.error(place_of(*node), fmt::format("{} has {} names", full_name, names->size()),
                 "write one name, or two: those of the halves at `from` and at `to`");
    state_.unread.insert(full_name);
    return {0, 0};
  }

 private:
  /// Returns the node of the key `material`; null, and an error is reported, if there is none.
  const toml::node* node_of(const toml::table& table, const std::string& table_name) {
    const toml::node* const node = table.get("material");
    if (node == nullptr) {
      state_.error(place_of(table), table_name + " needs `material`");
      state_.unread.insert(table_name + ".material");
    }
    return node;
  }

  ReadState& state_;
  std::unordered_map<std::string, std::uint32_t> index_;
  std::vector<std::string> names_;
};

void read_spheres(ReadState& state, const toml::table& root, MaterialNames& materials, scene::Scene& scene) {
  for_each_table(state, root, "sphere", [&](const toml::table& table, const std::string& name) {
    scene::Sphere& sphere = scene.spheres.emplace_back();
    read_keys(state, table, name, scene::sphere_keys(), {"material"}, sphere);
    sphere.material = materials.of(table, name);
  });
}

void read_rods(ReadState& state, const toml::table& root, MaterialNames& materials, scene::Scene& scene) {
  for_each_table(state, root, "rod", [&](const toml::table& table, const std::string& name) {
    scene::Rod& rod = scene.rods.emplace_back();
    read_keys(state, table, name, scene::rod_keys(), {"material"}, rod);
    rod.materials = materials.of_halves(table, name);
  });
}

/// Returns the node that a diagnostic's key names, or the closest enclosing table; null if there is none.
const toml::node* node_of(const toml::table& root, std::string key) {
  while (!key.empty()) {
    if (const auto found = toml::at_path(root, key)) return found.node();
    const std::size_t last = key.find_last_of(".[");
    key.resize(last != std::string::npos ? last : 0);
  }
  return nullptr;
}

/// Adds a diagnostic at the location of its key, or of the file if the key is not set.
void add_problem(ReadState& state, const toml::table& root, const std::string& file,
                 const scene::SceneDiagnostic& diagnostic, const std::string& text) {
  const toml::node* node = node_of(root, diagnostic.key);
  state.add(diagnostic.severity, node != nullptr ? place_of(*node) : Place{file, 0, 0, 1}, text, {}, diagnostic.kind);
}

void read_points(ReadState& state, const toml::table& root, const std::filesystem::path& folder,
                 MaterialNames& materials, scene::Scene& scene) {
  for_each_table(state, root, "points", [&](const toml::table& table, const std::string& name) {
    scene::PointsKeys& points = scene.points.emplace_back();
    read_keys(state, table, name, scene::points_keys(), {"material", "bonds.material"}, points);
    points.material = materials.of(table, name);
    if (const toml::node* const bonds = table.get("bonds"); bonds != nullptr && bonds->is_table())
      points.bonds.are_drawn = true;
    if (const auto node = toml::at_path(table, "bonds.material"))
      points.bonds.material = materials.at(*node.node(), name + ".bonds.material");
    if (base::is_sequence(folder / points.file)) points.sequence = points.file.string();
  });
}

void read_rod_files(ReadState& state, const toml::table& root, MaterialNames& materials, scene::Scene& scene) {
  for_each_table(state, root, "rods", [&](const toml::table& table, const std::string& name) {
    scene::RodFile& rods = scene.rod_files.emplace_back();
    read_keys(state, table, name, scene::rod_file_keys(), {"material"}, rods);
    rods.materials = materials.of_halves(table, name);
  });
}

/// The errors of the pose at shutter close that the pose at shutter open does not have. Only camera, spheres and rods
/// move while the shutter is open.
std::vector<scene::SceneDiagnostic> errors_at_close(const scene::Scene& opening, const scene::Scene& closing) {
  std::vector<scene::SceneDiagnostic> found = scene::validate(closing);
  std::erase_if(found, [](const scene::SceneDiagnostic& d) {
    return d.severity == base::Severity::kWarning ||
           !(d.key.starts_with("camera.") || d.key.starts_with("sphere[") || d.key.starts_with("rod["));
  });
  if (found.empty()) return found;
  const std::vector<scene::SceneDiagnostic> known = scene::validate(opening);
  std::erase_if(found, [&](const scene::SceneDiagnostic& d) {
    return std::any_of(known.begin(), known.end(), [&](const auto& k) { return k.key == d.key && k.text == d.text; });
  });
  return found;
}

/// Replaces the names of sequences of files by those of their files at a frame.
void choose_files(const std::filesystem::path& folder, int frame, scene::Scene& scene) {
  scene::rename_files(scene, [&](const scene::NamedFile& file) {
    return file.role->has_frames ? base::input_at_frame(folder, file.name, frame) : file.name;
  });
}

/// Poses the scene at the frame; with motion blur, at shutter open and at shutter close. With motion vectors, also in
/// the frames before and after.
void pose_scene(ReadState& state, const toml::table& root, const std::string& file, int frame, ReadResult& result) {
  scene::Scene& scene = result.scene;
  const scene::Camera& shutter = scene.camera;
  const bool is_open = shutter.shutter_close > shutter.shutter_open;
  const double opens = frame + (is_open ? shutter.shutter_open : 0), closes = frame + shutter.shutter_close;
  if (!scene.tracks.empty()) {
    check_tracks(state, *root.get("key")->as_array(), scene, opens);
    if (is_open) check_tracks(state, *root.get("key")->as_array(), scene, closes);
  }
  if (is_open) result.closing = scene::posed(scene, closes);
  if (base::contains(scene::requested_layers(scene), scene::kVectorLayer))
    result.neighbors = {scene::posed(scene, opens - 1), scene::posed(scene, opens + 1)};
  scene = scene::posed(scene, opens);
  if (!is_open) return;
  for (const scene::SceneDiagnostic& diagnostic : errors_at_close(scene, *result.closing))
    add_problem(state, root, file, diagnostic,
                fmt::format("{} when the shutter closes: {}", diagnostic.key, diagnostic.text));
  for (std::size_t i = 0; i < scene.spheres.size(); ++i)
    if ((scene.spheres[i].radius < 0) != (result.closing->spheres[i].radius < 0)) {
      const std::string key = fmt::format("sphere[{}].radius", i);
      add_problem(state, root, file, {base::Severity::kError, key, ""},
                  key + " changes sign while the shutter is open; keep it positive or negative");
    }
}

/// Whether an override sets what a track animates; the names of a sphere or rod, by index and by name, are the same.
bool sets_target(const Override& override, const scene::Track& track, const scene::Scene& scene) {
  if (override.sets(track.target)) return true;
  const auto is_of_object = [](const KeyValue& set) {
    return set.key.starts_with("sphere") || set.key.starts_with("rod");
  };
  if (std::none_of(override.values.begin(), override.values.end(), is_of_object))
    return false;  // names take time to find
  const std::vector<std::string> targets = scene::indexed_targets(scene, track.target);
  return targets.size() == 1 && override.sets(targets[0]);
}

/// A track replaces what an override sets.
void warn_of_animated_overrides(ReadState& state, const Overrides& overrides, const scene::Scene& scene) {
  for (std::size_t i = 0; i < overrides.size(); ++i)
    for (std::size_t t = 0; t < scene.tracks.size(); ++t)
      if (sets_target(overrides[i], scene.tracks[t], scene))
        state.add(base::Severity::kWarning, Place{kOverrideName, static_cast<int>(i) + 1, 1, 1},
                  fmt::format("{} is animated by key[{}], which takes precedence", scene.tracks[t].target, t),
                  "remove all animation with --set key=[]");
}

void report_unknown_tables(ReadState& state, const toml::table& root) {
  std::vector<std::string> known;
  for (const scene::Table& table : scene::tables()) known.push_back(table.name);
  known.insert(known.end(), {"material", "sphere", "points", "rod", "rods", "key"});
  for (const auto& [key, node] : root)
    if (!base::contains(known, key.str())) report_unknown_key(state, key, "the scene", known);
}

std::vector<Setting> settings_of(const SourceText& source, const toml::table& root, const scene::Scene& scene) {
  std::vector<Setting> settings;
  for (const scene::Table& table : scene::tables()) {
    const toml::table* written = root.get(table.name) != nullptr ? root.get(table.name)->as_table() : nullptr;
    for (const auto& key : table.keys) {
      const toml::node* node = written != nullptr ? written->get(key.name) : nullptr;
      std::string origin = "default";
      if (node != nullptr) {
        const Place place = place_of(*node);
        origin = place.text_name == kOverrideName ? source.option_at(place.line)
                                                  : place.text_name + ':' + std::to_string(place.line);
      }
      const std::string full_name = fmt::format("{}.{}", table.name, key.name);
      for (std::size_t i = 0; i < scene.tracks.size(); ++i)
        if (scene.tracks[i].target == full_name) origin = fmt::format("key[{}]", i);
      settings.push_back({full_name, key.text(scene), origin});
    }
  }
  return settings;
}

}  // namespace

struct SceneReader::State : ReadState {
  std::string file;
  toml::table root;
  ReadResult result;
};

SceneReader::SceneReader(const SceneSource& source, Pose pose) : state_(std::make_unique<State>()) {
  State& state = *state_;
  const std::string text = source.text ? *source.text : read_file(source.file, kLargestSceneFile);
  state.file = source.file.string();
  state.root = parse_tree(state.file, text, source.overrides, state);
  const toml::table& root = state.root;
  if (root.empty() && state.diagnostics.has_errors()) {
    // `plot` checks overrides with an empty scene beside the data file.
    if (!source.text || !text.empty()) refuse_data_file(source.file, text);
    state.diagnostics.raise_errors(state.file);
  }
  state.source.set_typed_lines(source.typed_lines);
  scene::Scene& scene = state.result.scene;
  report_unknown_tables(state, root);
  read_single_tables(state, root, scene);
  read_materials(state, root, scene.materials);
  MaterialNames materials(state, scene.materials);
  read_spheres(state, root, materials, scene);
  read_rods(state, root, materials, scene);
  if (const toml::array* keys = tables_under(state, root, "key")) read_tracks(state, *keys, scene);
  warn_of_animated_overrides(state, source.overrides, scene);
  const std::filesystem::path folder = source.file.parent_path();
  read_points(state, root, folder, materials, scene);
  read_rod_files(state, root, materials, scene);
  if (pose == Pose::kAuthored) return;
  choose_files(folder, source.frame, scene);
  if (!state.diagnostics.has_errors()) pose_scene(state, root, state.file, source.frame, state.result);
}

SceneReader::~SceneReader() = default;

scene::Scene& SceneReader::scene() { return state_->result.scene; }

std::optional<scene::Scene>& SceneReader::closing() { return state_->result.closing; }

bool SceneReader::has_errors() const { return state_->diagnostics.has_errors(); }

bool SceneReader::is_read(const std::string& name) const {
  const auto at = state_->unread.lower_bound(name);
  return at == state_->unread.end() || !at->starts_with(name);
}

void SceneReader::add(const std::vector<scene::SceneDiagnostic>& diagnostics) {
  State& state = *state_;
  const bool had_errors = has_errors(), camera_is_read = is_read("camera.");
  for (const scene::SceneDiagnostic& diagnostic : diagnostics) {
    if (had_errors && diagnostic.severity == base::Severity::kWarning) continue;
    if (state.unread.count(diagnostic.key) != 0 || (diagnostic.key.starts_with("camera.") && !camera_is_read)) continue;
    add_problem(state, state.root, state.file, diagnostic,
                diagnostic.key.empty() ? diagnostic.text : fmt::format("{}: {}", diagnostic.key, diagnostic.text));
  }
}

void SceneReader::add_file_error(const std::string& key, const base::Error& error) {
  State& state = *state_;
  add_problem(state, state.root, state.file, {base::Severity::kError, key, "", error.kind()},
              fmt::format("{}: {}", key, error.what()));
  if (const auto* const missing = dynamic_cast<const base::FileError*>(&error)) state.diagnostics.add_missing(*missing);
  for (const base::Diagnostic& diagnostic : error.diagnostics())
    state.diagnostics.add(diagnostic.severity, {diagnostic.file, diagnostic.line, 0, 1}, error.kind(),
                          [&] { return diagnostic; });
}

ReadResult SceneReader::finish() {
  State& state = *state_;
  state.diagnostics.raise_errors(state.file);
  state.result.warnings = state.diagnostics.take_warnings();
  state.result.settings = settings_of(state.source, state.root, state.result.scene);
  return std::move(state.result);
}

scene::Scene authored_scene(const SceneSource& source) {
  return std::move(SceneReader(source, Pose::kAuthored).scene());
}

void add_named_files(const SceneSource& scene, const std::vector<int>& frames, base::FileSet& files) {
  add_scene_files(scene.file, authored_scene(scene), files, frames);
}

void add_scene_files(const std::filesystem::path& scene_file, const scene::Scene& scene, base::FileSet& files,
                     const std::vector<int>& frames) {
  add_ocio_configs(config_of(scene_file, scene.color), files);
  const std::filesystem::path folder = scene_file.parent_path();
  for (const scene::NamedFile& file : scene::named_files(scene)) {
    if (file.role == &scene::kOcioConfigFile) continue;
    if (!base::is_sequence(folder / file.name)) {
      files.add_input(folder / file.name, file.role->name);
      continue;
    }
    for (const int frame : frames) files.add_input(folder / base::with_frame(file.name, frame), file.role->name);
  }
}

void add_ocio_configs(const std::string& config, base::FileSet& files) {
  for (const std::filesystem::path& file : display::config_files(config)) files.add_input(file, "OCIO config");
}

bool is_scene_file(const std::filesystem::path& file) { return base::extension(file) == ".toml"; }

void refuse_data_file(const std::filesystem::path& file, std::string_view text) {
  if (!is_scene_file(file) && data::is_data_file(file, text))
    base::refuse(fmt::format("{0} is a data file, not a scene; render it: orrery plot {0} -o IMAGE",
                             base::shell_quoted(file.string())));
}

std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes) {
  base::require_readable(file);
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw base::FileError(base::ErrorKind::kMissingInput,
                          fmt::format("cannot open {}: {}", file.string(), std::strerror(errno)), file, errno);
  std::string bytes;
  std::array<char, 65536> block{};
  while (in.read(block.data(), block.size()) || in.gcount() > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (bytes.size() <= largest_bytes) continue;
    refuse_data_file(file, bytes);
    throw base::Error(base::ErrorKind::kBadData,
                      fmt::format("{} exceeds the limit of {} MiB", file.string(), largest_bytes >> 20));
  }
  if (in.bad()) throw base::Error(base::ErrorKind::kIo, fmt::format("reading {} failed", file.string()));
  return bytes;
}

std::string toml_version() { return fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH); }

}  // namespace orrery::load
