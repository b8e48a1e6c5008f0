// SPDX-License-Identifier: Apache-2.0
#include "render/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "accel/accel.h"
#include "compile/compile.h"
#include "render/render.h"
#include "support/everything.h"

namespace orrery::render {
namespace {

std::vector<float> values(const film::Picture& picture) {
  std::vector<float> all;
  for (const film::Plane& plane : picture.planes) all.insert(all.end(), plane.values.begin(), plane.values.end());
  return all;
}

/// A picture cut into squares of `side` pixels and its samples into `shards` ranges, the last piece first.
std::vector<float> rendered_in_pieces(const compile::World& world, int side, int shards, kernel::Lanes lanes) {
  const std::unique_ptr<accel::Accel> accel = accel::make_embree(world.view(), world.precision);
  film::Film film(world.width, world.height);
  std::vector<kernel::Tile> pieces;
  for (int shard = 0; shard < shards; ++shard)
    for (int y = 0; y < world.height; y += side)
      for (int x = 0; x < world.width; x += side) {
        kernel::Tile piece;
        piece.x = x;
        piece.y = y;
        piece.width = std::min(side, world.width - x);
        piece.height = std::min(side, world.height - y);
        piece.sample_begin = static_cast<std::uint32_t>(world.samples * shard / shards);
        piece.sample_end = static_cast<std::uint32_t>(world.samples * (shard + 1) / shards);
        piece.sums = film.at(x, y);
        piece.row_stride = world.width;
        pieces.push_back(piece);
      }
  std::reverse(pieces.begin(), pieces.end());
  const auto stream = std::make_unique<kernel::PathStream>();
  const kernel::RenderTile render_tile = kernel::render_tile_function(world.precision, lanes);
  for (const kernel::Tile& piece : pieces) render_tile(world.view(), accel->tracer(), piece, *stream);
  return values(film.picture());
}

compile::World world_of_everything() {
  scene::Scene scene = test::everything();
  scene.render.samples = 19;  // 17 shards that are not all alike
  return compile::compile(scene);
}

TEST(RenderTiles, CoverEachPixelOnceWithAllItsSamples) {
  for (const int samples : {1, 500, 100000}) {
    film::Film film(130, 67);
    std::vector<int> covered(130 * 67, 0);
    for (const kernel::Tile& tile : make_tiles(130, 67, samples, film)) {
      EXPECT_EQ(tile.sums, film.at(tile.x, tile.y));
      EXPECT_EQ(tile.row_stride, 130);
      EXPECT_EQ(tile.sample_begin, 0u);
      EXPECT_EQ(tile.sample_end, static_cast<std::uint32_t>(samples));
      for (int y = tile.y; y < tile.y + tile.height; ++y)
        for (int x = tile.x; x < tile.x + tile.width; ++x) ++covered[static_cast<std::size_t>(y * 130 + x)];
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), 130 * 67) << samples;
  }
}

TEST(RenderTiles, AnyCuttingGivesTheSameBits) {
  const compile::World world = world_of_everything();
  const std::vector<float> whole = values(render(world, {}).picture);
  for (const int side : {1, 5, 32, 128})
    for (const int shards : {1, 2, 3, 17})
      EXPECT_EQ(rendered_in_pieces(world, side, shards, kernel::Lanes::kAll), whole)
          << side << " pixels, " << shards << " shards";
}

TEST(RenderTiles, OneLaneGivesTheSameBitsAsAll) {
  const compile::World world = world_of_everything();
  EXPECT_EQ(rendered_in_pieces(world, 32, 1, kernel::Lanes::kOne), values(render(world, {}).picture));
}

}  // namespace
}  // namespace orrery::render
