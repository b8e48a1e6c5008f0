// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compile/forward.h"
#include "film/forward.h"
#include "image/provenance.h"
#include "render/forward.h"

namespace orrery::job {

class Checkpoint;
struct Job;
struct JobReport;
class PreparedScene;

/// Renders, resuming from the checkpoint if there is one, and writes a checkpoint if stopped. Builds the accelerator of
/// the prepared scene, unless there is one.
///
/// `settings` threads, traversal, layers and callbacks; the job's sampling limits are added
/// Errors     base::Error: kStopped; those of Checkpoint::load and write
render::Result render_job(const Job& job, PreparedScene& prepared, const compile::CompiledScene& compiled,
                          render::Settings settings, Checkpoint& checkpoint, double seconds_so_far, JobReport& report);

/// Merges shards instead of rendering.
///
/// `settings` threads and layers
/// Errors     base::Error(kBadData) if the scene has changed since; those of merge_shards
render::Result merge_job(const Job& job, const compile::CompiledScene& compiled, const render::Settings& settings,
                         const image::Provenance& provenance, JobReport& report);

/// The beauty image of a partial render.
film::Picture preview(const compile::CompiledScene& compiled, const film::Partial& partial);

/// True if all files of a job exist, are intact, and equal those that it would write.
bool is_up_to_date(const Job& job, const compile::CompiledScene& compiled, const image::Provenance& provenance,
                   const std::string& stamp);

/// Ends a cancelled job.
///
/// Errors     base::Error(kStopped)
[[noreturn]] void stop_job(const std::string& remedy = "");

}  // namespace orrery::job
