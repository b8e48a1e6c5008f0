// SPDX-License-Identifier: Apache-2.0
#include "denoise/tile_filter.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/tile_filter.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "denoise/tile_filter-inl.h"
#include "math/dispatch.h"

#if HWY_ONCE
namespace orrery::denoise {

HWY_EXPORT(compute_tile_weights);
HWY_EXPORT(apply_tile_weights);

void compute_weights(const WeightSource& source, int x, int y, TileScratch& scratch, TileWeights& out) {
  ORRERY_BEST(compute_tile_weights)(source, x, y, scratch, out);
}

void apply_weights(const TileWeights& weights, int radius, const PaddedPlane& plane, int x, int y, TilePixels& out) {
  ORRERY_BEST(apply_tile_weights)(weights, radius, plane, x, y, out);
}

}  // namespace orrery::denoise
#endif
