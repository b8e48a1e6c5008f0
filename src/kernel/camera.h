// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::kernel {

/// A thin-lens camera in the kernel's representation. The ray through the film point p = x right + y down, with (x, y)
/// in pixels from the film's centre and y down, and the lens point l = u lens_u + v lens_v, with (u, v) on the unit
/// disc, starts at origin + l and points to origin + forward + p. With an orthographic camera, it starts at origin + p
/// + l and points to origin + p + forward.
///
/// Space      world; `forward` extends to the focus plane, so all rays of a film point intersect there
struct Camera {
  double origin[3] = {0, 0, 0};
  double forward[3] = {0, 0, -1};  ///< vector to the centre of the focus plane
  double right[3] = {1, 0, 0};     ///< one pixel to the right on the focus plane
  double down[3] = {0, -1, 0};     ///< one pixel down on the focus plane
  double lens_u[3] = {0, 0, 0};    ///< lens radius along right; zero for a pinhole
  double lens_v[3] = {0, 0, 0};    ///< lens radius along up
  double half_width = 0;           ///< px, from the left edge of the rendered window to the centre of the frame
  double half_height = 0;          ///< px, from the upper edge of the rendered window to the centre of the frame
  bool is_orthographic = false;
};

}  // namespace orrery::kernel
