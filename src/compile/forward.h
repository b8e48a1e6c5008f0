// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::compile {

enum class EnvironmentSampling;

class EnvironmentMap;

struct CompiledScene;

}  // namespace orrery::compile
