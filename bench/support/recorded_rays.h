// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/accel.h"
#include "base/stopwatch.h"
#include "kernel/forward.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"

namespace orrery::bench {

/// The packets of a render in tracing order: representative rays for measuring traversal. `hit` and `distance` are the
/// results.
template <class T>
struct RecordedRays {
  std::vector<kernel::RayPacket<T>> camera;
  std::vector<kernel::RayPacket<T>> secondary;  ///< from the first bounce to the last
  std::uint64_t paths = 0;
};

/// Renders tiles of an image on one thread and keeps every packet; the tiles' sums remain unchanged. T is the number
/// type of the precision.
///
/// Domain     `accel` was built for the view, in the precision
/// Cost       about 2 KB per 16 rays, 1 KB in `fast`
template <class T>
RecordedRays<T> record_rays(const kernel::SceneView& view, const accel::Accel& accel, kernel::Precision precision,
                            const std::vector<kernel::Tile>& tiles);

/// Traces the packets again, without shading, and measures the time.
///
/// Result     seconds
template <class T>
double trace_again(const kernel::Tracer& tracer, std::vector<kernel::RayPacket<T>>& packets) {
  const base::Stopwatch watch;
  constexpr std::size_t kMost = kernel::kPacketsInFlight;
  for (std::size_t i = 0; i < packets.size(); i += kMost) {
    const std::size_t count = std::min(kMost, packets.size() - i);
    for (std::size_t k = i; k < i + count; ++k) kernel::reset_hits(packets[k]);
    kernel::trace(tracer, &packets[i], static_cast<int>(count));
  }
  return watch.seconds();
}

}  // namespace orrery::bench
