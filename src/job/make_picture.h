// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "job/checkpoint.h"
#include "job/job.h"
#include "job/layers.h"
#include "render/render.h"
#include "compile/compiled_scene.h"
#include "image/partial_file.h"

namespace orrery::job {

/// Renders, going on from a checkpoint where there is one, and leaves one behind where it is stopped.
///
/// `settings` those of the machine; what the job asks for is added
/// Errors     base::Error: kStopped; those of Checkpoint::load and write
render::Result render_job(const Job& job, const compile::CompiledScene& compiled, render::Settings settings,
                          Checkpoint& checkpoint, double seconds_so_far, JobReport& report);

/// Adds up the parts instead of rendering.
///
/// Errors     base::Error(kBadData) where the scene has changed since; those of merge_shards
render::Result merge_job(const Job& job, const compile::CompiledScene& compiled, const Layers& layers,
                         const image::Provenance& provenance, JobReport& report);

/// What can be seen of a picture so far.
film::Picture preview(const compile::CompiledScene& compiled, const film::Partial& partial);

/// Whether all files of a job are there, whole, and what it would write again.
bool is_there(const Job& job, const compile::CompiledScene& compiled, const image::Provenance& provenance,
              const std::string& stamp);

/// Ends a job because somebody wants to.
///
/// Errors     base::Error(kStopped)
[[noreturn]] void stop_job(const std::string& remedy = "");

}  // namespace orrery::job
