// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/hash.h"
#include "compile/forward.h"
#include "kernel/camera.h"
#include "kernel/rod.h"
#include "kernel/sphere.h"

namespace orrery::job {

/// Hashes of everything that determines the image: spheres, materials, lights, camera, background, seed. They exclude
/// names, comments and the accelerator, which change no bit of the image.
struct SceneHashes {
  std::string of_samples;  ///< without the number of samples: what determines each sample of each pixel
  std::string of_image;    ///< with the number of samples
};

/// The part of the hashes that depends on the spheres and on which material each has; it takes longest.
base::Hash hash_of_spheres(const compile::CompiledScene& compiled);

/// Adds changes of objects, and the vectors of a camera or their changes.
void add_motion(base::Hash& hash, const std::vector<kernel::Sphere>& spheres, const std::vector<kernel::Rod>& rods,
                const kernel::Camera& camera);

/// Completes hash_of_spheres().
SceneHashes scene_hashes(const compile::CompiledScene& compiled, base::Hash spheres);

/// SceneHashes::of_image, which identifies the scene.
inline std::string scene_hash(const compile::CompiledScene& compiled) {
  return scene_hashes(compiled, hash_of_spheres(compiled)).of_image;
}

}  // namespace orrery::job
