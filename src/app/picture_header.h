// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/job.h"
#include "compile/world.h"
#include "scene/scene.h"

namespace orrery::app {

/// What a compositor, and whoever wonders a year later, finds in the header of a picture.
image::Header picture_header(const scene::Scene& scene, const compile::World& world, const JobReport& report,
                             bool reproducible);

}  // namespace orrery::app
