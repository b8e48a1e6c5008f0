// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/precision.h"
#include "kernel/scene_view.h"
#include "kernel/seen_emitters.h"

namespace orrery::render {

/// The emitters of each pixel that are sampled, since few of its camera rays would hit them: spheres whose image is
/// smaller than a pixel, or much smaller than the blur of the lens.
///
/// Excluded: those that move, are translucent or textured, and all of a camera that moves or is orthographic, of scenes
/// with a depth cue, and with direct_lighting = "bsdf". The strongest are chosen if there are too many pixels of
/// emitters, whatever window of the frame is rendered.
class SeenEmitterList {
 public:
  SeenEmitterList() = default;
  /// Cost       one pass over the spheres if something emits, and one over the pixels of those that are sampled
  SeenEmitterList(const kernel::SceneView& scene, kernel::Precision precision, int width_px, int height_px);

  /// Memory that the constructor needs at most, for emitters within the window.
  static std::uint64_t bytes_of_build(const kernel::SceneView& scene, kernel::Precision precision, int width_px,
                                      int height_px);

  kernel::SeenEmitters view() const {
    if (emitters_.empty()) return {};
    return {begins_.data(), emitters_.data(), width_, ids_};
  }

 private:
  std::vector<std::uint32_t> begins_;
  std::vector<kernel::SeenEmitter> emitters_;
  std::vector<std::uint32_t> ids_;
  int width_ = 0;
};

/// Whether the camera moves while the shutter is open.
bool camera_moves(const kernel::SceneView& scene);

}  // namespace orrery::render
