// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "math/pixels.h"
#include "math/vec3.h"

namespace orrery::scene {

/// The sun of an image background: a disc of constant radiance, separate from the texels.
struct Sun {
  math::Vec3d direction{0, 1, 0};  ///< unit, from the scene to the centre of the disc, in the map's space
  double one_minus_cos = 0;        ///< 1 - cos of half the angle that the disc subtends
  math::Vec3d radiance{0, 0, 0};   ///< scene-linear, working space; 0: no sun
};

/// A latitude-longitude map, as the OpenEXR and USD conventions orient it: rows from +y to -y, longitude 0 at +z, +x at
/// a quarter of the width.
///
/// Cost       12 bytes per texel. Rows take no memory until they are written.
class LatLongMap {
 public:
  /// Creates a map whose texels are uninitialized.
  LatLongMap(int width, int height)
      : width_(width), height_(height), values_(std::make_unique_for_overwrite<float[]>(begin_of(height) + kPadding)) {
    values_[begin_of(height)] = 0;
  }

  int width() const { return width_; }    ///< texels
  int height() const { return height_; }  ///< texels

  /// R, G, B of the texels in a row, in the working space, finite and not negative. One more float can be read at the
  /// end of the last row.
  float* row(int y) { return &values_[begin_of(y)]; }
  const float* row(int y) const { return &values_[begin_of(y)]; }

  Sun sun;
  /// The lower levels of a mip map, without sun; empty for backgrounds.
  std::vector<LatLongMap> reduced;

 private:
  static constexpr std::size_t kPadding = 1;  ///< the kernel loads texels as four floats

  std::size_t begin_of(int y) const { return 3 * math::pixel_index(0, y, width_); }

  int width_, height_;
  std::unique_ptr<float[]> values_;
};

}  // namespace orrery::scene
