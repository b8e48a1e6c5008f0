// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "job/job_report.h"
#include "compile/compiled_scene.h"
#include "format/read_scene.h"

namespace orrery::job {

/// What a compositor, and whoever wonders a year later, finds in the header of a picture.
///
/// With `reproducible`, two renders of one scene have the same header, whatever the machine, threads and accelerator.
image::Header picture_header(const format::ReadResult& read, const compile::CompiledScene& compiled,
                             const JobReport& report, bool reproducible);

}  // namespace orrery::job
