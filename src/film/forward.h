// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::film {

struct DeepPicture;
struct EncodedPicture;
struct LayerRequest;
struct Picture;
struct Plane;
struct RenderedPixels;
struct RenderWork;
struct Sums;

}  // namespace orrery::film
