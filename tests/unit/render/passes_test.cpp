// SPDX-License-Identifier: Apache-2.0
#include "render/passes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "accel/accel.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/layers.h"
#include "film/sums.h"
#include "kernel/path_stream.h"
#include "math/pixels.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/add_matte.h"
#include "support/everything.h"
#include "support/picture_of.h"
#include "support/plane_values.h"
#include "support/tile_functions.h"

namespace orrery::render {
namespace {

/// Renders an image in squares of `side` pixels and `shards` sample ranges, in reverse order.
std::vector<float> rendered_in_pieces(const compile::CompiledScene& compiled, int side, int shards,
                                      bool one_lane = false) {
  const std::unique_ptr<accel::Accel> accel = accel::make_embree(compiled.view(), compiled.precision);
  film::Sums film(compiled.width, compiled.height);
  std::vector<kernel::Tile> pieces;
  for (int shard = 0; shard < shards; ++shard)
    for (int y = 0; y < compiled.height; y += side)
      for (int x = 0; x < compiled.width; x += side) {
        kernel::Tile piece;
        piece.x = x;
        piece.y = y;
        piece.width = std::min(side, compiled.width - x);
        piece.height = std::min(side, compiled.height - y);
        piece.sample_begin = static_cast<std::uint32_t>(compiled.samples * shard / shards);
        piece.sample_end = static_cast<std::uint32_t>(compiled.samples * (shard + 1) / shards);
        piece.sums = &film.light[0][math::pixel_index(x, y, compiled.width)];
        piece.row_stride = compiled.width;
        pieces.push_back(piece);
      }
  std::reverse(pieces.begin(), pieces.end());
  const auto stream = std::make_unique<kernel::PathStream>();
  const kernel::SceneView view = compiled.view();
  const kernel::RenderTile render_tile = one_lane
                                             ? test::one_lane_tile_function()
                                             : kernel::render_tile_function(view.features, compiled.precision, false);
  for (const kernel::Tile& piece : pieces) render_tile(view, accel->tracer(), piece, *stream);
  return test::plane_values(test::picture_of(film));
}

compile::CompiledScene world_of_everything() {
  scene::Scene scene = test::everything();
  scene.render.samples = 19;  // 17 shards of different sizes
  return compile::compile(scene);
}

/// Requests layers that use every field of film::Sums.
Settings with_layers(Settings settings = {}) {
  film::LayerRequest& r = settings.layers;
  r.z = r.depth = r.normal = r.position = r.albedo = r.diffuse = r.specular = r.transmission = r.background = true;
  r.emission = r.light_groups = true;
  r.groups = {{"default", true, true}, {"other", true, false}};
  r.variance = r.samples = r.object_id = r.guide_albedo = r.guide_normal = r.halves = r.coverage = r.deep = true;
  test::add_matte_of_spheres(r, 1);
  return settings;
}

Settings in_rounds(Settings settings = {}) {
  settings.noise = 0.02;
  settings.unlimited = true;
  return settings;
}

void expect_same(const Result& a, const Result& b) {
  EXPECT_EQ(test::plane_values(a.picture), test::plane_values(b.picture));
  EXPECT_EQ(a.statistics.paths, b.statistics.paths);
  EXPECT_EQ(a.statistics.rays, b.statistics.rays);
  EXPECT_EQ(a.statistics.min_samples, b.statistics.min_samples);
  EXPECT_EQ(a.statistics.max_samples, b.statistics.max_samples);
  ASSERT_EQ(a.deep.pixels.size(), b.deep.pixels.size());
  for (std::size_t i = 0; i < a.deep.pixels.size(); ++i) {
    ASSERT_EQ(a.deep.pixels[i].size(), b.deep.pixels[i].size()) << i;
    for (std::size_t s = 0; s < a.deep.pixels[i].size(); ++s)
      ASSERT_EQ(std::memcmp(&a.deep.pixels[i][s], &b.deep.pixels[i][s], sizeof(film::DeepSample)), 0) << i;
  }
}

/// Renders with many interruptions; each start resumes from the serialized state of the last.
Result interrupted(const compile::CompiledScene& compiled, Settings settings, int* starts) {
  std::optional<film::Sums> from;
  std::minstd_rand random(7);
  for (;; ++*starts) {
    std::atomic<bool> cancel{false};
    std::atomic<int> tiles{static_cast<int>(random() % 3) + 2};
    settings.cancel = &cancel;
    settings.checkpoint_is_due = [&] {  // called before each tile
      if (--tiles == 0) cancel = true;
      return false;
    };
    settings.threads = 1 + static_cast<int>(random() % 3);
    Result result = render(compiled, settings, std::move(from));
    if (result.completed) return result;
    EXPECT_TRUE(result.sums);
    if (!result.sums) return result;
    from = film::from_words(film::to_words(*result.sums), compiled.width, compiled.height);
  }
}

/// Records the mean of each pixel when it is reported.
struct ReportedPixels {
  explicit ReportedPixels(const compile::CompiledScene& compiled)
      : width(compiled.width), rgb(3 * static_cast<std::size_t>(compiled.width * compiled.height)) {}

  void attach(Settings& settings) {
    settings.on_pixels = [this](const film::Sums& state, const film::RenderedPixels& rendered) {
      for (const kernel::PixelPlace p : rendered.pixels) {
        EXPECT_TRUE(p.x >= 0 && p.x < rendered.width && p.y >= 0 && p.y < rendered.height);
        const int x = rendered.x + p.x, y = rendered.y + p.y;
        const std::size_t i = math::pixel_index(x, y, width);
        state.mean(i, &rgb[3 * i]);
      }
    };
  }
  std::vector<float> of(const Result& result) const {
    std::vector<float> out;
    for (std::size_t i = 0; i < rgb.size(); ++i) out.push_back(result.picture.planes[i % 3].values[i / 3]);
    return out;
  }

  int width;
  std::vector<float> rgb;
};

TEST(RenderPasses, ReportedPixelsAreThoseOfTheImageInTheEnd) {
  const compile::CompiledScene compiled = world_of_everything();
  for (Settings settings : {Settings(), with_layers(), in_rounds()}) {
    settings.threads = 3;
    const Result plain = render(compiled, settings);
    ReportedPixels reported(compiled);
    reported.attach(settings);
    const Result result = render(compiled, settings);
    expect_same(plain, result);
    EXPECT_EQ(reported.rgb, reported.of(result));
  }
}

TEST(RenderPasses, AResumedRenderReportsTheEarlierPixels) {
  const compile::CompiledScene compiled = world_of_everything();
  Settings settings;
  Result finished = render(compiled, settings);  // nothing is left to render
  ReportedPixels reported(compiled);
  reported.attach(settings);
  const Result result = render(compiled, settings, std::move(finished.sums));
  EXPECT_EQ(reported.rgb, reported.of(result));
}

TEST(RenderPasses, ResumedRendersGiveTheSameBits) {
  scene::Scene scene = test::everything();
  scene.render.samples = 90;  // three passes
  const compile::CompiledScene compiled = compile::compile(scene);
  for (const Settings& settings : {Settings{}, with_layers(), in_rounds(), in_rounds(with_layers())}) {
    int starts = 0;
    expect_same(interrupted(compiled, settings, &starts), render(compiled, settings));
    EXPECT_GT(starts, 1);
  }
}

TEST(RenderPasses, CheckpointsAreCompleteAndChangeNoBits) {
  const compile::CompiledScene compiled = world_of_everything();
  for (const Settings& plain : {Settings{}, in_rounds()}) {
    Settings settings = plain;
    std::atomic<int> asked{0};  // called before every tile
    std::uint64_t last = 0;
    int checkpoints = 0;
    settings.checkpoint_is_due = [&] { return ++asked % 4 == 0; };
    settings.on_checkpoint = [&](const film::Sums& sums) {
      ++checkpoints;
      std::uint64_t paths = 0;
      for (const std::uint32_t n : sums.counts) paths += n * (sums.is_adaptive() ? 2u : 1u);
      EXPECT_EQ(sums.work.paths, paths);
      EXPECT_GE(paths, last);
      last = paths;
    };
    expect_same(render(compiled, settings), render(compiled, plain));
    EXPECT_GT(checkpoints, 1);
  }
}

TEST(RenderPixelShard, ShardsAddUpToTheImageAndItsLayers) {
  const compile::CompiledScene compiled = world_of_everything();
  const Settings whole = with_layers();
  for (const int count : {2, 5}) {
    film::Sums sum(compiled.width, compiled.height, whole.layers);
    for (int i = 0; i < count; ++i) {
      for (const std::uint32_t begin : {0u, 6u}) {
        Settings settings = with_layers();
        settings.shard = {i, count};
        settings.sample_begin = begin;
        settings.sample_end = begin == 0 ? 6 : 19;
        const Result part = render(compiled, settings);
        EXPECT_EQ(part.statistics.min_samples, settings.sample_end - begin);
        sum.add(*part.sums);
      }
    }
    const Result expected = render(compiled, whole);
    EXPECT_EQ(sum.work.rays, expected.statistics.rays);
    EXPECT_EQ(test::plane_values(finished(compiled, whole.layers, std::move(sum), 2).picture),
              test::plane_values(expected.picture));
  }
}

TEST(RenderPasses, AnySplitGivesTheSameBits) {
  const compile::CompiledScene compiled = world_of_everything();
  const std::vector<float> whole = test::plane_values(render(compiled, {}).picture);
  for (const int side : {1, 5, 32, 128})
    for (const int shards : {1, 2, 3, 17})
      EXPECT_EQ(rendered_in_pieces(compiled, side, shards), whole) << side << " pixels, " << shards << " shards";
}

TEST(RenderPasses, OneLaneGivesTheSameBitsAsAll) {
  const compile::CompiledScene compiled = world_of_everything();
  EXPECT_EQ(rendered_in_pieces(compiled, 32, 1, true), test::plane_values(render(compiled, {}).picture));
}

}  // namespace
}  // namespace orrery::render
