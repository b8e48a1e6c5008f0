// SPDX-License-Identifier: Apache-2.0
#include "film/partial.h"

namespace orrery::film {

Effort& Effort::operator+=(const Effort& other) {
  paths += other.paths;
  rays += other.rays;
  bad_samples += other.bad_samples;
  seconds += other.seconds;
  return *this;
}

}  // namespace orrery::film
