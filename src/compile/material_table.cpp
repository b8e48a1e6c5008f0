// SPDX-License-Identifier: Apache-2.0
#include "compile/material_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>
#include <variant>

#include "compile/compiled_scene.h"
#include "compile/textures.h"
#include "scene/layers.h"

namespace orrery::compile {
namespace {

using math::set;
using math::Vec3d;

/// Returns R0 of Schlick's approximation, the reflectance at normal incidence, for a ratio of refractive indices.
double normal_reflectance(double eta) {
  const double r = (1 - eta) / (1 + eta);
  return r * r;
}

/// Compiles a material's constants. The kernel's kinds and enumerators have the order of the scene's.
kernel::Material compile_model(const scene::MaterialModel& model) {
  static_assert(std::size(kernel::kMaterialTraits) == std::variant_size_v<scene::MaterialModel>);
  kernel::Material out;
  out.kind = static_cast<kernel::MaterialKind>(model.index());
  std::visit(
      [&](const auto& m) {
        if constexpr (requires { m.albedo; }) set(out.albedo, m.albedo);
        if constexpr (requires { m.fuzz; }) out.fuzz = m.fuzz;
      },
      model);
  if (const auto* glass = std::get_if<scene::Dielectric>(&model)) {
    out.eta[0] = 1 / glass->ior;
    out.eta[1] = glass->ior;
    out.r0[0] = normal_reflectance(out.eta[0]);
    out.r0[1] = normal_reflectance(out.eta[1]);
    static_assert(static_cast<int>(scene::Fresnel::kNone) == static_cast<int>(kernel::FresnelKind::kZero));
    out.fresnel = static_cast<kernel::FresnelKind>(glass->fresnel);
  }
  if (const auto* plastic = std::get_if<scene::Plastic>(&model))
    out.r0[0] = out.r0[1] = normal_reflectance(plastic->ior);
  if (std::holds_alternative<scene::Emitter>(model)) set(out.albedo, {0, 0, 0});
  return out;
}

kernel::Emission emission_of(const scene::MaterialModel& model, CompiledScene& compiled) {
  const auto* emitter = std::get_if<scene::Emitter>(&model);
  if (emitter == nullptr) return {};
  kernel::Emission out;
  set(out.radiance, emitter->radiance * stops_to_factor(emitter->exposure));
  out.group = light_group(compiled, emitter->light_group);
  return out;
}

/// Compiles the textures of a material, and sets the constants that they replace to their means.
void set_textures(const scene::MaterialModel& model, CompiledScene& compiled, kernel::Material& material,
                  kernel::Emission& emission) {
  TextureStore& store = compiled.textures;
  kernel::MaterialTextures out;
  std::visit(
      [&](const auto& m) {
        if constexpr (requires { m.albedo_texture; })
          if (m.albedo_texture) {
            out.albedo = store.add(*m.albedo_texture);
            set(material.albedo, mean_of(*m.albedo_texture));
          }
        if constexpr (requires { m.fuzz_texture; })
          if (m.fuzz_texture) {
            out.fuzz = store.add(*m.fuzz_texture);
            material.fuzz = mean_of(*m.fuzz_texture).x;
          }
        if constexpr (requires { m.radiance_texture; })
          if (m.radiance_texture) {
            const double factor = stops_to_factor(m.exposure);
            out.radiance = store.add(*m.radiance_texture, {factor, factor, factor});
            set(emission.radiance, mean_of(*m.radiance_texture) * factor);
          }
      },
      model);
  store.add_material(out);
  const kernel::MaterialTraits& traits = kernel::traits_of(material.kind);
  if (!store.textures().empty() || traits.is_rich || (traits.transmits && material.fuzz > 0))
    compiled.features.rich_materials = true;
}

/// Returns the material for a sphere whose normal points inward: its inside and outside are exchanged.
kernel::Material turned_inside_out(kernel::Material m) {
  std::swap(m.eta[0], m.eta[1]);
  std::swap(m.r0[0], m.r0[1]);
  return m;
}

}  // namespace

double stops_to_factor(double stops) { return static_cast<double>(std::exp2(static_cast<long double>(stops))); }

std::uint16_t light_group(CompiledScene& compiled, const std::string& name) {
  if (name == scene::kDefaultLightGroup) return 0;
  std::vector<std::string>& names = compiled.light_groups;
  const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  if (index == names.size()) names.push_back(name);
  return static_cast<std::uint16_t>(index);
}

MaterialTable::MaterialTable(const scene::Scene& scene, std::vector<MaterialSource>& sources)
    : scene_(scene), sources_(sources), numbers_(scene.materials.size(), {kNone, kNone}) {}

bool MaterialTable::is_dielectric(std::uint32_t authored) const {
  return std::holds_alternative<scene::Dielectric>(scene_.materials[authored].model);
}

std::uint32_t MaterialTable::index(std::uint32_t authored, bool inside_out) {
  std::uint32_t& at = numbers_[authored][inside_out ? 1 : 0];
  if (at != kNone) return at;
  // Only dielectrics have two different sides; other materials are the same from both.
  if (inside_out && !is_dielectric(authored)) return at = index(authored, false);
  at = static_cast<std::uint32_t>(sources_.size());
  sources_.push_back({authored, inside_out});
  return at;
}

std::uint32_t MaterialTable::colored_index(std::uint32_t authored, bool inside_out, std::size_t points,
                                           std::uint16_t color) {
  const std::uint32_t plain = index(authored, inside_out);
  if (is_dielectric(authored)) return plain;  // has no colour
  if (points != points_) colored_.clear();
  points_ = points;
  const std::uint64_t key = std::uint64_t{plain} << 16 | color;
  const auto [at, is_new] = colored_.try_emplace(key, static_cast<std::uint32_t>(sources_.size()));
  if (is_new) sources_.push_back({plain, false, static_cast<std::uint32_t>(points), color});
  return at->second;
}

void compile_materials(const scene::Scene& scene, CompiledScene& compiled) {
  std::vector<kernel::Material>& materials = compiled.materials;
  std::vector<kernel::Emission>& emission = compiled.emission;
  TextureStore& textures = compiled.textures;
  materials.clear();
  emission.clear();
  textures = {};
  compiled.light_groups = {""};
  compiled.features.rich_materials = compiled.features.hemisphere = false;
  for (const MaterialSource& source : compiled.material_sources) {
    if (source.color == MaterialSource::kNoColor) {
      const scene::MaterialModel& model = scene.materials[source.material].model;
      kernel::Material m = compile_model(model);
      if (source.inside_out) m = turned_inside_out(m);
      kernel::Emission e = emission_of(model, compiled);
      set_textures(model, compiled, m, e);
      materials.push_back(m);
      emission.push_back(e);
      if (m.kind == kernel::MaterialKind::kHemisphere) compiled.features.hemisphere = true;
      continue;
    }
    const Vec3d rgb = scene.points[source.points].palette[source.color];
    kernel::Material m = materials[source.material];
    kernel::Emission e = emission[source.material];
    kernel::MaterialTextures replaced = textures.material(source.material);
    if (m.kind == kernel::MaterialKind::kEmitter) {
      for (int k = 0; k < 3; ++k) e.radiance[k] *= k == 0 ? rgb.x : k == 1 ? rgb.y : rgb.z;
      if (replaced.radiance != kernel::kNone) replaced.radiance = textures.add_scaled(replaced.radiance, rgb);
    } else {
      set(m.albedo, rgb);
      replaced.albedo = kernel::kNone;
    }
    materials.push_back(m);
    emission.push_back(e);
    textures.add_material(replaced);
  }
  const auto is_dark = [](const kernel::Material& m) { return m.kind != kernel::MaterialKind::kEmitter; };
  if (std::all_of(materials.begin(), materials.end(), is_dark)) emission.clear();
}

}  // namespace orrery::compile
