// SPDX-License-Identifier: Apache-2.0
#include "render/empty_pixels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/stop_point.h"
#include "base/zero_pages.h"
#include "compile/compiled_scene.h"
#include "film/layers.h"
#include "kernel/scene_view.h"
#include "math/pixels.h"
#include "math/vec3.h"
#include "render/seen_emitters.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

using kernel::Sphere;
using math::Vec3d;

/// Bounds are enlarged by this, px, and radii by this fraction of the coordinates, for rounding in single precision.
constexpr double kSlack = 0.5, kRelativeSlack = 0x1p-20;

/// Objects in a unit of work.
constexpr std::size_t kBlock = 4096;

/// An interval of pixel coordinates.
struct Span {
  double low, high;
};

/// Counts the objects in whose bounds each pixel is. A rectangle is added as four corners, of which prefix sums make
/// the counts, so that large ones cost no more. Threads may add objects concurrently.
class Covered {
 public:
  /// Domain     the camera does not move
  Covered(const kernel::SceneView& scene, int width_px, int height_px)
      : camera_(scene.camera),
        width_(width_px),
        height_(height_px),
        margin_(kSlack + (scene.filter.places != nullptr ? scene.filter.places[kernel::PixelFilter::kSteps] - 0.5 : 0)),
        corners_(math::pixel_count(width_px + 1, height_px + 1)) {}

  /// Adds the convex hull of spheres.
  void add(std::span<const Sphere> hull) {
    bool is_behind = true;
    Span x{HUGE_VAL, -HUGE_VAL}, y = x;
    for (const Sphere& s : hull) {
      const Vec3d center{s.x, s.y, s.z}, to = center - camera_.origin;
      const double radius = s.radius + kRelativeSlack * (length(center) + origin_);
      const double z = dot(to, camera_.forward) / focus_;
      is_behind = is_behind && z + radius < 0;
      if (!camera_.is_orthographic && !(z - radius > 0)) {
        x = y = {-HUGE_VAL, HUGE_VAL};  // the camera may be inside
        continue;
      }
      include(x, to, z, radius, columns_);
      include(y, to, z, radius, rows_);
    }
    if (is_behind) return;
    const int left = first(x, width_), right = end(x, width_), top = first(y, height_), bottom = end(y, height_);
    if (left >= right || top >= bottom) return;
    is_full_ = is_full_ || (right - left == width_ && bottom - top == height_);
    corner(left, top) += 1;
    corner(right, top) -= 1;
    corner(left, bottom) -= 1;
    corner(right, bottom) += 1;
  }

  /// Whether an object covers the whole image.
  bool is_full() const { return is_full_; }

  /// The pixels in no bounds; empty if there are none.
  std::vector<bool> others() {
    std::vector<bool> out(math::pixel_count(width_, height_));
    std::vector<std::int32_t> above(static_cast<std::size_t>(width_));
    const base::StopPoint stop;
    for (int y = 0; y < height_; ++y) {
      stop.check();
      std::int32_t row = 0;
      for (int x = 0; x < width_; ++x) {
        row += corner(x, y);
        out[math::pixel_index(x, y, width_)] = (above[static_cast<std::size_t>(x)] += row) == 0;
      }
    }
    if (std::find(out.begin(), out.end(), true) == out.end()) out.clear();
    return out;
  }

 private:
  /// A direction in the image.
  struct Axis {
    Vec3d pixel;    ///< of one pixel on the focus plane
    double middle;  ///< coordinate of the view axis, px
    double width = length(pixel);
  };

  /// Adds the interval of a sphere.
  ///
  /// `to`, `z`  its centre relative to the camera, and its depth
  void include(Span& all, Vec3d to, double z, double radius, const Axis& axis) const {
    const double across = dot(to, axis.pixel) / axis.width;
    double low = across - radius, high = across + radius;
    if (!camera_.is_orthographic) {
      // The tangents through the centre of the lens. Its rim displaces them by a linear function of 1 / depth.
      const double squares = z * z - radius * radius;
      const double root = radius * std::sqrt(std::fmax(across * across + squares, 0));
      const double blur = lens_ * std::fmax(std::abs(1 - focus_ / (z - radius)), std::abs(1 - focus_ / (z + radius)));
      low = (across * z - root) * (focus_ / squares) - blur;
      high = (across * z + root) * (focus_ / squares) + blur;
    }
    all.low = std::fmin(all.low, low / axis.width + axis.middle - margin_);
    all.high = std::fmax(all.high, high / axis.width + axis.middle + margin_);
  }
  static int clamped(double at, int most) {
    return static_cast<int>(std::floor(std::clamp(at, 0.0, static_cast<double>(most))));
  }
  static int first(const Span& of, int most) { return clamped(of.low, most); }
  static int end(const Span& of, int most) { return clamped(of.high + 1, most); }
  std::atomic_ref<std::int32_t> corner(int x, int y) {
    return std::atomic_ref(corners_[math::pixel_index(x, y, width_ + 1)]);
  }

  const kernel::Camera& camera_;
  int width_, height_;  ///< px
  double margin_;       ///< px
  double focus_ = length(camera_.forward), lens_ = length(camera_.lens_u), origin_ = length(camera_.origin);
  Axis columns_{camera_.right, camera_.half_width}, rows_{camera_.down, camera_.half_height};
  base::ZeroVector<std::int32_t> corners_;
  std::atomic<bool> is_full_ = false;
};

}  // namespace

std::vector<bool> find_empty_pixels(const compile::CompiledScene& compiled, const film::LayerRequest& layers,
                                    TilePool& pool) {
  kernel::SceneView scene = compiled.view();
  if (layers.transparent) scene.background_visible = false;
  const bool is_plain =
      !scene.background_visible || scene.has_backdrop || (scene.environment == nullptr && !scene.features.gradient);
  const bool is_bounded = !scene.camera.is_orthographic || !scene.features.lens;
  if (layers.records() || !is_plain || !is_bounded || camera_moves(scene)) return {};
  Covered covered(scene, compiled.width, compiled.height);
  const auto add = [&](std::size_t i) {
    if (i < scene.sphere_count) {
      const Sphere hull[] = {sphere_at(scene, i, 0), sphere_at(scene, i, 1)};
      return covered.add({hull, i < scene.moving_count ? 2u : 1u});
    }
    Sphere hull[4];
    for (int time = 0; time < 2; ++time) {
      const kernel::Rod rod = scene.rods.at(i - scene.sphere_count, time);
      hull[2 * time] = {rod.a[0], rod.a[1], rod.a[2], rod.radius};
      hull[2 * time + 1] = {rod.b[0], rod.b[1], rod.b[2], rod.radius};
    }
    covered.add(hull);
  };
  const std::size_t count = scene.sphere_count + scene.rods.count;
  const auto add_block = [&](std::size_t block, TileWorker&) {
    for (std::size_t i = block * kBlock; i < std::min((block + 1) * kBlock, count); ++i) add(i);
  };
  pool.run((count + kBlock - 1) / kBlock, add_block, [&] { return covered.is_full(); });
  return covered.others();
}

}  // namespace orrery::render
