// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/job.h"
#include "compile/world.h"

namespace orrery::app {

/// Everything that can be known to fail before hours are spent, but for the scene.
///
/// Errors     base::Error: kUsage, kCannotCreate
void check_request(const Job& job);

/// The same of what only the scene can tell.
///
/// Errors     base::Error(kUsage)
void check_samples(const Job& job, const compile::World& world);

/// Checks that the formats of a job's files take a picture of this size.
///
/// Errors     base::Error(kUsage)
void check_sizes(const Job& job, const compile::World& world);

/// How rays shall go through the hierarchy.
///
/// Errors     base::Error(kUsage) for a name that is none
render::Traversal traversal_of(const Job& job);

}  // namespace orrery::app
