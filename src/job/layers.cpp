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

#include "compile/compiled_scene.h"
#include "film/cryptomatte.h"
#include "scene/layers.h"

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

/// The ids of a sphere in each matte, in the order of kMatteLayers; 0: it is not in the matte.
using MatteIds = std::array<std::uint32_t, kMatteLayers.size()>;

/// Sorts spheres into classes of equal ids.
class SphereClasses {
 public:
  /// `material_ids`   id of each compiled material; empty: spheres are not divided by material
  /// `most`           maximum number of classes
  SphereClasses(const compile::PackedIndices& object_materials, std::vector<std::uint32_t> material_ids,
                std::size_t most)
      : materials_(object_materials),
        material_ids_(std::move(material_ids)),
        classes_{{object_materials.size(), static_cast<std::uint32_t>(most)}, {}} {}

  /// Adds the next spheres, or halves of rods.
  void add(std::size_t count, MatteIds wanted) {
    for (; count > 0; --count, ++sphere_) {
      if (!material_ids_.empty()) wanted[1] = material_ids_[materials_[sphere_]];
      if (ids_.empty() || wanted != ids_[current_]) {
        const auto [at, is_new] = known_.try_emplace(wanted, static_cast<std::uint32_t>(ids_.size()));
        current_ = at->second;
        if (is_new) {
          ids_.push_back(wanted);
          classes_.first_sphere.push_back(sphere_);
        }
      }
      classes_.of_sphere.set(sphere_, current_);
    }
  }

  /// The ids of each class.
  const std::vector<MatteIds>& ids() const { return ids_; }
  film::MatteClasses take() { return std::move(classes_); }

 private:
  const compile::PackedIndices& materials_;
  const std::vector<std::uint32_t> material_ids_;
  film::MatteClasses classes_;
  std::map<MatteIds, std::uint32_t> known_;
  std::vector<MatteIds> ids_;
  std::uint32_t sphere_ = 0, current_ = 0;
};

/// Adds all spheres and halves of rods in the order of their ids.
///
/// `ids_of`   f(object, group): their ids, without those of materials
template <class IdsOf>
void add_spheres(const scene::Scene& scene, const compile::CompiledScene& compiled, const IdsOf& ids_of,
                 SphereClasses& classes) {
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    const scene::Sphere& s = scene.spheres[i];
    classes.add(1, ids_of(s.name.empty() ? "sphere." + std::to_string(i) : s.name, s.group));
  }
  std::vector<std::vector<MatteIds>> of_points;  // of each object of a points table
  for (const scene::Points& p : scene.points) {
    const std::string name = p.name.empty() ? p.file.stem().string() : p.name;
    of_points.emplace_back();
    if (p.objects.empty()) of_points.back().push_back(ids_of(name, p.group));
    for (const std::string& object : p.object_names) of_points.back().push_back(ids_of(name + object, p.group));
  }
  // Spheres of a points table, or halves of its bonds. The k-th one is in the object of `at(k)`, see Points::objects.
  const auto add_points = [&](std::size_t table, std::size_t count, const auto& at) {
    const std::vector<std::uint32_t>& objects = scene.points[table].objects;
    if (objects.empty()) return classes.add(count, of_points[table][0]);
    for (std::size_t k = 0; k < count; ++k) classes.add(1, of_points[table][objects[at(k)]]);
  };
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    add_points(i, compiled.points_sizes[i], [](std::size_t k) { return k; });
  for (std::size_t i = 0; i < scene.rods.size(); ++i) {
    const scene::Rod& r = scene.rods[i];
    classes.add(2, ids_of(r.name.empty() ? "rod." + std::to_string(i) : r.name, r.group));
  }
  for (std::size_t i = 0; i < scene.rod_files.size(); ++i) {
    const scene::RodFile& r = scene.rod_files[i];
    classes.add(2 * compiled.rod_file_sizes[i], ids_of(r.name.empty() ? r.file.stem().string() : r.name, r.group));
  }
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    add_points(i, 2 * compiled.stub_counts[i], [&](std::size_t k) { return compiled.points_sizes[i] + k / 2; });
  std::size_t first_sphere = scene.spheres.size(), first_bond = 0;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    add_points(i, 2 * compiled.bond_counts[i], [&](std::size_t k) {
      const kernel::Bond& bond = compiled.bonds[first_bond + k / 2];
      return (k % 2 == 0 ? bond.a : bond.b) - first_sphere;
    });
    first_sphere += compiled.points_sizes[i];
    first_bond += compiled.bond_counts[i];
  }
}

/// Number of sets of spheres that cannot be divided into smaller objects.
std::size_t block_count(const scene::Scene& scene) {
  std::size_t out = scene.spheres.size() + scene.rods.size() + scene.rod_files.size();
  for (const scene::Points& points : scene.points) out += std::max<std::size_t>(1, points.object_names.size());
  return out;
}

/// Adds the mattes whose layers are requested, in the order of kMatteLayers.
///
/// `authored`   the authored material of each compiled material
template <class Requested>
void add_mattes(const scene::Scene& scene, const compile::CompiledScene& compiled,
                const std::vector<std::uint32_t>& authored, const Requested& requested, Layers& layers) {
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

  const std::size_t ids_of_all = compiled.object_materials.size();
  const std::size_t blocks = block_count(scene);
  const std::size_t most = std::min(ids_of_all, by_material ? blocks * material_ids.size() : blocks);
  SphereClasses classes(compiled.object_materials, std::move(material_ids), most);
  const auto ids_of = [&](const std::string& object, const std::string& group) {
    return MatteIds{by_object ? objects.id_of(object) : 0, 0, by_group ? groups.id_of(group) : 0};
  };
  add_spheres(scene, compiled, ids_of, classes);

  layers.request.matte_classes = std::make_shared<film::MatteClasses>(classes.take());
  for (std::size_t m = 0; m < kMatteLayers.size(); ++m) {
    if (!is_requested[m]) continue;
    film::Matte& matte = layers.request.mattes.emplace_back();
    matte.name = kMatteLayers[m];
    for (const MatteIds& of_class : classes.ids()) matte.ids.push_back(of_class[m]);
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

}  // namespace

Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled, bool may_have_looks) {
  Layers out;
  film::LayerRequest& r = out.request;
  const std::vector<std::string> names = scene::requested_layers(scene);
  const auto requested = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  for (const film::LayerType& layer : film::kLayerTypes) r.*layer.requested = requested(layer.name);
  if (r.light_groups) r.groups = light_groups(scene, compiled);
  r.transparent = scene.background.alpha == 0;
  r.coverage = r.transparent || (may_have_looks && scene.background.backdrop);
  std::vector<std::uint32_t> authored;
  if (r.material_id || requested("CryptoMaterial")) authored = authored_materials(compiled);
  if (r.material_id)
    for (const std::uint32_t material : authored) r.material_numbers.push_back(material + 1);
  add_mattes(scene, compiled, authored, requested, out);
  return out;
}

base::PackedArray object_classes(const scene::Scene& scene, const compile::CompiledScene& compiled) {
  SphereClasses classes(compiled.object_materials, {}, std::min(compiled.object_materials.size(), block_count(scene)));
  NameList names;
  add_spheres(
      scene, compiled,
      [&](const std::string& object, const std::string&) {
        return MatteIds{names.id_of(object), 0, 0};
      },
      classes);
  return classes.take().of_sphere;
}

std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes) {
  std::vector<image::Attribute> out;
  for (const MatteNames& matte : mattes) {
    const std::string key =
        fmt::format("cryptomatte/{}/", film::matte_id_text(film::matte_id(matte.layer)).substr(0, 7));
    out.push_back({key + "name", matte.layer});
    out.push_back({key + "hash", std::string("MurmurHash3_32")});
    out.push_back({key + "conversion", std::string("uint32_to_float32")});
    out.push_back({key + "manifest", manifest(matte)});
  }
  return out;
}

}  // namespace orrery::job
