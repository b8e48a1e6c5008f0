// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "math/vec3.h"

namespace orrery::kernel {

/// A thin-lens camera in the kernel's representation. The ray through the film point p = x right + y down, with (x, y)
/// in pixels from the film's centre and y down, and the lens point l = u lens_u + v lens_v, with (u, v) on the unit
/// disc, starts at origin + l and points to origin + forward + p. With an orthographic camera, it starts at origin + p
/// + l and points to origin + p + forward.
///
/// Space      world; `forward` extends to the focus plane, so all rays of a film point intersect there
struct Camera {
  math::Vec3d origin;
  math::Vec3d forward{0, 0, -1};  ///< vector to the centre of the focus plane
  math::Vec3d right{1, 0, 0};     ///< one pixel to the right on the focus plane
  math::Vec3d down{0, -1, 0};     ///< one pixel down on the focus plane
  math::Vec3d lens_u;             ///< lens radius along right; zero for a pinhole
  math::Vec3d lens_v;             ///< lens radius along up
  double half_width = 0;          ///< px, from the left edge of the rendered window to the centre of the frame
  double half_height = 0;         ///< px, from the upper edge of the rendered window to the centre of the frame
  bool is_orthographic = false;
};

inline constexpr math::Vec3d Camera::*kCameraVectors[] = {&Camera::origin, &Camera::forward, &Camera::right,
                                                          &Camera::down,   &Camera::lens_u,  &Camera::lens_v};

enum class SamplerKind : std::uint8_t {
  kIndependent,  ///< independent random numbers
  kSobol,        ///< low discrepancy over a pixel's samples
  kBlueNoise,    ///< also low discrepancy over neighbouring pixels, so that their errors cancel
};

/// The source of a path's random numbers.
///
/// They are a function of (seed, pixel, sample, vertex) alone, so an image does not depend on the order of rendering.
/// Samples from kSecondHalf on form a second sequence, independent of the first: the difference between a pixel's two
/// independent halves estimates its error.
struct Sampler {
  SamplerKind kind = SamplerKind::kSobol;
  std::uint32_t seed = 1;
  int blue_noise_bits = 0;  ///< kBlueNoise: bits of the index that count a pixel's samples, 0..16

  static constexpr std::uint32_t kSecondHalf = 0x80000000u;
};

/// A pixel filter, importance sampled: it displaces a path's start within and around the pixel, so that all paths have
/// the same weight and pixels stay independent.
struct PixelFilter {
  static constexpr int kSteps = 1024;

  /// The filter is separable, symmetric and not negative. Inverse distribution function along one axis: distances from
  /// the pixel's centre, px, at kSteps + 1 evenly spaced probabilities. Null: a box of one pixel.
  const double* places = nullptr;
};

}  // namespace orrery::kernel
