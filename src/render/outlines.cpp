// SPDX-License-Identifier: Apache-2.0
#include "render/outlines.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "compile/compiled_scene.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"
#include "render/film_ray.h"

namespace orrery::render {
namespace {

/// Rays along each side of a pixel.
constexpr int kRays = 4;
/// Side of a tile, px.
constexpr int kTileSide = 64;
/// Depth of an edge, in radii of the object in front, and in pixels.
constexpr double kEdgeRadii = 0.25, kEdgePixels = 3;

/// What a ray sees.
struct Seen {
  std::uint64_t id = kernel::kNoSphere;
  double depth = std::numeric_limits<double>::infinity();  ///< along the ray, scene units
};

/// A tile with its border, as rays.
struct Grid {
  int x, y, width, height;  ///< rays; the first is at the upper left
  std::vector<Seen> seen;

  const Seen& at(int column, int row) const {
    return seen[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  }
};

double radius_of(const kernel::SceneView& scene, std::uint64_t id) {
  if (id < scene.sphere_count) return scene.spheres[id].radius;
  return scene.rods[(id - scene.sphere_count) / 2].radius;  // a rod has two ids
}

/// Traces the rays of a grid.
template <class T>
void trace_grid(const compile::CompiledScene& scene, const accel::Accel& accel, Grid& grid) {
  const kernel::Camera& camera = scene.camera;
  const kernel::Tracer tracer = accel.tracer();
  const int count = grid.width * grid.height;
  grid.seen.resize(static_cast<std::size_t>(count));
  kernel::RayPacket<T> packet{};
  for (int begin = 0; begin < count; begin += kernel::kPacketSize) {
    packet.count = std::min(kernel::kPacketSize, count - begin);
    kernel::reset_hits(packet);
    for (int lane = 0; lane < packet.count; ++lane) {
      const int column = (begin + lane) % grid.width, row = (begin + lane) / grid.width;
      const double x = (grid.x + column + 0.5) / kRays, y = (grid.y + row + 0.5) / kRays;
      // One key for all: which translucent objects are visible does not change from ray to ray.
      set_film_ray(camera, x, y, packet, lane);
    }
    kernel::trace(tracer, packet);
    for (int lane = 0; lane < packet.count; ++lane)
      if (packet.hit[lane] != kernel::kNoSphere)
        grid.seen[static_cast<std::size_t>(begin + lane)] = {packet.hit[lane],
                                                             static_cast<double>(packet.distance[lane])};
  }
}

class TileOutlines {
 public:
  TileOutlines(const compile::CompiledScene& scene, const accel::Accel& accel, double width_px)
      : scene_(scene),
        view_(scene.view()),
        accel_(accel),
        reach_(width_px / 2 * kRays),
        border_(static_cast<int>(std::ceil(width_px / 2)) + 1) {
    for (int axis = 0; axis < 3; ++axis) pixel_ += scene.camera.right[axis] * scene.camera.right[axis];
    pixel_ = std::sqrt(pixel_);
  }

  void draw(int left, int top, int right, int bottom, std::vector<float>& coverage) const {
    Grid grid{(left - border_) * kRays,
              (top - border_) * kRays,
              (right - left + 2 * border_) * kRays,
              (bottom - top + 2 * border_) * kRays,
              {}};
    if (scene_.precision == kernel::Precision::kFast)
      trace_grid<float>(scene_, accel_, grid);
    else
      trace_grid<double>(scene_, accel_, grid);
    std::vector<std::uint8_t> inked(grid.seen.size());
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        if (column + 1 < grid.width && is_edge(grid.at(column, row), grid.at(column + 1, row)))
          ink(grid, column + 0.5, row, inked);
        if (row + 1 < grid.height && is_edge(grid.at(column, row), grid.at(column, row + 1)))
          ink(grid, column, row + 0.5, inked);
      }
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) coverage[index(x, y, scene_.width)] = share(grid, x, y, inked);
  }

 private:
  static std::size_t index(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }

  bool is_edge(const Seen& a, const Seen& b) const {
    if (a.id == b.id) return false;
    const Seen& front = a.depth <= b.depth ? a : b;
    const double jump = std::abs(a.depth - b.depth);
    // A pixel of a perspective image is as wide as the distance times its width at distance 1.
    const double pixel = scene_.camera.is_orthographic ? pixel_ : pixel_ * front.depth;
    return jump > std::max(kEdgeRadii * radius_of(view_, front.id), kEdgePixels * pixel);
  }

  /// Marks the rays within reach of a point between two rays.
  void ink(const Grid& grid, double column, double row, std::vector<std::uint8_t>& inked) const {
    for (int y = std::max(0, static_cast<int>(std::ceil(row - reach_)));
         y <= std::min(grid.height - 1, static_cast<int>(std::floor(row + reach_))); ++y) {
      const double half = std::sqrt(reach_ * reach_ - (y - row) * (y - row));
      for (int x = std::max(0, static_cast<int>(std::ceil(column - half)));
           x <= std::min(grid.width - 1, static_cast<int>(std::floor(column + half))); ++x)
        inked[index(x, y, grid.width)] = 1;
    }
  }

  /// The part of a pixel's rays that are marked.
  float share(const Grid& grid, int x, int y, const std::vector<std::uint8_t>& inked) const {
    int count = 0;
    for (int row = 0; row < kRays; ++row)
      for (int column = 0; column < kRays; ++column)
        count += inked[index(x * kRays - grid.x + column, y * kRays - grid.y + row, grid.width)];
    return static_cast<float>(count) / (kRays * kRays);
  }

  const compile::CompiledScene& scene_;
  kernel::SceneView view_;
  const accel::Accel& accel_;
  double reach_;      ///< half of the lines' width, rays
  int border_;        ///< px around a tile
  double pixel_ = 0;  ///< width of a pixel, scene units; of a perspective image, at distance 1
};

}  // namespace

std::vector<float> outlines(const compile::CompiledScene& scene, const accel::Accel& accel, double width_px,
                            int threads) {
  std::vector<float> coverage(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height));
  const TileOutlines tile_outlines(scene, accel, width_px);
  const int columns = (scene.width + kTileSide - 1) / kTileSide, rows = (scene.height + kTileSide - 1) / kTileSide;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(0, rows * columns, [&](int tile) {
      const int left = tile % columns * kTileSide, top = tile / columns * kTileSide;
      tile_outlines.draw(left, top, std::min(scene.width, left + kTileSide), std::min(scene.height, top + kTileSide),
                         coverage);
    });
  });
  return coverage;
}

}  // namespace orrery::render
