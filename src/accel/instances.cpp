// SPDX-License-Identifier: Apache-2.0
#include "accel/embree_scene.h"
#include "accel/list.h"
#include "math/dispatch.h"

namespace orrery::accel {

ORRERY_DECLARE_INSTANCES(EmbreeFunctions embree_functions(kernel::Precision precision);
                         kernel::Tracer list_tracer(kernel::Precision precision);)

EmbreeFunctions embree_functions(kernel::Precision precision) {
  return ORRERY_BEST_INSTANCE(embree_functions)(precision);
}

kernel::Tracer list_tracer(kernel::Precision precision) { return ORRERY_BEST_INSTANCE(list_tracer)(precision); }

}  // namespace orrery::accel
