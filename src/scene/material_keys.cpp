// SPDX-License-Identifier: Apache-2.0
// The keys of materials.
#include "scene/key_builders.h"
#include "scene/texture.h"

namespace orrery::scene {
namespace {

template <class Type>
Type& model_of(MaterialModel& model) {
  return std::get<Type>(model);
}

template <class Type>
TexturedKey textured(const char* key, TextureUse use, TextureSlot Type::*slot) {
  return {key, use, [slot](MaterialModel& model) -> TextureSlot& { return model_of<Type>(model).*slot; }};
}

template <class Type>
MaterialType material(const char* name, const char* doc, std::vector<Key<Type>> keys,
                      std::vector<TexturedKey> textured) {
  return {name, doc, Type{}, keys_at<MaterialModel>(model_of<Type>, std::move(keys)), std::move(textured)};
}

std::vector<MaterialType> make_material_types() {
  const KeyDoc albedo{"Fraction of the light that is scattered, per colour channel; or a [texture](#textures)",
                      "scene-linear"};
  const auto opacity = [](auto at) {
    return changes(Part::kAssignment,
                   number("opacity", kUnit,
                          {"Probability that an object of this material is visible to a ray; see [Opacity](#opacity)",
                           "", "Below 1: more noise, and 4 bytes per sphere"},
                          at));
  };
  return {
      material<Lambertian>(
          "lambertian", "Diffuse, with Lambert's cosine law",
          {required(vector("albedo", kUnit, albedo, &Lambertian::albedo)), opacity(&Lambertian::opacity)},
          {textured("albedo", TextureUse::kReflectance, &Lambertian::albedo_texture)}),
      material<Hemisphere>(
          "hemisphere", "The book's first diffuse material: scatters uniformly over the hemisphere",
          {required(vector("albedo", kUnit, albedo, &Hemisphere::albedo)), opacity(&Hemisphere::opacity)},
          {textured("albedo", TextureUse::kReflectance, &Hemisphere::albedo_texture)}),
      material<Metal>("metal", "Metal, from a perfect mirror to fuzzy reflection",
                      {required(vector("albedo", kUnit, albedo, &Metal::albedo)),
                       number("fuzz", kUnit,
                              {"Radius of the sphere, centred on the tip of the unit reflected direction, on which the "
                               "perturbed direction is sampled. Directions below the surface are absorbed. 0 is a "
                               "perfect mirror. Or a [texture](#textures)"},
                              &Metal::fuzz),
                       opacity(&Metal::opacity)},
                      {textured("albedo", TextureUse::kReflectance, &Metal::albedo_texture),
                       textured("fuzz", TextureUse::kNumber, &Metal::fuzz_texture)}),
      material<Dielectric>(
          "dielectric", "Dielectric, such as glass, water, or an air bubble in water; clear or rough",
          {number("ior", {1e-6, 1e6}, {"Refractive index of the inside, relative to the surrounding medium"},
                  &Dielectric::ior),
           choice("fresnel", {"schlick", "exact", "none"},
                  {"Fresnel reflectance. `schlick`: Schlick's approximation, as in the book. `exact`: Fresnel "
                   "equations. `none`: refraction only, apart from total internal reflection"},
                  &Dielectric::fresnel),
           number("fuzz", kUnit,
                  {"Radius of the sphere, centred on the tip of the unit reflected or refracted direction, on which "
                   "the perturbed direction is sampled. Directions on the wrong side of the surface are absorbed. 0: "
                   "smooth. Or a [texture](#textures)",
                   "", "Above 0: lights are found by BSDF sampling only"},
                  &Dielectric::fuzz)},
          {textured("fuzz", TextureUse::kNumber, &Dielectric::fuzz_texture)}),
      material<Emitter>(
          "emitter", "A light: emits the same radiance in all directions and reflects nothing",
          {required(
               vector("radiance", kLight,
                      {"Emitted radiance: radiant exitance divided by pi, per colour channel; or a "
                       "[texture](#textures). Refraction does not change it: an emitter inside glass has no factor of "
                       "the squared index",
                       "scene-linear"},
                      &Emitter::radiance)),
           number("exposure", {-kMaxStops, kMaxStops},
                  {"Multiplies the radiance by 2 to this power. The product is at most 2^34", "stops"},
                  &Emitter::exposure),
           text("light_group", {"Light group, for the layer `light_groups`. Default: the group `default`"},
                &Emitter::light_group),
           opacity(&Emitter::opacity)},
          {textured("radiance", TextureUse::kRadiance, &Emitter::radiance_texture)}),
      material<Plastic>("plastic", "Plastic or paint: a clear coat over a diffuse base",
                        {required(vector("albedo", kUnit,
                                         {"Fraction of the light at the base that is scattered, per colour "
                                          "channel; or a [texture](#textures)",
                                          "scene-linear"},
                                         &Plastic::albedo)),
                         number("ior", {1, 1e6},
                                {"Refractive index of the coat. It sets how much the coat reflects, by Schlick's "
                                 "approximation: 0.04 at normal incidence for 1.5"},
                                &Plastic::ior),
                         number("fuzz", kUnit,
                                {"Roughness of the coat. Its highlights are as wide as those of metal with the same "
                                 "fuzz, but brightest in the middle. 0: smooth. Or a [texture](#textures)"},
                                &Plastic::fuzz),
                         opacity(&Plastic::opacity)},
                        {textured("albedo", TextureUse::kReflectance, &Plastic::albedo_texture),
                         textured("fuzz", TextureUse::kNumber, &Plastic::fuzz_texture)}),
  };
}

}  // namespace

const std::vector<MaterialType>& material_types() {
  static const std::vector<MaterialType> all = make_material_types();
  return all;
}

const MaterialType& type_of(const MaterialModel& model) { return material_types()[model.index()]; }

}  // namespace orrery::scene
