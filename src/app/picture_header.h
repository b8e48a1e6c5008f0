// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/job.h"
#include "compile/world.h"
#include "format/read_scene.h"

namespace orrery::app {

/// What a compositor, and whoever wonders a year later, finds in the header of a picture.
///
/// With `reproducible`, two renders of one scene have the same header, whatever the machine, threads and accelerator.
image::Header picture_header(const format::ReadResult& read, const compile::World& world, const JobReport& report,
                             bool reproducible);

}  // namespace orrery::app
