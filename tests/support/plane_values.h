// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "film/picture.h"

namespace orrery::test {

/// The values of all planes of a picture, one plane after another.
inline std::vector<float> plane_values(const film::Picture& picture) {
  std::vector<float> all;
  for (const film::Plane& plane : picture.planes) all.insert(all.end(), plane.values.begin(), plane.values.end());
  return all;
}

}  // namespace orrery::test
