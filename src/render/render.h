// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "accel/accel.h"
#include "compile/forward.h"
#include "film/sums.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::render {

/// The number of processors in the process's affinity mask.
int available_threads();

/// Builds the scene's accelerator for its precision.
///
/// Domain     the compiled scene's spheres outlive the result
/// Errors     base::Error(kInternal) if it cannot be built, kStopped if the monitor cancelled the build
std::unique_ptr<accel::Accel> build(const compile::CompiledScene& compiled, int threads,
                                    const accel::BuildMonitor& monitor = {});

/// Renders an image with an accelerator that was built for this scene and precision.
///
/// `from`     sums of the same scene and settings to resume from; empty: none
/// Result     completed == false if stopped by `cancel`; build_s is 0
/// Errors     base::Error(kStopped) in a base::StopScope, without the samples so far
Result render(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings,
              std::optional<film::Sums> from = std::nullopt);

/// Builds the accelerator and renders an image.
///
/// The image's bits depend only on the scene, not on threads, tiles, accelerator or interruptions.
///
/// Result     completed == false if stopped by `cancel`
/// Errors     base::Error(kInternal) if the accelerator cannot be built
Result render(const compile::CompiledScene& compiled, const Settings& settings,
              std::optional<film::Sums> from = std::nullopt);

/// The number of samples per pixel that the settings request.
std::uint32_t samples_of(const compile::CompiledScene& compiled, const Settings& settings);

/// The fraction of the pixels whose sums take memory: paths of the others, which are in the bounds of no object, are
/// known.
///
/// Cost       about 50 ns per object
double share_with_objects(const compile::CompiledScene& compiled, const film::LayerRequest& layers, int threads);

/// Converts sums to an image; pixels without samples are black.
///
/// `threads`  0: all available
Result finished(const compile::CompiledScene& compiled, const film::LayerRequest& layers, const film::Sums& sums,
                int threads);

/// The version of oneTBB in use.
std::string tbb_version();

}  // namespace orrery::render
