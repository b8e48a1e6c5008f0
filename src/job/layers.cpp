// SPDX-License-Identifier: Apache-2.0
#include "job/layers.h"

#include <algorithm>
#include <memory>
#include <set>

#include "compile/compiled_scene.h"
#include "film/cryptomatte.h"
#include "scene/layers.h"
#include "scene/limits.h"

namespace orrery::job {
namespace {

/// Matte id of each sphere, run-length encoded over sphere indices.
class RunLengthIds {
 public:
  void add(std::size_t spheres, std::uint32_t id) {
    end_ += static_cast<std::uint32_t>(spheres);
    if (!ids_.empty() && ids_.back() == id) {
      ends_.back() = end_;
    } else if (spheres > 0) {
      ends_.push_back(end_);
      ids_.push_back(id);
    }
  }
  std::uint32_t operator()(std::uint32_t sphere) const {
    const auto run = std::upper_bound(ends_.begin(), ends_.end(), sphere) - ends_.begin();
    return ids_[static_cast<std::size_t>(run)];
  }

 private:
  std::uint32_t end_ = 0;
  std::vector<std::uint32_t> ends_, ids_;
};

/// Collects the names of one matte.
class MatteMaker {
 public:
  explicit MatteMaker(std::string layer) { names_.layer = std::move(layer); }

  /// Assigns the next spheres to this name; an empty name: to no matte.
  void add(std::size_t spheres, const std::string& name) { runs_->add(spheres, id_of(name)); }

  std::uint32_t id_of(const std::string& name) {
    if (name.empty()) return 0;
    const std::uint32_t id = film::matte_id(name);
    if (known_.insert(name).second) names_.things.emplace_back(name, id);
    return id;
  }
  void finish(Layers& layers) {
    finish(layers, [runs = runs_](std::uint32_t sphere) { return (*runs)(sphere); });
  }
  void finish(Layers& layers, std::function<std::uint32_t(std::uint32_t)> id_of_sphere) {
    layers.request.mattes.push_back({names_.layer, std::move(id_of_sphere)});
    layers.mattes.push_back(std::move(names_));
  }

 private:
  MatteNames names_;
  std::set<std::string> known_;
  std::shared_ptr<RunLengthIds> runs_ =
      std::make_shared<RunLengthIds>();  // shared, since std::function copies its target
};

void add_object_matte(const scene::Scene& scene, const std::vector<std::size_t>& points_sizes, Layers& layers) {
  MatteMaker maker("CryptoObject");
  for (std::size_t i = 0; i < scene.spheres.size(); ++i)
    maker.add(1, scene.spheres[i].name.empty() ? "sphere." + std::to_string(i) : scene.spheres[i].name);
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const scene::Points& p = scene.points[i];
    maker.add(points_sizes[i], p.name.empty() ? p.file.stem().string() : p.name);
  }
  maker.finish(layers);
}

void add_group_matte(const scene::Scene& scene, const std::vector<std::size_t>& points_sizes, Layers& layers) {
  MatteMaker maker("CryptoGroup");
  for (const scene::Sphere& s : scene.spheres) maker.add(1, s.group);
  for (std::size_t i = 0; i < scene.points.size(); ++i) maker.add(points_sizes[i], scene.points[i].group);
  maker.finish(layers);
}

/// The authored material of each compiled material. Compilation may split glass and coloured materials.
std::vector<std::uint32_t> authored_materials(const compile::CompiledScene& compiled) {
  const std::vector<compile::MaterialSource>& sources = compiled.material_sources;
  std::vector<std::uint32_t> authored;
  for (const compile::MaterialSource& source : sources)
    authored.push_back(source.color == compile::MaterialSource::kNoColor ? source.material
                                                                         : sources[source.material].material);
  return authored;
}

void add_material_matte(const scene::Scene& scene, const compile::CompiledScene& compiled,
                        const std::vector<std::uint32_t>& authored, Layers& layers) {
  MatteMaker maker("CryptoMaterial");
  std::vector<std::uint32_t> ids;
  for (const std::uint32_t material : authored) ids.push_back(maker.id_of(scene.materials[material].name));
  const compile::PackedIndices& of_sphere = compiled.sphere_materials;
  maker.finish(layers, [ids, &of_sphere](std::uint32_t sphere) { return ids[of_sphere[sphere]]; });
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

}  // namespace

Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled) {
  Layers out;
  film::LayerRequest& r = out.request;
  const std::vector<std::string> names = scene::requested_layers(scene);
  const auto requested = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  for (const film::LayerType& layer : film::kLayerTypes) r.*layer.requested = requested(layer.name);
  if (r.light_groups) r.groups = light_groups(scene, compiled);
  r.coverage = scene.background.alpha == 0;
  if (requested("CryptoObject")) add_object_matte(scene, compiled.points_sizes, out);
  if (r.material_id || requested("CryptoMaterial")) {
    const std::vector<std::uint32_t> authored = authored_materials(compiled);
    for (const std::uint32_t material : authored) r.material_numbers.push_back(material + 1);
    if (requested("CryptoMaterial")) add_material_matte(scene, compiled, authored, out);
  }
  if (requested("CryptoGroup")) add_group_matte(scene, compiled.points_sizes, out);
  return out;
}

}  // namespace orrery::job
