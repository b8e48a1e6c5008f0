// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::scene {

enum class Precision;

class LatLongMap;
class NumberArray;
class PointArray;

struct Background;
struct BondStub;
struct Camera;
struct Color;
struct Image;
struct Interval;
struct Points;
struct PointsColor;
struct PointsKeys;
struct PointsRadius;
struct PointsTransform;
struct Render;
struct RodFile;
struct Scene;
struct SceneDiagnostic;
struct SphereBond;
struct Texture;

}  // namespace orrery::scene
