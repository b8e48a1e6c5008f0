// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::kernel {

/// A pixel's coordinates within the rendered window, px.
struct PixelPlace {
  int x, y;
};

}  // namespace orrery::kernel
