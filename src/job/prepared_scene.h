// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "accel/accel.h"
#include "compile/compiled_scene.h"
#include "film/motion_vectors.h"
#include "job/scene_hash.h"
#include "load/load_scene.h"
#include "points/load_points.h"

namespace orrery::job {

/// A scene that is ready to be rendered, again and again: loaded, compiled, with its BVH. Each round of load(),
/// compile() and accelerator() makes again what has changed since the round before, and nothing else: data files are
/// read again if they or the keys about them have changed, the BVH is built again if the spheres have changed.
///
/// The result of a round does not depend on earlier ones. A round that fails or is not completed forgets everything.
class PreparedScene {
 public:
  /// `keeps_files`  keep data files open that may have several frames; see points::open_once
  explicit PreparedScene(bool keeps_files = false);
  PreparedScene(const PreparedScene&) = delete;
  PreparedScene& operator=(const PreparedScene&) = delete;

  /// Reads a scene, and of its files those that have changed.
  ///
  /// Errors     those of load::load_scene
  const load::LoadedScene& load(load::SceneRequest request);

  /// Compiles what has changed, and releases the loaded spheres.
  ///
  /// `memory_limit`  see require_memory_to_compile
  /// Domain     after load()
  /// Errors     base::Error: kNoMemory; kStopped in a base::StopScope
  const compile::CompiledScene& compile(std::uint64_t memory_limit);

  /// Builds the accelerator, unless there is one.
  ///
  /// `threads`  0: all available
  /// Domain     after compile()
  /// Errors     those of render::build
  accel::Accel& accelerator(int threads, const accel::BuildMonitor& monitor);

  /// Results of the last load() and compile().
  const load::LoadedScene& loaded() const { return *loaded_; }
  const compile::CompiledScene& compiled() const { return compiled_; }

  /// What has moved in the frames before and after; for motion vectors.
  const film::NeighborFrames& neighbors() const { return neighbors_; }

  bool has_accelerator() const { return accel_ != nullptr; }
  /// The result of the last accelerator().
  const accel::Accel& built() const { return *accel_; }

  /// The hashes of the compiled scene.
  const SceneHashes& hashes() const { return hashes_; }

 private:
  void clear();

  std::optional<load::LoadedScene> loaded_;
  compile::CompiledScene compiled_;
  film::NeighborFrames neighbors_;
  std::unique_ptr<accel::Accel> accel_;  ///< of the spheres of compiled_
  std::string isa_;                      ///< instruction set that accel_ was built for
  base::Hash sphere_hash_;
  SceneHashes hashes_;
  points::OpenData open_data_;  ///< empty: data::open
  bool is_complete_ = false;    ///< loaded and compiled
};

}  // namespace orrery::job
