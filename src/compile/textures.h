// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/material.h"
#include "math/vec3.h"
#include "scene/scene.h"

namespace orrery::compile {

/// Width of the ray cones that filter image textures, as a fraction of the ranges from which rays are sampled: pixel,
/// lens and lobe.
///
/// The samples of a pixel average the texture over these ranges; cones as wide as these ranges would blur the image.
/// Cones of a sixteenth of that width change a pixel next to a hard edge by at most 1 % of the contrast.
///
/// Reference  docs/decisions/0031
inline constexpr double kConeWidth = 0.0625;

/// The textures of a compiled scene, and the images that they share. Copies share the images.
class TextureStore {
 public:
  /// Adds a texture whose values are multiplied by `factor`.
  ///
  /// Result     its index; kernel::kNone for an image that is not loaded
  std::uint32_t add(const scene::Texture& texture, math::Vec3d factor = {1, 1, 1});
  /// Adds a copy of a texture whose values are multiplied by `factor`.
  std::uint32_t add_scaled(std::uint32_t index, math::Vec3d factor);

  /// Sets the textures of the next material.
  void add_material(const kernel::MaterialTextures& textures) { materials_.push_back(textures); }
  const kernel::MaterialTextures& material(std::size_t index) const { return materials_[index]; }

  const std::vector<kernel::Texture>& textures() const noexcept { return textures_; }
  /// One entry per material.
  const std::vector<kernel::MaterialTextures>& materials() const noexcept { return materials_; }

  /// True if an image has more than one level, so that paths need ray cones.
  bool has_levels() const noexcept;

  /// Memory use of the images and their levels, in bytes.
  std::uint64_t bytes() const noexcept;

 private:
  /// A loaded image and its view for the kernel, including the rotation.
  struct Image {
    std::shared_ptr<const scene::LatLongMap> texels;
    kernel::TextureImage view;
  };

  std::vector<kernel::Texture> textures_;
  std::vector<kernel::MaterialTextures> materials_;
  std::vector<std::shared_ptr<const Image>> images_;
};

/// Mean value of a texture, for sampling its material: for an image, the mean over the sphere; for other textures, the
/// midpoint of their two values.
math::Vec3d mean_of(const scene::Texture& texture);

}  // namespace orrery::compile
