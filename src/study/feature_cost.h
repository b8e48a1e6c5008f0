// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace orrery::study {

struct BenchRequest;

/// The cost of an optional kernel feature.
struct FeatureCost {
  std::string name;       ///< "thin lens"
  bool required = false;  ///< the scene needs it
  double saves = 0;       ///< if not required: fraction of the time with the feature that omitting it saves, median
};

/// Measures the cost of each kernel feature that the scene lacks, in embree exact at a reduced size.
///
/// Result     all features; those that the scene requires are not measured
/// Errors     those of bench_scene
std::vector<FeatureCost> bench_features(const BenchRequest& request);

}  // namespace orrery::study
