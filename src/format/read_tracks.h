// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "format/read_keys.h"
#include "scene/scene.h"

namespace orrery::format {

/// Reads [[key]], the numbers that change from frame to frame, into a scene whose materials and spheres are read.
void read_tracks(Reading& reading, const toml::array& list, scene::Scene& scene);

/// Reports numbers that go out of range between their keys at a frame, as cubic tracks may.
void check_tracks(Reading& reading, const toml::array& list, const scene::Scene& scene, double frame);

}  // namespace orrery::format
