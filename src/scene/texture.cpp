// SPDX-License-Identifier: Apache-2.0
// The keys of textures, and the textures of a scene.
#include "scene/texture.h"

#include <limits>

#include <fmt/core.h>

#include "scene/key_builders.h"

namespace orrery::scene {
namespace {

using Keys = std::vector<Key<Texture>>;

/// A value of a texture: a colour or, in the first component, a number.
Key<Texture> value(TextureUse use, const char* name, const char* doc, Vec3d Texture::*member) {
  if (use == TextureUse::kNumber) {
    Key<Texture> key = key_at<Texture>(name, ValueType::kNumber, kUnit, {doc},
                                       [member](Texture& t) -> double& { return (t.*member).x; });
    key.set = [member](Texture& t, const Value& v) {
      const double x = std::get<double>(v);
      t.*member = {x, x, x};
    };
    return key;
  }
  const Range range = use == TextureUse::kRadiance ? kLight : kUnit;
  return vector(name, range, {doc, "scene-linear"}, member);
}

Keys noise_keys(TextureUse use, const char* scale) {
  return {number("scale", {kSmallestScale, kLargestScale}, {scale, "per scene unit"}, &Texture::scale),
          integer("seed", {0, std::numeric_limits<std::uint32_t>::max()}, {"Seed of the noise"}, &Texture::seed),
          value(use, "low", "Value where the pattern is 0", &Texture::low),
          value(use, "high", "Value where the pattern is 1", &Texture::high)};
}

std::vector<TextureTypeKeys> make_texture_types(TextureUse use) {
  const char* const spectrum = "Spatial frequency: noise cells per scene unit";
  return {
      {"checker",
       "3D checkerboard of cubes in world space, with a cube corner at the origin",
       TextureType::kChecker,
       {number("scale", {kSmallestScale, kLargestScale}, {"Edge length of the cubes", "scene units"}, &Texture::scale),
        required(value(use, "even",
                       "Value of the cube between 0 and `scale` on each axis, and of all cubes of the same parity",
                       &Texture::low)),
        required(value(use, "odd", "Value of the other cubes", &Texture::high))}},
      {"noise", "Perlin noise in world space", TextureType::kNoise, noise_keys(use, spectrum)},
      {"turbulence", "Turbulence: absolute value of seven summed octaves of Perlin noise, clamped to 1",
       TextureType::kTurbulence, noise_keys(use, spectrum)},
      {"marble", "Marble: sine wave along z, perturbed by turbulence", TextureType::kMarble,
       noise_keys(use,
                  "Angular frequency of the wave, in radians per scene unit. The turbulence has one cell per unit")},
      {"image",
       "Latitude-longitude image mapped onto the sphere",
       TextureType::kImage,
       {required(file("file", kTextureFile,
                      {"Image file, relative to the scene file: EXR, HDR, PNG, JPEG, TIFF or PPM, with +y at the top, "
                       "+x at the centre and +z halfway to the left edge. May contain a frame pattern such as `####`",
                       "", "16 bytes per texel"},
                      &Texture::file)),
        text("color_space",
             {"Colour space of `file`, if the file does not declare one. Default: `srgb_texture` for 8-bit and 16-bit "
              "integers, else `color.space`. Ignored for number keys such as `fuzz`"},
             &Texture::color_space),
        number("rotation", {-kLargestRotation, kLargestRotation}, {"Rotation about +y; 90 turns +z to +x", "degrees"},
               &Texture::rotation),
        choice("filter", {"mip", "bilinear"},
               {"`mip`: a mip map averages small texels over a sixteenth of a pixel or lobe. `bilinear`: texels are "
                "interpolated, and averaged only by the samples",
                "", "`bilinear`: up to three times the error at the same number of samples, without blur"},
               &Texture::filter)}}};
}

}  // namespace

const std::vector<TextureTypeKeys>& texture_types(TextureUse use) {
  static const std::vector<TextureTypeKeys> all[] = {make_texture_types(TextureUse::kReflectance),
                                                     make_texture_types(TextureUse::kRadiance),
                                                     make_texture_types(TextureUse::kNumber)};
  return all[static_cast<std::size_t>(use)];
}

const TextureTypeKeys& type_of(const Texture& texture, TextureUse use) {
  return texture_types(use)[static_cast<std::size_t>(texture.type)];
}

std::vector<NamedTexture> textures(const Scene& scene) {
  std::vector<NamedTexture> out;
  for (const Material& material : scene.materials)
    for (const TexturedKey& key : type_of(material.model).textured)
      if (const TextureSlot texture = key.get(material.model))
        out.push_back({fmt::format("material.{}.{}", material.name, key.name), key.use, texture.get()});
  return out;
}

std::vector<NamedTexture> image_textures(const Scene& scene) {
  std::vector<NamedTexture> out = textures(scene);
  std::erase_if(out, [](const NamedTexture& named) { return named.texture->type != TextureType::kImage; });
  return out;
}

void modify_textures(Scene& scene, const std::function<void(Texture& texture, TextureUse use)>& modify) {
  for (Material& material : scene.materials) {
    for (const TexturedKey& key : type_of(material.model).textured) {
      TextureSlot& slot = key.at(material.model);
      if (!slot) continue;
      const auto copy = std::make_shared<Texture>(*slot);
      modify(*copy, key.use);
      slot = copy;
    }
  }
}

}  // namespace orrery::scene
