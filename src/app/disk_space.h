// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "app/job.h"
#include "compile/world.h"

namespace orrery::app {

/// Refuses a render whose files the disk has no room for, before it is begun. Files are taken for as large as they are
/// without compression, but for JPEG; those that will be replaced are still there meanwhile.
///
/// Domain     `layer_planes` beside R, G, B, A
/// Errors     base::Error(kCannotCreate) with both figures
void require_disk_space(const Job& job, const compile::World& world, std::size_t layer_planes);

}  // namespace orrery::app
