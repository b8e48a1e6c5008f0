// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include "scene/forward.h"

namespace orrery::format {

struct ReadState;

/// Reads the [[key]] tables into the tracks of a scene whose materials and spheres have been read.
void read_tracks(ReadState& state, const toml::array& list, scene::Scene& scene);

/// Reports the tracks whose values are out of range at a frame: cubic tracks may overshoot between their keys.
void check_tracks(ReadState& state, const toml::array& list, const scene::Scene& scene, double frame);

}  // namespace orrery::format
