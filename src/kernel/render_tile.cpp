// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#include "kernel/scene_view.h"

namespace orrery::kernel {

RenderTile render_tile_function(const Features& features, Precision precision, bool records) {
  const bool full =
      records || features.motion || features.lit || features.rich_materials || features.rods || features.opacity;
  switch (precision) {
    case Precision::kExact: return exact_tile_function(full);
    case Precision::kFast: return fast_tile_function(full);
    case Precision::kBook: return book_tile_function();
  }
  return nullptr;
}

}  // namespace orrery::kernel
