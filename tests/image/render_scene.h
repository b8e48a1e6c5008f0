// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/picture.h"
#include "load/read_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::test {

/// Renders a scene that has been read; fails if a sample is not finite.
inline film::Picture render_scene(const load::ReadResult& read) {
  render::Result result = render::render(compile::compile(read.scene, read.closing ? &*read.closing : nullptr), {});
  EXPECT_TRUE(result.completed);
  EXPECT_EQ(result.statistics.bad_samples, 0u);
  return std::move(result.picture);
}

}  // namespace orrery::test
