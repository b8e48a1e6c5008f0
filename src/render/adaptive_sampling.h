// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/compiled_scene.h"
#include "film/partial.h"
#include "render/progress_reporter.h"
#include "render/render.h"
#include "render/tile_pool.h"
#include "render/tile_renderer.h"

namespace orrery::render {

/// Samples in rounds: after each the pixels are chosen that shall double theirs, until the picture is as good as asked
/// for, the time is over, or the samples are.
///
/// Every pixel has two halves of samples that are independent of each other; how much they differ tells its error.
/// Choices depend on sums that no order of adding changes: without a time limit neither does the picture.
///
/// `state`    has halves; what is in it is gone on from, in the middle of a round, too
/// Result     false where the settings' `cancel` stopped it
bool render_adaptively(const compile::CompiledScene& compiled, const Settings& settings,
                       const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress,
                       film::Partial& state, Statistics& statistics);

}  // namespace orrery::render
