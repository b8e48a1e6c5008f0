// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "job/job.h"
#include "job/rendering.h"

namespace orrery::job {

/// Renders a scene to files, or merges shards.
///
/// A shard is an EXR of exact sums; so is the checkpoint of a stopped job. A resumed job gives the same bits as one
/// that was never stopped. No output replaces an input, including the scene's points files and OCIO configs.
///
/// Before rendering starts, the job checks that its files can be created and that formats, compression, display and
/// view exist. The statistics file is also written if the job is stopped or fails after these checks.
///
/// Domain     at least one output
/// Errors     base::Error of any kind; kStopped if `cancel` stopped the job, in which case no image was written
JobReport run_job(const Job& job);

/// Renders a scene with all its layers, and writes no file.
///
/// Domain     no outputs and no shards; the checkpoint settings are the defaults
/// Errors     those of run_job
Rendering render_in_memory(const Job& job);

}  // namespace orrery::job
