// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::kernel {

struct Features;
struct GuideSum;
struct LightEvent;
struct LightEvents;
struct PathRecord;
struct PathStream;
struct PixelSum;
struct SceneView;
struct SphereArray;
struct Tile;
struct TileCounts;
struct Tracer;

template <class T>
struct RayPacket;

}  // namespace orrery::kernel
