// SPDX-License-Identifier: Apache-2.0
#include "study/axes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "scene/scene.h"
#include "support/everything.h"
#include "support/lit_scenes.h"

namespace orrery::study {
namespace {

bool has_axis(const AxisPlan& plan, const std::string& axis) {
  return std::any_of(plan.choices.begin(), plan.choices.end(), [&](const Choice& c) { return c.axis == axis; });
}

AxisPlan plan_of(const scene::Scene& s) { return plan_axes(s, compile::compile(s), 0.01); }

TEST(StudyAxes, OnlyAxesThatAffectTheSceneArePlanned) {
  const AxisPlan all = plan_of(test::everything());
  for (const char* axis :
       {"samples", "noise", "precision", "sampler", "denoise", "roulette", "depth", "fresnel", "accelerator"})
    EXPECT_TRUE(has_axis(all, axis)) << axis;
  scene::Scene plain;
  plain.materials = {{"white", scene::Lambertian{{1, 1, 1}}}};
  plain.spheres = {{{0, 0, -2}, 1, 0, ""}};
  const AxisPlan few = plan_of(plain);
  EXPECT_FALSE(has_axis(few, "fresnel"));
  EXPECT_FALSE(has_axis(few, "roulette"));
  EXPECT_NE(std::find(few.left_out.begin(), few.left_out.end(), "no glass: no Fresnel axis"), few.left_out.end());
  plain.spheres = {};
  EXPECT_FALSE(has_axis(plan_of(plain), "depth"));
}

/// A choice of direct lighting renders as the scene does with that setting, whichever setting the scene has itself. The
/// study has lent its spheres when it applies a choice; with them, the renderer updates the light tree.
TEST(StudyAxes, DirectLightingIsThatOfAScenesOwnMode) {
  scene::Scene s = test::lit_scenes(16, 9).back().scene;
  ASSERT_NE(s.background.image, nullptr);
  ASSERT_EQ(s.spheres.size(), 3U);
  using scene::DirectLighting;
  for (const DirectLighting own : {DirectLighting::kMis, DirectLighting::kBsdf, DirectLighting::kLight}) {
    s.render.direct_lighting = own;
    const compile::CompiledScene whole = compile::compile(s);
    compile::CompiledScene compiled = whole;
    const AxisPlan plan = plan_axes(s, compiled, 0.01);
    compiled.spheres = {};
    compiled.object_materials = {};
    for (const auto& [name, mode] :
         {std::pair{"mis", DirectLighting::kMis}, std::pair{"bsdf", DirectLighting::kBsdf}}) {
      const auto choice = std::find_if(plan.choices.begin(), plan.choices.end(),
                                       [&](const Choice& c) { return c.axis == "direct lighting" && c.name == name; });
      ASSERT_NE(choice, plan.choices.end());
      compile::CompiledScene changed = compiled;
      choice->apply(changed);
      changed.spheres = whole.spheres;
      changed.object_materials = whole.object_materials;
      compile::update_lights(changed);
      s.render.direct_lighting = mode;
      const compile::CompiledScene expected = compile::compile(s);
      EXPECT_EQ(changed.direct_lighting, expected.direct_lighting);
      EXPECT_EQ(changed.light_tree.spheres, expected.light_tree.spheres) << name;
      const kernel::Environment &a = changed.environment->view(), &b = expected.environment->view();
      EXPECT_EQ(a.is_sampled, b.is_sampled) << name;
      EXPECT_EQ(a.map_density, b.map_density) << name;
      EXPECT_EQ(a.weight_offset, b.weight_offset) << name;
      EXPECT_EQ(a.sun_probability, b.sun_probability) << name;
    }
  }
}

/// Pixels of blue noise share random numbers, which the test for bias must not assume.
TEST(StudyAxes, ShortcutsDoNotTakeBlueNoise) {
  scene::Scene s = test::everything();
  s.render.sampler = scene::Sampler::kBlueNoise;
  compile::CompiledScene compiled = compile::compile(s);
  for (const Choice& choice : plan_axes(s, compiled, 0.01).choices) {
    if (!choice.is_shortcut) continue;
    compile::CompiledScene changed = compiled;
    choice.apply(changed);
    EXPECT_EQ(changed.sampler.kind, kernel::SamplerKind::kSobol) << choice.name;
    EXPECT_NE(choice.flags.find("render.sampler=sobol"), std::string::npos) << choice.flags;
  }
}

}  // namespace
}  // namespace orrery::study
