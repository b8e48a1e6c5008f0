// SPDX-License-Identifier: Apache-2.0
#include "film/partial.h"

namespace orrery::film {

RenderWork& RenderWork::operator+=(const RenderWork& other) {
  paths += other.paths;
  rays += other.rays;
  bad_samples += other.bad_samples;
  seconds += other.seconds;
  return *this;
}

}  // namespace orrery::film
