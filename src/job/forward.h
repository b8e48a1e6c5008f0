// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::job {

struct Hooks;
struct Job;
class PreparedScene;

}  // namespace orrery::job
