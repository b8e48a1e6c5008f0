// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::load {

struct LoadedMap;
struct LoadedScene;
struct SceneRequest;
struct SceneSource;

}  // namespace orrery::load
