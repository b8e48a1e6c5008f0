// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/file_set.h"
#include "compile/forward.h"
#include "job/job.h"
#include "scene/forward.h"

namespace orrery::job {

/// Adds the files that a job reads and writes according to its command line.
///
/// `owner`    appended to roles in messages about several scenes: " of shot.toml"
/// Errors     base::Error(kUsage) for an output that is an input or another output
void add_job_files(const Job& job, base::FileSet& files, const std::string& owner = {});

/// Checks everything in a request that does not depend on the scene: formats, bit depths, whether files can be created,
/// compression, instruction set.
///
/// Errors     base::Error: kUsage, kCannotCreate
void check_request(const Job& job);

/// Checks that at least one output can hold the layers that the command line requests.
///
/// Errors     base::Error(kUsage)
void check_layers(const Job& job, const scene::Scene& scene);

/// Checks that --sample-range A:B is within the scene's sample count, and that the formats of the image files support
/// an image of this size.
///
/// Errors     base::Error(kUsage)
void check_scene(const Job& job, const compile::CompiledScene& compiled);

}  // namespace orrery::job
