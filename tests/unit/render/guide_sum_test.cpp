// SPDX-License-Identifier: Apache-2.0
#include "kernel/pixel_sum.h"

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
#include "kernel/render_tile.h"
#include "support/everything.h"

namespace orrery::render {
namespace {

using kernel::GuideSum;
using kernel::PixelSum;

struct Sums {
  std::vector<PixelSum> light;
  std::vector<GuideSum> guides;
};

/// Renders samples of the whole image as tiles of `step` samples, with guides and without records; also those of the
/// second half, whose sums follow those of the first.
Sums rendered(const compile::CompiledScene& compiled, std::uint32_t step, bool halves_together = true) {
  const auto accel = accel::make_embree(compiled.view(), compiled.precision);
  const kernel::SceneView view = compiled.view();
  const auto pixels = static_cast<std::size_t>(compiled.width * compiled.height);
  Sums out{std::vector<PixelSum>(2 * pixels), std::vector<GuideSum>(2 * pixels)};
  kernel::Tile tile;
  tile.width = compiled.width;
  tile.height = compiled.height;
  tile.row_stride = compiled.width;
  tile.half_stride = static_cast<std::int64_t>(pixels);
  tile.has_both_halves = halves_together;
  const auto memory = std::make_unique<kernel::PathStream>();
  for (const std::size_t half : {0U, 1U}) {
    if (halves_together && half == 1) break;
    tile.sums = &out.light[half * pixels];
    tile.guides = &out.guides[half * pixels];
    for (std::uint32_t begin = 0; begin < static_cast<std::uint32_t>(compiled.samples); begin += step) {
      tile.sample_begin = (half == 0 ? 0 : kernel::Sampler::kSecondHalf) + begin;
      tile.sample_end = tile.sample_begin + step;
      kernel::render_tile_function(view.features, compiled.precision, true)(view, accel->tracer(), tile, *memory);
    }
  }
  return out;
}

int differences(const Sums& a, const Sums& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.guides.size(); ++i) {
    const GuideSum &p = a.guides[i], &q = b.guides[i];
    bool same = p.weight == q.weight && p.inverse_depth == q.inverse_depth && a.light[i].rgb[0] == b.light[i].rgb[0];
    for (int k = 0; k < 3; ++k) same = same && p.albedo[k] == q.albedo[k] && p.normal[k] == q.normal[k];
    count += same ? 0 : 1;
  }
  return count;
}

/// With 16 samples at a time the paths of a vector belong to one pixel, with one sample to many.
TEST(RenderGuideSum, DoesNotDependOnWhichPathsAreTracedTogether) {
  const std::vector<std::string> isas = kernel::available_isas();
  for (const auto filter : {scene::Filter::kBox, scene::Filter::kGaussian}) {
    for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
      scene::Scene scene = test::everything();
      scene.render.samples = 16;
      scene.render.precision = precision;
      scene.render.filter = filter;
      const compile::CompiledScene compiled = compile::compile(scene);
      for (const std::string& isa : isas) {
        ASSERT_TRUE(kernel::limit_isa(isa));
        const Sums together = rendered(compiled, 16);
        EXPECT_EQ(differences(together, rendered(compiled, 1)), 0) << isa;
        EXPECT_EQ(differences(together, rendered(compiled, 4)), 0) << isa;
        EXPECT_EQ(differences(together, rendered(compiled, 16, false)), 0) << isa;
        std::int64_t lit = 0;
        for (const GuideSum& sum : together.guides) lit += sum.albedo[0] > 0 && sum.inverse_depth > 0 ? 1 : 0;
        EXPECT_GT(lit, 1000);
      }
      kernel::limit_isa("");
    }
  }
}

/// A grey sphere that fills the image.
TEST(RenderGuideSum, HoldsAlbedoNormalAndInverseDepth) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    for (const double distance : {1e-9, 1e-3, 2.0, 1e6}) {
      scene::Scene scene;
      scene.image = {4, 4};
      scene.camera.look_from = {0, 0, 2 * distance};
      scene.camera.look_at = {0, 0, 0};
      scene.camera.vfov = 1e-3;
      scene.render.samples = 16;
      scene.render.precision = precision;
      scene.materials = {{"grey", scene::Lambertian{{0.25, 0.5, 1}}}};
      scene.spheres = {{{0, 0, 0}, distance, 0, ""}};
      const Sums sums = rendered(compile::compile(scene), 16);
      for (const GuideSum& sum : sums.guides) {
        ASSERT_EQ(sum.weight, 16);
        EXPECT_EQ(sum.albedo[0], 16 * (std::int64_t{1} << 28));
        EXPECT_EQ(sum.albedo[1], 16 * (std::int64_t{1} << 29));
        EXPECT_EQ(sum.albedo[2], 16 * (std::int64_t{1} << 30));
        EXPECT_NEAR(static_cast<double>(sum.normal[2]) * kernel::kGuideUnit, 16, 1e-6);
        const double inverse = kernel::from_fixed_point(sum.inverse_depth) / 16,
                     want = std::min(1 / distance, kernel::kLargestInverseDepth);
        EXPECT_NEAR(inverse / want, 1, 1e-6) << distance;
      }
    }
  }
}

}  // namespace
}  // namespace orrery::render
