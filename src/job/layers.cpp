// SPDX-License-Identifier: Apache-2.0
#include "job/layers.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/file_name.h"
#include "compile/compiled_scene.h"
#include "film/cryptomatte.h"
#include "image/format.h"
#include "job/outputs.h"
#include "scene/layers.h"
#include "scene/limits.h"

namespace orrery::job {
namespace {

/// The names of one matte.
class NameList {
 public:
  /// The id of a name; 0 of an empty one.
  std::uint32_t id_of(const std::string& name) {
    if (name.empty()) return 0;
    const std::uint32_t id = film::matte_id(name);
    if (known_.insert(name).second) things.emplace_back(name, id);
    return id;
  }

  decltype(MatteNames::things) things;

 private:
  std::set<std::string> known_;
};

/// The authored material of each compiled material. Compilation may split glass and coloured materials.
std::vector<std::uint32_t> authored_materials(const compile::CompiledScene& compiled) {
  const std::vector<compile::MaterialSource>& sources = compiled.material_sources;
  std::vector<std::uint32_t> authored;
  for (const compile::MaterialSource& source : sources)
    authored.push_back(source.color == compile::MaterialSource::kNoColor ? source.material
                                                                         : sources[source.material].material);
  return authored;
}

/// Adds the mattes whose layers are requested, in the order of kMatteLayers.
///
/// `authored`   the authored material of each compiled material
template <class Requested>
void add_mattes(const scene::Scene& scene, const compile::CompiledScene& compiled,
                const std::vector<std::uint32_t>& authored, const Requested& requested, Layers& layers) {
  using Ids = std::array<std::uint32_t, kMatteLayers.size()>;
  std::array<bool, kMatteLayers.size()> is_requested;
  std::transform(kMatteLayers.begin(), kMatteLayers.end(), is_requested.begin(), requested);
  const auto [by_object, by_material, by_group] = is_requested;
  if (!by_object && !by_material && !by_group) return;

  std::array<NameList, kMatteLayers.size()> names;
  auto& [objects, materials, groups] = names;
  std::vector<std::uint32_t> material_ids;
  if (by_material)
    for (const std::uint32_t material : authored)
      material_ids.push_back(materials.id_of(scene.materials[material].name));

  const std::size_t ids_of_all = compiled.sphere_materials.size();
  const std::size_t blocks =
      scene.spheres.size() + 3 * scene.points.size() + scene.rods.size() + scene.rod_files.size();
  const std::size_t most = std::min(ids_of_all, by_material ? blocks * material_ids.size() : blocks);
  film::MatteClasses classes{{ids_of_all, static_cast<std::uint32_t>(most)}, {}};
  std::map<Ids, std::uint32_t> known;
  std::vector<Ids> ids;
  std::uint32_t sphere = 0, current = 0;
  const auto add = [&](std::size_t count, const std::string& object, const std::string& group) {
    Ids wanted = {by_object ? objects.id_of(object) : 0, 0, by_group ? groups.id_of(group) : 0};
    for (; count > 0; --count, ++sphere) {
      if (by_material) wanted[1] = material_ids[compiled.sphere_materials[sphere]];
      if (ids.empty() || wanted != ids[current]) {
        const auto [at, is_new] = known.try_emplace(wanted, static_cast<std::uint32_t>(ids.size()));
        current = at->second;
        if (is_new) {
          ids.push_back(wanted);
          classes.first_sphere.push_back(sphere);
        }
      }
      classes.of_sphere.set(sphere, current);
    }
  };
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    const scene::Sphere& s = scene.spheres[i];
    add(1, s.name.empty() ? "sphere." + std::to_string(i) : s.name, s.group);
  }
  // Spheres of a points table, or halves of its bonds.
  const auto add_points = [&](std::size_t i, std::size_t count) {
    const scene::Points& p = scene.points[i];
    add(count, p.name.empty() ? p.file.stem().string() : p.name, p.group);
  };
  for (std::size_t i = 0; i < scene.points.size(); ++i) add_points(i, compiled.points_sizes[i]);
  for (std::size_t i = 0; i < scene.rods.size(); ++i) {
    const scene::Rod& r = scene.rods[i];
    add(2, r.name.empty() ? "rod." + std::to_string(i) : r.name, r.group);
  }
  for (std::size_t i = 0; i < scene.rod_files.size(); ++i) {
    const scene::RodFile& r = scene.rod_files[i];
    add(2 * compiled.rod_file_sizes[i], r.name.empty() ? r.file.stem().string() : r.name, r.group);
  }
  for (std::size_t i = 0; i < scene.points.size(); ++i) add_points(i, 2 * compiled.stub_counts[i]);
  for (std::size_t i = 0; i < scene.points.size(); ++i) add_points(i, 2 * compiled.bond_counts[i]);

  layers.request.matte_classes = std::make_shared<film::MatteClasses>(std::move(classes));
  for (std::size_t m = 0; m < kMatteLayers.size(); ++m) {
    if (!is_requested[m]) continue;
    film::Matte& matte = layers.request.mattes.emplace_back();
    matte.name = kMatteLayers[m];
    for (const Ids& of_class : ids) matte.ids.push_back(of_class[m]);
    layers.mattes.push_back({kMatteLayers[m], std::move(names[m].things)});
  }
}

/// The light groups of the scene, in the order of the compiled ones.
std::vector<film::LightGroup> light_groups(const scene::Scene& scene, const compile::CompiledScene& compiled) {
  std::vector<film::LightGroup> groups;
  for (const std::string& name : compiled.light_groups)
    groups.push_back({name.empty() ? scene::kDefaultLightGroup : name, false, false});
  for (std::size_t i = 0; i < compiled.emission.size(); ++i)
    if (compiled.materials[i].kind == kernel::MaterialKind::kEmitter)
      groups[static_cast<std::size_t>(compiled.emission[i].group)].has_emitters = true;
  const std::string name = scene::background_light_group(scene.background);
  for (film::LightGroup& group : groups) group.has_background = group.name == name;
  return groups;
}

/// {"name":"13851a76",...}, in scene order. Written directly, since the JSON library's ordered object searches all
/// names on every insertion.
std::string manifest(const MatteNames& matte) {
  std::string out = "{";
  for (const auto& [name, id] : matte.things) {
    if (out.size() > 1) out += ',';
    out += fmt::format("{}:\"{}\"", nlohmann::json(name).dump(), film::matte_id_text(id));
  }
  return out + '}';
}

bool is_large(const MatteNames& matte) { return matte.things.size() > kMaxNamesInHeader; }

std::filesystem::path manifest_file(const std::string& layer, const std::filesystem::path& picture) {
  return picture.parent_path() / base::companion_name(picture.stem().string(), fmt::format(".{}.json", layer));
}

}  // namespace

Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled) {
  Layers out;
  film::LayerRequest& r = out.request;
  const std::vector<std::string> names = scene::requested_layers(scene);
  const auto requested = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  for (const film::LayerType& layer : film::kLayerTypes) r.*layer.requested = requested(layer.name);
  if (r.light_groups) r.groups = light_groups(scene, compiled);
  r.coverage = scene.background.alpha == 0;
  std::vector<std::uint32_t> authored;
  if (r.material_id || requested("CryptoMaterial")) authored = authored_materials(compiled);
  if (r.material_id)
    for (const std::uint32_t material : authored) r.material_numbers.push_back(material + 1);
  add_mattes(scene, compiled, authored, requested, out);
  return out;
}

std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes,
                                               const std::filesystem::path& picture) {
  std::vector<image::Attribute> out;
  for (const MatteNames& matte : mattes) {
    const std::string key =
        fmt::format("cryptomatte/{}/", film::matte_id_text(film::matte_id(matte.layer)).substr(0, 7));
    out.push_back({key + "name", matte.layer});
    out.push_back({key + "hash", std::string("MurmurHash3_32")});
    out.push_back({key + "conversion", std::string("uint32_to_float32")});
    if (is_large(matte)) {
      out.push_back({key + "manif_file", manifest_file(matte.layer, picture).filename().string()});
    } else {
      out.push_back({key + "manifest", manifest(matte)});
    }
  }
  return out;
}

std::vector<std::filesystem::path> manifest_files(const std::vector<MatteNames>& mattes, const Outputs& outputs) {
  std::vector<std::filesystem::path> files;
  for (const auto& [picture, format] : outputs.images)
    for (const MatteNames& matte : mattes)
      if (is_large(matte) && format == image::Format::kExr) files.push_back(manifest_file(matte.layer, picture));
  return files;
}

std::vector<std::filesystem::path> possible_manifest_files(const Outputs& outputs) {
  std::vector<std::filesystem::path> files;
  for (const auto& [picture, format] : outputs.images)
    if (format == image::Format::kExr)
      for (const char* layer : kMatteLayers) files.push_back(manifest_file(layer, picture));
  return files;
}

void write_manifests(const std::vector<MatteNames>& mattes, const std::filesystem::path& picture) {
  for (const MatteNames& matte : mattes)
    if (is_large(matte)) base::write_text_file(manifest_file(matte.layer, picture), manifest(matte));
}

}  // namespace orrery::job
