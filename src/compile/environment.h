// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/lights.h"
#include "scene/scene.h"

namespace orrery::compile {

/// How directions of an environment are sampled for direct lighting.
enum class EnvironmentSampling {
  kNone,
  kCompensated,  ///< in combination with BSDF sampling: only radiance above the mean
  kComplete,     ///< light sampling alone: all non-zero radiance
};

/// Returns how an environment is sampled for a scene's direct lighting.
EnvironmentSampling environment_sampling(kernel::DirectLighting lighting) noexcept;

struct EnvironmentSettings {
  double rotation = 0;  ///< degrees about +y, of map and sun
  double scale = 1;     ///< multiplies all radiance
  EnvironmentSampling sampling = EnvironmentSampling::kCompensated;
  std::uint16_t light_group = 0;
  bool visible = true;
};

/// Returns the memory use of a map of this size and of the tables of its distribution, in bytes.
std::uint64_t environment_bytes(int width, int height, EnvironmentSampling sampling);

/// An image background ready for rendering: shares the texels of the scene and owns the tables of their distribution.
///
/// Cost       4/3 bytes per texel in addition to the 12 bytes of the texels; none if it is not sampled
class EnvironmentMap {
 public:
  /// Builds the tables of the distribution.
  ///
  /// Domain     texels are finite and not negative
  EnvironmentMap(std::shared_ptr<const scene::LatLongMap> image, const EnvironmentSettings& settings);
  EnvironmentMap(const EnvironmentMap&) = delete;
  EnvironmentMap& operator=(const EnvironmentMap&) = delete;

  /// The same background with tables for another sampling mode.
  std::shared_ptr<const EnvironmentMap> with_sampling(EnvironmentSampling sampling) const;

  /// The view for the kernel; valid during the lifetime of this object.
  const kernel::Environment& view() const noexcept { return view_; }

  /// The memory of texels and tables.
  std::uint64_t bytes() const noexcept;

 private:
  std::shared_ptr<const scene::LatLongMap> image_;
  EnvironmentSettings settings_;
  std::vector<float> sums_;  ///< sums of all levels
  std::vector<kernel::EnvironmentRow> rows_;
  kernel::Environment view_;
};

}  // namespace orrery::compile
