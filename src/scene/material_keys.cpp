// SPDX-License-Identifier: Apache-2.0
// The keys of materials.
#include "scene/key_builders.h"
#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::scene {
namespace {

/// A member of a type of material.
template <class Type, class Member>
auto in(Member Type::*member) {
  return [member](MaterialModel& model) -> Member& { return std::get<Type>(model).*member; };
}

std::vector<MaterialType> make_material_types() {
  using M = MaterialModel;
  const KeyDoc albedo{"scene-linear",
                      "Fraction of the light that is scattered, per colour channel; or a [texture](#textures)"};
  const auto opacity = [](auto at) {
    return changes(
        Part::kAssignment,
        number<M>("opacity", kUnit,
                  {"", "Probability that an object of this material is visible to a ray; see [Opacity](#opacity)",
                   "Below 1: more noise, and 4 bytes per sphere"},
                  at));
  };
  const auto of = [](const char* key, TextureUse use, auto at) { return TexturedKey{key, use, at}; };
  return {
      {"lambertian",
       "Diffuse, with Lambert's cosine law",
       Lambertian{},
       {required(vector<M>("albedo", kUnit, albedo, in(&Lambertian::albedo))), opacity(in(&Lambertian::opacity))},
       {of("albedo", TextureUse::kReflectance, in(&Lambertian::albedo_texture))}},
      {"hemisphere",
       "The book's first diffuse material: scatters uniformly over the hemisphere",
       Hemisphere{},
       {required(vector<M>("albedo", kUnit, albedo, in(&Hemisphere::albedo))), opacity(in(&Hemisphere::opacity))},
       {of("albedo", TextureUse::kReflectance, in(&Hemisphere::albedo_texture))}},
      {"metal",
       "Metal, from a perfect mirror to fuzzy reflection",
       Metal{},
       {required(vector<M>("albedo", kUnit, albedo, in(&Metal::albedo))),
        number<M>("fuzz", kUnit,
                  {"",
                   "Radius of the sphere, centred on the tip of the unit reflected direction, on which the perturbed "
                   "direction is sampled. Directions below the surface are absorbed. 0 is a perfect mirror. Or a "
                   "[texture](#textures)"},
                  in(&Metal::fuzz)),
        opacity(in(&Metal::opacity))},
       {of("albedo", TextureUse::kReflectance, in(&Metal::albedo_texture)),
        of("fuzz", TextureUse::kNumber, in(&Metal::fuzz_texture))}},
      {"dielectric",
       "Dielectric, such as glass, water, or an air bubble in water; clear or rough",
       Dielectric{},
       {number<M>("ior", {1e-6, 1e6}, {"", "Refractive index of the inside, relative to the surrounding medium"},
                  in(&Dielectric::ior)),
        choice<M>("fresnel", {"schlick", "exact", "none"},
                  {"",
                   "Fresnel reflectance. `schlick`: Schlick's approximation, as in the book. `exact`: Fresnel "
                   "equations. `none`: refraction only, apart from total internal reflection"},
                  in(&Dielectric::fresnel)),
        number<M>(
            "fuzz", kUnit,
            {"",
             "Radius of the sphere, centred on the tip of the unit reflected or refracted direction, on which the "
             "perturbed direction is sampled. Directions on the wrong side of the surface are absorbed. 0: smooth. Or "
             "a [texture](#textures)",
             "Above 0: lights are found by BSDF sampling only"},
            in(&Dielectric::fuzz))},
       {of("fuzz", TextureUse::kNumber, in(&Dielectric::fuzz_texture))}},
      {"emitter",
       "A light: emits the same radiance in all directions and reflects nothing",
       Emitter{},
       {required(vector<M>("radiance", kLight,
                           {"scene-linear",
                            "Emitted radiance: radiant exitance divided by pi, per colour channel; or a "
                            "[texture](#textures)"},
                           in(&Emitter::radiance))),
        number<M>("exposure", {-kMaxStops, kMaxStops},
                  {"stops", "Multiplies the radiance by 2 to this power. The product is at most 2^34"},
                  in(&Emitter::exposure)),
        text<M>("light_group", {"", "Light group, for the layer `light_groups`. Default: the group `default`"},
                in(&Emitter::light_group)),
        opacity(in(&Emitter::opacity))},
       {of("radiance", TextureUse::kRadiance, in(&Emitter::radiance_texture))}},
      {"plastic",
       "Plastic or paint: a clear coat over a diffuse base",
       Plastic{},
       {required(vector<M>("albedo", kUnit,
                           {"scene-linear",
                            "Fraction of the light which reaches the base that is scattered, per colour channel; or a "
                            "[texture](#textures)"},
                           in(&Plastic::albedo))),
        number<M>("ior", {1, 1e6},
                  {"",
                   "Refractive index of the coat. It sets how much the coat reflects, by Schlick's approximation: 0.04 "
                   "at normal incidence for 1.5"},
                  in(&Plastic::ior)),
        number<M>("fuzz", kUnit,
                  {"",
                   "Roughness of the coat. Its highlights are as wide as those of metal with the same fuzz, but "
                   "brightest in the middle. 0: smooth. Or a [texture](#textures)"},
                  in(&Plastic::fuzz)),
        opacity(in(&Plastic::opacity))},
       {of("albedo", TextureUse::kReflectance, in(&Plastic::albedo_texture)),
        of("fuzz", TextureUse::kNumber, in(&Plastic::fuzz_texture))}},
  };
}

}  // namespace

const std::vector<MaterialType>& material_types() {
  static const std::vector<MaterialType> all = make_material_types();
  return all;
}

}  // namespace orrery::scene
