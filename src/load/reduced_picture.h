// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "format/forward.h"

namespace orrery::load {

/// Reduces the resolution of a scene to at most this many pixels with the same view, at both shutter times. Drops crop
/// and overscan.
///
/// Domain     pixels >= 1
void reduce_picture(format::ReadResult& scene, double pixels);

}  // namespace orrery::load
