// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/precision.h"
#include "kernel/scene_view.h"
#include "kernel/seen_emitters.h"

namespace orrery::render {

/// The emitters of each pixel that are sampled, since few of its camera rays would hit them: spheres whose image is
/// smaller than a pixel, or much smaller than the blur of the lens, and those and the sun in sharp balls, if the image
/// is smaller than a quarter of a pixel and hardly blurred, and there are at most 2^18 such balls.
///
/// Excluded: emitters and balls that move, are translucent or textured, and all of a camera that moves or is
/// orthographic, of scenes with a depth cue, and with direct_lighting = "bsdf"; images in balls in single precision.
/// The strongest are chosen if there are too many pixels of emitters, whatever window of the frame is rendered.
class SeenEmitterList {
 public:
  SeenEmitterList() = default;
  /// Cost       passes over the spheres if the scene is lit, one over up to 2^18 pairs of a ball and a light, and one
  ///            over the pixels of those that are sampled
  SeenEmitterList(const kernel::SceneView& scene, kernel::Precision precision, int width_px, int height_px);

  /// Memory that the constructor needs at most, for emitters within the window.
  static std::uint64_t bytes_of_build(const kernel::SceneView& scene, kernel::Precision precision, int width_px,
                                      int height_px);

  kernel::SeenEmitters view() const {
    if (emitters_.empty()) return {};
    return {begins_.data(), emitters_.data(), width_, sights_};
  }

 private:
  std::vector<std::uint32_t> begins_;
  std::vector<kernel::SeenEmitter> emitters_;
  std::vector<kernel::Sight> sights_;
  int width_ = 0;
};

/// Whether the camera moves while the shutter is open.
bool camera_moves(const kernel::SceneView& scene);

}  // namespace orrery::render
