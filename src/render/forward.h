// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::render {

struct PixelShard;
struct Progress;
struct Result;
struct Settings;
struct Statistics;

template <class T>
struct RecordedRays;

}  // namespace orrery::render
