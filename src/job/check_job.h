// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/forward.h"
#include "scene/forward.h"

namespace orrery::job {

struct Job;

/// Checks everything in a request that does not depend on the scene: formats, bit depths, whether files can be created,
/// compression, instruction set.
///
/// Errors     base::Error: kUsage, kCannotCreate
void check_request(const Job& job);

/// Checks that at least one output can hold the layers that the command line requests.
///
/// Errors     base::Error(kUsage)
void check_layers(const Job& job, const scene::Scene& scene);

/// Checks that --sample-range A:B is within the scene's sample count.
///
/// Errors     base::Error(kUsage)
void check_samples(const Job& job, const compile::CompiledScene& compiled);

/// Checks that the formats of the image files support an image of this size.
///
/// Errors     base::Error(kUsage)
void check_sizes(const Job& job, const compile::CompiledScene& compiled);

}  // namespace orrery::job
