// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compile/forward.h"
#include "format/forward.h"
#include "image/forward.h"

namespace orrery::job {

struct JobReport;

/// The header of a job's images: camera, colour space, settings, statistics.
///
/// `reproducible` omits everything that depends on the machine, the thread count or the accelerator.
image::Header picture_header(const format::ReadResult& read, const compile::CompiledScene& compiled,
                             const JobReport& report, bool reproducible);

/// All settings as lines of a scene file: "camera.vfov = 20".
///
/// `reproducible` omits the accelerator.
std::string settings_lines(const format::ReadResult& read, bool reproducible);

}  // namespace orrery::job
