// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/compiled_scene.h"
#include "format/read_scene.h"
#include "job/job_report.h"

namespace orrery::job {

/// The header of a job's images: camera, colour space, settings, statistics.
///
/// `reproducible` gives every render of a scene the same header on any machine, thread count and accelerator.
image::Header picture_header(const format::ReadResult& read, const compile::CompiledScene& compiled,
                             const JobReport& report, bool reproducible);

}  // namespace orrery::job
