// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Declarations of the room's types, for headers that only name them.
namespace orrery::display {

class PixelDeveloper;

struct Choice;
struct PictureInfo;
struct Settings;

}  // namespace orrery::display
