// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/number_array.h"

namespace orrery::points {

/// Returns the median distance of the points to their nearest neighbours at other positions: twice the radius at which
/// typical neighbours touch.
///
/// Domain     finite coordinates
/// Result     0 if all points coincide, or if there are none
/// Precision  exact for up to 100,000 points; of an even number the smaller of the two medians. Otherwise the median
///            over a fixed sample of 4,096 points, each with its true nearest neighbour among all points: with a
///            probability of 95 % a quantile between 0.484 and 0.516
/// Cost       on one core 0.6 s for ten million uniform points, 3 s where distances span many orders of magnitude;
///            memory 1 MB, or 300 bytes per point where it is exact
double median_neighbor_distance(const scene::PointArray& centers);

}  // namespace orrery::points
