// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "compile/forward.h"
#include "film/forward.h"

namespace orrery::render {

class ProgressReporter;
class TilePool;
class TileRenderer;
struct Settings;
struct Statistics;

/// Adaptive sampling: each iteration doubles the samples of selected pixels, until the image reaches the target noise,
/// or the time budget or the samples are used up.
///
/// Every pixel has two independent halves of samples, whose difference estimates its error. The selection depends only
/// on sums that are exact in any order of addition, so the image is deterministic without a time budget.
///
/// `state`    has halves; rendering continues from it, even within an iteration
/// Result     false if cancelled by the settings' `cancel`
bool render_adaptively(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings,
                       const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress, film::Sums& state,
                       Statistics& statistics);

}  // namespace orrery::render
