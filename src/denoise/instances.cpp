// SPDX-License-Identifier: Apache-2.0
#include "denoise/tile_filter.h"
#include "math/dispatch.h"

namespace orrery::denoise {

ORRERY_DECLARE_INSTANCES(void compute_weights(const WeightSource& source, int x, int y, TileScratch& scratch,
                                              TileWeights& out);
                         void apply_weights(const TileWeights& weights, int radius, const PaddedPlane& plane, int x,
                                            int y, TilePixels& out);)

void compute_weights(const WeightSource& source, int x, int y, TileScratch& scratch, TileWeights& out) {
  ORRERY_BEST_INSTANCE(compute_weights)(source, x, y, scratch, out);
}

void apply_weights(const TileWeights& weights, int radius, const PaddedPlane& plane, int x, int y, TilePixels& out) {
  ORRERY_BEST_INSTANCE(apply_weights)(weights, radius, plane, x, y, out);
}

}  // namespace orrery::denoise
