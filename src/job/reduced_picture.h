// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "format/read_scene.h"

namespace orrery::job {

/// Reduces the picture of a scene that was read, when the shutter opens and when it closes, to at most this many pixels
/// of the same view. Crop and overscan are dropped.
///
/// Domain     pixels >= 1
void reduce_picture(format::ReadResult& scene, double pixels);

}  // namespace orrery::job
