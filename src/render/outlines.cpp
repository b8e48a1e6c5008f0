// SPDX-License-Identifier: Apache-2.0
#include "render/outlines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "compile/compiled_scene.h"
#include "film/layers.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"
#include "math/pixels.h"
#include "math/vec3.h"
#include "render/empty_pixels.h"
#include "render/film_ray.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

/// Rays along each side of a pixel; even.
constexpr int kRays = 4;
/// Side of a tile, px, and of the squares in which its rays are traced, rays: a packet has every second one.
constexpr int kTileSide = 64, kSquare = 8;
/// Depth of an edge, in radii of the object in front, in general and within a group, and in pixels.
constexpr double kEdgeRadii = 0.25, kInnerEdgeRadii = 2, kEdgePixels = 3;
/// Objects with a greater opacity hide the outlines behind them.
constexpr float kSolid = 0.4999f;
/// Of a line of full strength.
constexpr int kFullInk = 255;
/// Width and strength of the lines within a group, and the jump from which they are like those between groups, in
/// OutlineStyle::depth.
constexpr double kFineWidth = 0.5, kFineStrength = 0.6, kFarBehind = 4;

/// What a ray sees.
struct Seen {
  std::uint64_t id = kernel::kNone;
  double depth = std::numeric_limits<double>::infinity();  ///< along the ray, scene units
  double visible = 1;                                      ///< what a depth cue leaves
};

/// An edge between neighbouring rays.
struct Edge {
  double strength = 0;  ///< 0: there is none
  double reach = 0;     ///< half of its line's width, rays
};

/// A tile with its border, as rays.
struct Grid {
  int x, y, width, height;  ///< rays; the first is at the upper left
  std::vector<Seen> seen;
  std::vector<int> mixed;  ///< first rays of the squares of 2 x 2 rays at which there may be edges

  const Seen& at(int column, int row) const { return seen[math::pixel_index(column, row, width)]; }
};

double radius_of(const kernel::SceneView& scene, std::uint64_t id) {
  if (id < scene.sphere_count) return scene.spheres[id].radius;
  return scene.rods[(id - scene.sphere_count) / 2].radius;  // a rod has two ids
}

/// Traces rays of a grid.
///
/// `threshold` of the rays
/// `rays`      their indices
template <class T>
void trace_rays(const compile::CompiledScene& scene, const accel::Accel& accel, float threshold,
                const std::vector<int>& rays, Grid& grid) {
  const kernel::Camera& camera = scene.camera;
  const math::Vec3d forward = normalized(camera.forward);
  const kernel::Tracer tracer = accel.tracer();
  kernel::RayPacket<T> packet{};
  for (std::size_t begin = 0; begin < rays.size(); begin += kernel::kPacketSize) {
    packet.count = static_cast<int>(std::min<std::size_t>(kernel::kPacketSize, rays.size() - begin));
    const int* const of_lanes = &rays[begin];
    kernel::reset_hits(packet);
    for (int lane = 0; lane < packet.count; ++lane) {
      const int column = of_lanes[lane] % grid.width, row = of_lanes[lane] / grid.width;
      const double x = (grid.x + column + 0.5) / kRays, y = (grid.y + row + 0.5) / kRays;
      set_film_ray(camera, x, y, packet, lane);
      packet.threshold[lane] = threshold;
    }
    kernel::trace(tracer, packet);
    for (int lane = 0; lane < packet.count; ++lane)
      if (packet.hit[lane] != kernel::kNone) {
        const auto along = [&](int axis) { return static_cast<double>(packet.direction[axis][lane]); };
        const auto depth = static_cast<double>(packet.distance[lane]);
        const double cosine = dot({along(0), along(1), along(2)}, forward);
        grid.seen[static_cast<std::size_t>(of_lanes[lane])] = {packet.hit[lane], depth,
                                                               1 - scene.depth_cue.share(depth * cosine)};
      }
  }
}

/// Traces every second ray of a grid along each side, then those between rays that see different objects. The others
/// see what the ray beside them sees.
///
/// `threshold` of the rays
/// `empty`     see find_empty_pixels()
template <class T>
void trace_grid(const compile::CompiledScene& scene, const accel::Accel& accel, float threshold,
                const std::vector<bool>& empty, Grid& grid) {
  const auto each_second = [&grid](const auto& f) {  // in squares, so that the rays of a packet are close
    for (int top = 0; top < grid.height; top += kSquare)
      for (int left = 0; left < grid.width; left += kSquare)
        for (int row = top; row < std::min(top + kSquare, grid.height); row += 2)
          for (int column = left; column < std::min(left + kSquare, grid.width); column += 2) f(column, row);
  };
  const auto may_hit = [&](int column, int row) {
    const int x = grid.x / kRays + column / kRays, y = grid.y / kRays + row / kRays;
    const bool is_known = !empty.empty() && x >= 0 && y >= 0 && x < scene.width && y < scene.height;
    return !is_known || !empty[math::pixel_index(x, y, scene.width)];
  };
  std::vector<int> rays;
  each_second([&](int column, int row) {
    if (may_hit(column, row)) rays.push_back(row * grid.width + column);
  });
  if (rays.empty()) return;
  grid.seen.resize(math::pixel_count(grid.width, grid.height));
  trace_rays<T>(scene, accel, threshold, rays, grid);
  rays.clear();
  each_second([&](int column, int row) {
    const int right = std::min(column + 2, grid.width - 2), below = std::min(row + 2, grid.height - 2);
    const Seen seen = grid.at(column, row);
    const bool is_uniform = grid.at(right, row).id == seen.id && grid.at(column, below).id == seen.id &&
                            grid.at(right, below).id == seen.id;
    const int first = row * grid.width + column;
    if (!is_uniform) grid.mixed.push_back(first);
    for (const int ray : {first + 1, first + grid.width, first + grid.width + 1})
      if (is_uniform)
        grid.seen[static_cast<std::size_t>(ray)] = seen;
      else
        rays.push_back(ray);
  });
  trace_rays<T>(scene, accel, threshold, rays, grid);
}

class TileOutlines {
 public:
  /// `threshold` objects with a greater opacity are there
  /// `empty`     see find_empty_pixels()
  TileOutlines(const compile::CompiledScene& scene, const accel::Accel& accel, float threshold,
               const OutlineStyle& style, const std::vector<bool>& empty)
      : scene_(scene),
        view_(scene.view()),
        accel_(accel),
        threshold_(threshold),
        style_(style),
        empty_(empty),
        reach_(style.width_px / 2 * kRays),
        border_(static_cast<int>(std::ceil(style.width_px / 2)) + 1),
        pixel_(length(scene.camera.right)) {}

  /// Draws the outlines over those that `coverage` has.
  void draw(int left, int top, int right, int bottom, std::vector<float>& coverage) const {
    Grid grid{(left - border_) * kRays,
              (top - border_) * kRays,
              (right - left + 2 * border_) * kRays,
              (bottom - top + 2 * border_) * kRays,
              {},
              {}};
    if (scene_.precision == kernel::Precision::kFast)
      trace_grid<float>(scene_, accel_, threshold_, empty_, grid);
    else
      trace_grid<double>(scene_, accel_, threshold_, empty_, grid);
    if (grid.mixed.empty()) return;
    std::vector<std::uint8_t> inked(grid.seen.size());
    for (const int first : grid.mixed)
      for (int row = std::max(first / grid.width - 1, 0); row <= first / grid.width + 1; ++row)
        for (int column = std::max(first % grid.width - 1, 0); column <= first % grid.width + 1; ++column) {
          if (column + 1 < grid.width)
            ink(grid, column + 0.5, row, edge(grid.at(column, row), grid.at(column + 1, row)), inked);
          if (row + 1 < grid.height)
            ink(grid, column, row + 0.5, edge(grid.at(column, row), grid.at(column, row + 1)), inked);
        }
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        float& pixel = coverage[math::pixel_index(x, y, scene_.width)];
        pixel = std::max(pixel, share(grid, x, y, inked));
      }
  }

 private:
  Edge edge(const Seen& a, const Seen& b) const {
    if (a.id == b.id) return {};
    const bool has_groups = style_.groups.size() > 0;
    const bool is_between = has_groups && group_of(a) != group_of(b);
    const Seen& front = a.depth <= b.depth ? a : b;
    const double jump = std::abs(a.depth - b.depth);
    // A pixel of a perspective image is as wide as the distance times its width at distance 1.
    const double pixel = scene_.camera.is_orthographic ? pixel_ : pixel_ * front.depth;
    const double radii = has_groups ? kInnerEdgeRadii : kEdgeRadii;
    const double least = style_.depth > 0 ? style_.depth : radii * radius_of(view_, front.id);
    if (!is_between && !(jump > std::max(least, kEdgePixels * pixel))) return {};
    const double strength = front.visible * (view_.opacity == nullptr ? 1 : double{view_.opacity[front.id]});
    if (!has_groups || is_between || jump > kFarBehind * least) return {strength, reach_};
    return {kFineStrength * strength, kFineWidth * reach_};
  }

  /// The group of what a ray sees; that of rays that see nothing is none of the others.
  std::uint32_t group_of(const Seen& seen) const {
    return seen.id == kernel::kNone ? kernel::kNone : style_.groups[seen.id];
  }

  /// Marks the rays within reach of an edge at a point between two rays.
  void ink(const Grid& grid, double column, double row, const Edge& edge, std::vector<std::uint8_t>& inked) const {
    const auto strength = static_cast<std::uint8_t>(std::lround(kFullInk * edge.strength));
    if (strength == 0) return;
    for (int y = std::max(0, static_cast<int>(std::ceil(row - edge.reach)));
         y <= std::min(grid.height - 1, static_cast<int>(std::floor(row + edge.reach))); ++y) {
      const double half = std::sqrt(edge.reach * edge.reach - (y - row) * (y - row));
      for (int x = std::max(0, static_cast<int>(std::ceil(column - half)));
           x <= std::min(grid.width - 1, static_cast<int>(std::floor(column + half))); ++x) {
        std::uint8_t& mark = inked[math::pixel_index(x, y, grid.width)];
        mark = std::max(mark, strength);
      }
    }
  }

  /// The mean of the marks of a pixel's rays.
  float share(const Grid& grid, int x, int y, const std::vector<std::uint8_t>& inked) const {
    int count = 0;
    for (int row = 0; row < kRays; ++row)
      for (int column = 0; column < kRays; ++column)
        count += inked[math::pixel_index(x * kRays - grid.x + column, y * kRays - grid.y + row, grid.width)];
    return static_cast<float>(count) / (kFullInk * kRays * kRays);
  }

  const compile::CompiledScene& scene_;
  kernel::SceneView view_;
  const accel::Accel& accel_;
  float threshold_;
  const OutlineStyle& style_;
  const std::vector<bool>& empty_;
  double reach_;  ///< half of the lines' full width, rays
  int border_;    ///< px around a tile
  double pixel_;  ///< width of a pixel, scene units; of a perspective image, at distance 1
};

}  // namespace

std::vector<float> outlines(const compile::CompiledScene& scene, const accel::Accel& accel, const OutlineStyle& style,
                            int threads) {
  std::vector<float> coverage(math::pixel_count(scene.width, scene.height));
  TilePool pool(threads);
  const std::vector<bool> empty = find_empty_pixels(scene, {}, pool);
  const int columns = (scene.width + kTileSide - 1) / kTileSide, rows = (scene.height + kTileSide - 1) / kTileSide;
  // Those of all objects, then those of the solid ones, which show through the others.
  for (const float threshold : {0.0f, kSolid}) {
    const TileOutlines tile_outlines(scene, accel, threshold, style, empty);
    const auto draw = [&](std::size_t tile, TileWorker&) {
      const int left = static_cast<int>(tile) % columns * kTileSide, top = static_cast<int>(tile) / columns * kTileSide;
      tile_outlines.draw(left, top, std::min(scene.width, left + kTileSide), std::min(scene.height, top + kTileSide),
                         coverage);
    };
    pool.run(static_cast<std::size_t>(rows * columns), draw);
    if (!scene.features.opacity) break;
  }
  return coverage;
}

}  // namespace orrery::render
