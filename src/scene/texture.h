// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "math/vec3.h"

namespace orrery::scene {

class LatLongMap;
struct Scene;

enum class TextureType { kChecker, kNoise, kTurbulence, kMarble, kImage };

/// How the texels of an image are averaged over the footprint of a ray: with a mip map, or only by the pixel's samples.
enum class TextureFilter { kMip, kBilinear };

/// A texture of a material. If it replaces a number, such as `fuzz`, all components of its colours are equal.
struct Texture {
  TextureType type = TextureType::kChecker;
  double scale = 1;           ///< checker: edge of a cell, scene units; noise: lattice cells per scene unit
  math::Vec3d low{0, 0, 0};   ///< checker: even cells; noise: at 0
  math::Vec3d high{1, 1, 1};  ///< checker: odd cells; noise: at 1
  std::uint32_t seed = 1;     ///< noise
  // Image.
  std::filesystem::path file = {};  ///< latitude-longitude map, relative to the scene file
  std::string color_space = {};     ///< empty: determined from the file's metadata or format
  double rotation = 0;              ///< degrees about +y
  TextureFilter filter = TextureFilter::kMip;
  std::shared_ptr<const LatLongMap> image = {};  ///< the texels of `file`; null until loaded
};

/// Use of a texture; determines the type and range of its values.
enum class TextureUse { kReflectance, kRadiance, kNumber };

/// A texture of a scene, and the key whose value it is.
struct NamedTexture {
  std::string key;  ///< "material.earth.albedo"
  TextureUse use;
  const Texture* texture;  ///< valid until the scene's material is modified
};

/// All textures of a scene, in the order of its materials.
std::vector<NamedTexture> textures(const Scene& scene);

/// The image textures of a scene, in the same order.
std::vector<NamedTexture> image_textures(const Scene& scene);

/// Replaces every texture of a scene by a copy that `modify` has changed.
void modify_textures(Scene& scene, const std::function<void(Texture& texture, TextureUse use)>& modify);

}  // namespace orrery::scene
