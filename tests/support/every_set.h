// SPDX-License-Identifier: Apache-2.0
// Included first, compiles what hwy/foreach_target.h includes for every instruction set, if the program has several.
#pragma once

#ifdef HWY_TARGETS
#error "include this before Highway"
#endif
#ifdef ORRERY_EVERY_SET
#undef HWY_COMPILE_ONLY_STATIC
#undef HWY_BASELINE_TARGETS
#endif
