// SPDX-License-Identifier: Apache-2.0
#include "kernel/render_tile.h"

#include <gtest/gtest.h>

#include "kernel/scene_view.h"

namespace orrery::kernel {
namespace {

TEST(KernelRenderTile, EachPrecisionHasItsLoops) {
  const RenderTile exact = render_tile_function({}, Precision::kExact, false);
  const RenderTile fast = render_tile_function({}, Precision::kFast, false);
  const RenderTile book = render_tile_function({}, Precision::kBook, false);
  EXPECT_NE(exact, nullptr);
  EXPECT_NE(exact, fast);
  EXPECT_NE(exact, book);
  EXPECT_NE(fast, book);
}

TEST(KernelRenderTile, PlainScenesHaveALoopOfTheirOwn) {
  for (const Precision precision : {Precision::kExact, Precision::kFast}) {
    const RenderTile plain = render_tile_function({}, precision, false);
    const RenderTile full = render_tile_function({}, precision, true);
    EXPECT_NE(plain, full) << "records";
    for (bool Features::*const feature : {&Features::motion, &Features::lit, &Features::rich_materials, &Features::rods,
                                          &Features::opacity, &Features::depth_cue, &Features::tilted}) {
      Features features;
      features.*feature = true;
      EXPECT_EQ(render_tile_function(features, precision, false), full);
    }
  }
}

}  // namespace
}  // namespace orrery::kernel
