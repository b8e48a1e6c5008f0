// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compile/compiled_scene.h"
#include "format/read_scene.h"
#include "job/job_report.h"

namespace orrery::job {

/// The header of a job's images: camera, colour space, settings, statistics.
///
/// `reproducible` omits everything that depends on the machine, the thread count or the accelerator.
image::Header picture_header(const format::ReadResult& read, const compile::CompiledScene& compiled,
                             const JobReport& report, bool reproducible);

}  // namespace orrery::job
