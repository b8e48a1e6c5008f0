// SPDX-License-Identifier: Apache-2.0
#include "study/study_renderer.h"

#include <gtest/gtest.h>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/result.h"
#include "study/study.h"
#include "support/lit_scenes.h"

namespace orrery::study {
namespace {

/// The spheres are lent only while an image is rendered.
TEST(StudyRenderer, LightsAreThoseOfThePrecisionAndTheSampling) {
  scene::Scene s = test::dark_stage(16, 9);
  s.render.direct_lighting = scene::DirectLighting::kBsdf;
  s.render.samples = 1;
  test::add_lamp(s, {0, 5, 0}, 1, {1, 1, 1});
  test::add_lamp(s, {0, 5 + 1e-12, 0}, 1, {1, 1, 1});
  compile::CompiledScene compiled = compile::compile(s);
  const Request request;
  StudyRenderer renderer(request, 1);
  renderer.take_spheres(compiled);
  const auto lights = [&] {
    renderer.render(compiled);
    return compiled.light_tree.spheres.size();
  };
  EXPECT_EQ(lights(), 0u);
  compiled.direct_lighting = kernel::DirectLighting::kMis;
  EXPECT_EQ(lights(), 2u);
  compiled.precision = compile::Precision::kFast;
  EXPECT_EQ(lights(), 1u);
}

}  // namespace
}  // namespace orrery::study
