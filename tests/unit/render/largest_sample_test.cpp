// SPDX-License-Identifier: Apache-2.0
// The largest samples of pixels, as the path loop finds them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "kernel/isa.h"
#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/render_tile.h"
#include "support/everything.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

constexpr std::uint32_t kPassSamples = 16;

/// Renders samples of the whole image; returns the largest samples, and the sums in `sums`.
std::vector<float> rendered(const compile::CompiledScene& compiled, std::uint32_t begin, std::uint32_t end,
                            std::vector<kernel::PixelSum>& sums) {
  const auto accel = accel::make_embree(compiled.view(), compiled.precision);
  const kernel::SceneView view = compiled.view();
  sums.assign(static_cast<std::size_t>(compiled.width * compiled.height), {});
  std::vector<float> largest(sums.size());
  kernel::Tile tile;
  tile.width = compiled.width;
  tile.height = compiled.height;
  tile.row_stride = compiled.width;
  tile.sums = sums.data();
  tile.largest = largest.data();
  tile.sample_begin = begin;
  tile.sample_end = end;
  kernel::render_tile_function(view.features, compiled.precision, false)(view, accel->tracer(), tile,
                                                                         *std::make_unique<kernel::PathStream>());
  return largest;
}

/// The largest absolute values of the sums of single samples.
std::vector<float> one_by_one(const compile::CompiledScene& compiled) {
  std::vector<float> out(static_cast<std::size_t>(compiled.width * compiled.height));
  std::vector<kernel::PixelSum> sums;
  for (std::uint32_t k = 0; k < kPassSamples; ++k) {
    rendered(compiled, k, k + 1, sums);
    for (std::size_t i = 0; i < out.size(); ++i) {
      double light = 0;
      for (const auto& channel : sums[i].rgb) light += kernel::from_fixed_point(channel);
      out[i] = std::max(out[i], static_cast<float>(std::abs(light)));
    }
  }
  return out;
}

/// The plain loop deposits paths as they end, the full loop all paths of a batch; some samples are above 4, where
/// vectors do not convert to fixed point.
TEST(RenderLargestSample, IsThatOfTheSamplesOneByOne) {
  scene::Scene lit = test::with_lamps(test::everything());
  for (scene::Scene scene : {test::everything(), lit}) {
    for (const auto filter : {scene::Filter::kBox, scene::Filter::kGaussian}) {
      for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
        scene.render.precision = precision;
        scene.render.filter = filter;
        const compile::CompiledScene compiled = compile::compile(scene);
        for (const std::string& isa : kernel::available_isas()) {
          ASSERT_TRUE(kernel::limit_isa(isa));
          const std::vector<float> expected = one_by_one(compiled);
          ASSERT_GT(*std::max_element(expected.begin(), expected.end()), 0);
          std::vector<kernel::PixelSum> sums;
          const std::vector<float> largest = rendered(compiled, 0, kPassSamples, sums);
          for (std::size_t i = 0; i < largest.size(); ++i)
            ASSERT_NEAR(largest[i], expected[i], 1e-6f * (1 + expected[i])) << isa << ", pixel " << i;
        }
        kernel::limit_isa("");
      }
    }
  }
}

TEST(RenderLargestSample, BadSamplesDoNotCount) {
  scene::Scene scene = test::dark_stage(24, 14);
  test::add_lamp(scene, {0, 1, 2}, 0.3, {0x1p34, 0x1p34, 0x1p34});
  compile::CompiledScene compiled = compile::compile(scene);
  std::vector<kernel::PixelSum> sums;
  const std::vector<float> valid = rendered(compiled, 0, kPassSamples, sums);
  EXPECT_GT(*std::max_element(valid.begin(), valid.end()), 0x1p35f);  // the sum of the channels
  for (auto& emission : compiled.emission)
    for (double& channel : emission.radiance) channel *= 4;
  const std::vector<float> largest = rendered(compiled, 0, kPassSamples, sums);
  EXPECT_LT(*std::max_element(largest.begin(), largest.end()), 3 * 0x1p35f);
}

}  // namespace
}  // namespace orrery::render
