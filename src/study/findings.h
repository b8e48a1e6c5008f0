// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "study/study.h"

namespace orrery::study {

/// How steeply the error of each sampler falls, by least squares on logarithmic axes, where it has two points or more.
std::vector<Slope> slopes_of(const std::vector<Point>& points);

/// Marks the points that nothing else is both quicker and better than. Accelerators, whose pictures are all the same,
/// stay out of it.
void mark_front(std::vector<Point>& points);

}  // namespace orrery::study
