// SPDX-License-Identifier: Apache-2.0
#include "format/read_scene.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "format/overrides.h"
#include "format/read_keys.h"
#include "format/read_materials.h"
#include "base/frames.h"
#include "format/read_ply.h"
#include "format/read_tracks.h"
#include "scene/animation.h"
#include "scene/validate.h"

namespace orrery::format {
namespace {

/// Materials by their names.
using MaterialIndex = std::unordered_map<std::string, std::uint32_t>;

/// Lists that are no list of tables are reported once, not per element.
const toml::array* tables_under(Reading& reading, const toml::table& root, const char* name) {
  const toml::node* node = root.get(name);
  if (node == nullptr) return nullptr;
  const toml::array* array = node->as_array();
  if (array == nullptr || (!array->empty() && !array->is_array_of_tables())) {
    reading.error(place_of(*node), std::string("each ") + name + " is a table of its own",
                  std::string("write [[") + name + "]]");
    return nullptr;
  }
  return array;
}

void read_single_tables(Reading& reading, const toml::table& root, scene::Scene& scene) {
  for (const scene::Table& table : scene::tables()) {
    const toml::node* node = root.get(table.name);
    if (node == nullptr) continue;
    if (const toml::table* found = node->as_table()) {
      read_keys(reading, *found, table.name, table.keys, {}, scene);
    } else {
      reading.error(place_of(*node), "`" + table.name + "` must be a table", "write [" + table.name + "]");
    }
  }
}

/// The index of the material that a sphere or a points file names; 0 and a finding where there is none.
std::uint32_t read_material_name(Reading& reading, const toml::table& table, const std::string& table_name,
                                 const scene::Scene& scene, const MaterialIndex& index) {
  const std::string full_name = table_name + ".material";
  const toml::node* node = table.get("material");
  if (node == nullptr) {
    reading.error(place_of(table), table_name + " needs `material`");
    reading.unread.insert(full_name);
    return 0;
  }
  const auto value = read_value(reading, *node, full_name, scene::ValueType::kText, {}, {});
  if (value) {
    if (const auto found = index.find(std::get<std::string>(*value)); found != index.end()) return found->second;
    const auto& name = std::get<std::string>(*value);
    std::vector<std::string> names;
    for (const scene::Material& material : scene.materials) names.push_back(material.name);
    constexpr std::size_t kMostNamed = 12;
    std::string remedy = base::did_you_mean(name, names);
    if (remedy.empty() && names.empty()) remedy = "the scene has no [material.NAME] at all";
    if (remedy.empty() && names.size() <= kMostNamed) remedy = "there are " + base::joined(names);
    reading.error(place_of(*node), full_name + " is \"" + name + "\", and there is no such material", remedy);
  }
  reading.unread.insert(full_name);
  return 0;
}

void read_spheres(Reading& reading, const toml::table& root, const MaterialIndex& index, scene::Scene& scene) {
  const toml::array* list = tables_under(reading, root, "sphere");
  if (list == nullptr) return;
  scene.spheres.reserve(list->size());
  for (std::size_t i = 0; i < list->size(); ++i) {
    const toml::table& table = *list->get(i)->as_table();
    const std::string full_name = "sphere[" + std::to_string(i) + "]";
    scene::Sphere sphere;
    read_keys(reading, table, full_name, scene::sphere_keys(), {"material"}, sphere);
    sphere.material = read_material_name(reading, table, full_name, scene, index);
    scene.spheres.push_back(std::move(sphere));
  }
}

void read_points(Reading& reading, const toml::table& root, const std::filesystem::path& folder, int frame,
                 const MaterialIndex& index, scene::Scene& scene) {
  const toml::array* list = tables_under(reading, root, "points");
  if (list == nullptr) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const toml::table& table = *list->get(i)->as_table();
    const std::string full_name = "points[" + std::to_string(i) + "]";
    scene::Points points;
    read_keys(reading, table, full_name, scene::points_keys(), {"material"}, points);
    points.material = read_material_name(reading, table, full_name, scene, index);
    if (reading.unread.count(full_name + ".file") == 0) {
      points.file = base::with_frame(points.file.string(), frame);
      try {
        read_ply(folder / points.file, scene.materials.size(), points);
      } catch (const base::Error& error) {
        // The place in the scene that names the file, then what the file itself has to say.
        reading.error(place_of(*table.get("file")), full_name + ".file: " + error.what());
        reading.findings.insert(reading.findings.end(), error.findings().begin(), error.findings().end());
      }
    }
    scene.points.push_back(std::move(points));
  }
}

/// The node that a problem's key names, or the nearest table around it.
const toml::node* node_of(const toml::table& root, const std::string& key) {
  const toml::node* at = &root;
  std::size_t i = 0;
  while (i < key.size()) {
    const std::size_t end = std::min(key.find_first_of(".[", i + (key[i] == '[' ? 1u : 0u)), key.size());
    const std::string step = key.substr(i, end - i);
    const toml::node* next = nullptr;
    if (step[0] == '[') {
      if (const toml::array* array = at->as_array())
        next = array->get(static_cast<std::size_t>(std::strtoull(step.c_str() + 1, nullptr, 10)));
    } else if (const toml::table* table = at->as_table()) {
      next = table->get(step);
    }
    if (next == nullptr) break;
    at = next;
    i = end < key.size() && key[end] == '.' ? end + 1 : end;
  }
  return at == &root ? nullptr : at;
}

bool is_error(const base::Finding& finding) { return finding.severity == base::Severity::kError; }

/// Adds what is wrong with the whole. A value that could not be read stands at its default: what the whole makes of
/// that would be a finding too many, and nobody is warned of a scene that is wrong.
void add_problems(Reading& reading, const toml::table& root, const ReadResult& result, const std::string& file) {
  const bool has_errors = std::any_of(reading.findings.begin(), reading.findings.end(), is_error);
  const auto is_of_camera = [](const std::string& key) { return key.rfind("camera.", 0) == 0; };
  const bool camera_is_read = std::none_of(reading.unread.begin(), reading.unread.end(), is_of_camera);
  const scene::Scene* closing = result.closing ? &*result.closing : nullptr;
  for (const scene::Problem& problem : scene::validate(result.scene, closing)) {
    if (has_errors && problem.severity == base::Severity::kWarning) continue;
    if (reading.unread.count(problem.key) != 0 || (is_of_camera(problem.key) && !camera_is_read)) continue;
    const toml::node* node = node_of(root, problem.key);
    const Place place = node != nullptr ? place_of(*node) : Place{file, 0, 0, 1};
    const std::string text = problem.key.empty() ? problem.text : problem.key + ": " + problem.text;
    reading.findings.push_back(reading.source.finding(problem.severity, place, text));
  }
}

/// Brings the scene to the moment of the frame; where the shutter stays open, to its two moments.
void pose(Reading& reading, const toml::table& root, const std::string& file, int frame, ReadResult& result) {
  scene::Scene& scene = result.scene;
  const scene::Camera& shutter = scene.camera;
  const bool is_open = shutter.shutter_close > shutter.shutter_open;
  const double opens = frame + (is_open ? shutter.shutter_open : 0), closes = frame + shutter.shutter_close;
  if (!scene.tracks.empty()) {
    check_tracks(reading, *root.get("key")->as_array(), scene, opens);
    if (is_open) check_tracks(reading, *root.get("key")->as_array(), scene, closes);
  }
  if (is_open) {
    result.closing = scene::posed(scene, closes);
    for (scene::Problem problem : scene::validate(*result.closing)) {
      if (problem.severity == base::Severity::kWarning) continue;
      const toml::node* node = node_of(root, problem.key);
      reading.findings.push_back(reading.source.finding(problem.severity,
                                                        node != nullptr ? place_of(*node) : Place{file, 0, 0, 1},
                                                        problem.key + " when the shutter closes: " + problem.text));
    }
  }
  scene = scene::posed(scene, opens);
  for (std::size_t i = 0; is_open && i < scene.spheres.size(); ++i)
    if ((scene.spheres[i].radius < 0) != (result.closing->spheres[i].radius < 0))
      reading.error(Place{file, 0, 0, 1},
                    "sphere[" + std::to_string(i) + "].radius changes its sign while the shutter is open");
}

void report_unknown_tables(Reading& reading, const toml::table& root) {
  std::vector<std::string> known;
  for (const scene::Table& table : scene::tables()) known.push_back(table.name);
  known.insert(known.end(), {"material", "sphere", "points", "key"});
  for (const auto& [key, node] : root)
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      report_unknown_key(reading, key, "the scene", known);
}

std::vector<Setting> settings_of(const toml::table& root, const scene::Scene& scene) {
  std::vector<Setting> settings;
  for (const scene::Table& table : scene::tables()) {
    const toml::table* written = root.get(table.name) != nullptr ? root.get(table.name)->as_table() : nullptr;
    for (const auto& key : table.keys) {
      const toml::node* node = written != nullptr ? written->get(key.name) : nullptr;
      std::string origin = "default";
      if (node != nullptr) {
        const Place place = place_of(*node);
        origin = place.text_name;
        if (origin != kOverrideName) origin += ':' + std::to_string(place.line);
      }
      settings.push_back({table.name + "." + key.name, key.text(scene), origin});
    }
  }
  return settings;
}

void throw_errors(const std::filesystem::path& file, std::vector<base::Finding> findings) {
  const auto errors = std::count_if(findings.begin(), findings.end(), is_error);
  if (errors == 0) return;
  std::stable_sort(findings.begin(), findings.end(), [](const base::Finding& a, const base::Finding& b) {
    return std::tie(a.file, a.line, a.column) < std::tie(b.file, b.line, b.column);
  });
  throw base::Error(base::ErrorKind::kBadData,
                    file.string() + ": " + std::to_string(errors) + (errors == 1 ? " error" : " errors"),
                    std::move(findings));
}

}  // namespace

ReadResult read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides, int frame) {
  const std::string text = read_file(file, kLargestSceneFile);
  Reading reading;
  const toml::table root = parse_tree(file.string(), text, overrides, reading.source, reading.findings);
  if (root.empty()) throw_errors(file, reading.findings);

  ReadResult result;
  report_unknown_tables(reading, root);
  read_single_tables(reading, root, result.scene);
  read_materials(reading, root, result.scene.materials);
  MaterialIndex index;
  for (const scene::Material& material : result.scene.materials)
    index.emplace(material.name, static_cast<std::uint32_t>(index.size()));
  read_spheres(reading, root, index, result.scene);
  if (const toml::array* keys = tables_under(reading, root, "key")) read_tracks(reading, *keys, result.scene);
  if (std::none_of(reading.findings.begin(), reading.findings.end(), is_error))
    pose(reading, root, file.string(), frame, result);
  read_points(reading, root, file.parent_path(), frame, index, result.scene);
  add_problems(reading, root, result, file.string());
  throw_errors(file, reading.findings);
  result.warnings = std::move(reading.findings);
  result.settings = settings_of(root, result.scene);
  return result;
}

}  // namespace orrery::format
