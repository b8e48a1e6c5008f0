// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "job/job.h"
#include "compile/compiled_scene.h"

namespace orrery::job {

/// Everything that can be known to fail before hours are spent, but for the scene.
///
/// Errors     base::Error: kUsage, kCannotCreate
void check_request(const Job& job);

/// The same of what only the scene can tell.
///
/// Errors     base::Error(kUsage)
void check_samples(const Job& job, const compile::CompiledScene& compiled);

/// Checks that the formats of a job's files take a picture of this size.
///
/// Errors     base::Error(kUsage)
void check_sizes(const Job& job, const compile::CompiledScene& compiled);

}  // namespace orrery::job
