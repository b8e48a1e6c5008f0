// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#include "kernel/scene_view.h"
#include "math/dispatch.h"

namespace orrery::kernel {

ORRERY_DECLARE_INSTANCES(RenderTile exact_tile(bool full); RenderTile fast_tile(bool full);
                         RenderTile book_tile(bool full);)

RenderTile render_tile_function(const Features& features, Precision precision, bool records) {
  const bool full = records || features.motion || features.lit || features.rich_materials || features.rods ||
                    features.opacity || features.depth_cue || features.tilted;
  switch (precision) {
    case Precision::kExact: return ORRERY_BEST_INSTANCE(exact_tile)(full);
    case Precision::kFast: return ORRERY_BEST_INSTANCE(fast_tile)(full);
    case Precision::kBook: return ORRERY_BEST_INSTANCE(book_tile)(full);
  }
  return nullptr;
}

}  // namespace orrery::kernel
