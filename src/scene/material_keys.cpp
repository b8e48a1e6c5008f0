// SPDX-License-Identifier: Apache-2.0
// The keys of materials.
#include "scene/key_builders.h"
#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::scene {
namespace {

std::vector<MaterialType> make_material_types() {
  using M = MaterialModel;
  const KeyDoc albedo{"scene-linear",
                      "Fraction of the light that is scattered, per colour channel; or a [texture](#textures)"};
  const auto of = [](const char* key, TextureUse use, auto at) { return TexturedKey{key, use, at}; };
  return {
      {"lambertian",
       "Diffuse, with Lambert's cosine law",
       Lambertian{},
       {required(vector<M>("albedo", kUnit, albedo, [](M& m) -> Vec3d& { return std::get<Lambertian>(m).albedo; }))},
       {of("albedo", TextureUse::kReflectance,
           [](M& m) -> TextureSlot& { return std::get<Lambertian>(m).albedo_texture; })}},
      {"hemisphere",
       "The book's first diffuse material: scatters uniformly over the hemisphere",
       Hemisphere{},
       {required(vector<M>("albedo", kUnit, albedo, [](M& m) -> Vec3d& { return std::get<Hemisphere>(m).albedo; }))},
       {of("albedo", TextureUse::kReflectance,
           [](M& m) -> TextureSlot& { return std::get<Hemisphere>(m).albedo_texture; })}},
      {"metal",
       "Metal, from a perfect mirror to fuzzy reflection",
       Metal{},
       {required(vector<M>("albedo", kUnit, albedo, [](M& m) -> Vec3d& { return std::get<Metal>(m).albedo; })),
        number<M>("fuzz", kUnit,
                  {"",
                   "Radius of the sphere, centred on the tip of the unit reflected direction, on which the perturbed "
                   "direction is sampled. Directions below the surface are absorbed. 0 is a perfect mirror. Or a "
                   "[texture](#textures)"},
                  [](M& m) -> double& { return std::get<Metal>(m).fuzz; })},
       {of("albedo", TextureUse::kReflectance, [](M& m) -> TextureSlot& { return std::get<Metal>(m).albedo_texture; }),
        of("fuzz", TextureUse::kNumber, [](M& m) -> TextureSlot& { return std::get<Metal>(m).fuzz_texture; })}},
      {"dielectric",
       "Dielectric, such as glass, water, or an air bubble in water; clear or rough",
       Dielectric{},
       {number<M>("ior", {1e-6, 1e6}, {"", "Refractive index of the inside, relative to the surrounding medium"},
                  [](M& m) -> double& { return std::get<Dielectric>(m).ior; }),
        choice<M>("fresnel", {"schlick", "exact", "none"},
                  {"",
                   "Fresnel reflectance. `schlick`: Schlick's approximation, as in the book. `exact`: Fresnel "
                   "equations. `none`: refraction only, apart from total internal reflection"},
                  [](M& m) -> Fresnel& { return std::get<Dielectric>(m).fresnel; }),
        number<M>(
            "fuzz", kUnit,
            {"",
             "Radius of the sphere, centred on the tip of the unit reflected or refracted direction, on which the "
             "perturbed direction is sampled. Directions on the wrong side of the surface are absorbed. 0: smooth. Or "
             "a [texture](#textures)",
             "Above 0: lights are found by BSDF sampling only"},
            [](M& m) -> double& { return std::get<Dielectric>(m).fuzz; })},
       {of("fuzz", TextureUse::kNumber, [](M& m) -> TextureSlot& { return std::get<Dielectric>(m).fuzz_texture; })}},
      {"emitter",
       "A light: emits the same radiance in all directions and reflects nothing",
       Emitter{},
       {required(vector<M>("radiance", kLight,
                           {"scene-linear",
                            "Emitted radiance: radiant exitance divided by pi, per colour channel; or a "
                            "[texture](#textures)"},
                           [](M& m) -> Vec3d& { return std::get<Emitter>(m).radiance; })),
        number<M>("exposure", {-kMaxStops, kMaxStops},
                  {"stops", "Multiplies the radiance by 2 to this power. The product is at most 2^34"},
                  [](M& m) -> double& { return std::get<Emitter>(m).exposure; }),
        text<M>("light_group", {"", "Light group, for the layer `light_groups`. Default: the group `default`"},
                [](M& m) -> std::string& { return std::get<Emitter>(m).light_group; })},
       {of("radiance", TextureUse::kRadiance,
           [](M& m) -> TextureSlot& { return std::get<Emitter>(m).radiance_texture; })}},
  };
}

}  // namespace

const std::vector<MaterialType>& material_types() {
  static const std::vector<MaterialType> all = make_material_types();
  return all;
}

}  // namespace orrery::scene
