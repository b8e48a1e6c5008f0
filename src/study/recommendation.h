// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/forward.h"

namespace orrery::study {

class StudyRenderer;
struct Request;
struct Study;

/// Chooses settings for the target noise from the points of a study and tests them at full resolution, as far as the
/// budget allows.
///
/// `study`    with its points; gets the recommendation, and an entry of left_out if it could not be tested
/// `full`     the scene at full resolution
/// `paths_per_s` measured speed
/// Domain     the study has at least two points
/// Errors     those of StudyRenderer::render
void recommend(const Request& request, const compile::CompiledScene& full, double paths_per_s, StudyRenderer& renderer,
               Study& study);

}  // namespace orrery::study
