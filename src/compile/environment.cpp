// SPDX-License-Identifier: Apache-2.0
#include "compile/environment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "math/pixels.h"
#include "math/vec3.h"
#include "scene/lat_long_map.h"

namespace orrery::compile {
namespace {

using math::set;

using scene::LatLongMap;

/// Below this fraction of the map's power, sampling radiance above the mean does not help: the excess is mostly
/// rounding of texels to float.
constexpr double kMinExcess = 1e-6;

constexpr double kFullSphere = 4 * std::numbers::pi;

/// Rotates a vector about +y.
///
/// Precision  sine and cosine are rounded from long double, so that they do not depend on the math library
math::Vec3d rotated(math::Vec3d v, double turn) {
  const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(turn);
  const auto c = static_cast<double>(std::cos(angle)), s = static_cast<double>(std::sin(angle));
  return {v.x * c + v.z * s, v.y, v.z * c - v.x * s};
}

/// Returns the rows of cells between the poles: their edges are the centres of the texels' rows.
std::vector<kernel::EnvironmentRow> cell_rows(int height) {
  const int count = height + 1;
  const auto versine = [&](int edge) {  // 1 - cos of the angle to the first pole, up to a quarter of a turn
    if (edge == 0) return 0.0;
    const long double angle = std::numbers::pi_v<long double> * (static_cast<long double>(edge) - 0.5L) / height;
    const long double s = std::sin(angle / 2);
    return static_cast<double>(2 * s * s);
  };
  std::vector<kernel::EnvironmentRow> rows(static_cast<std::size_t>(count + count % 2));
  for (int j = 0; j < count; ++j) {
    // The lower half mirrors the upper one.
    const bool is_upper = 2 * j < count;
    const double begin = versine(is_upper ? j : count - j), end = versine(is_upper ? j + 1 : count - j - 1);
    rows[static_cast<std::size_t>(j)] = {begin, end - begin};
  }
  return rows;
}

/// The weights of a map's texels before the mean is subtracted, in total.
struct Totals {
  double brightest = 0;  ///< r + g + b
  double integral = 0;   ///< integral of r + g + b over all directions
};

double sum_of(const float* rgb) {
  return static_cast<double>(rgb[0]) + static_cast<double>(rgb[1]) + static_cast<double>(rgb[2]);
}

Totals totals_of(const LatLongMap& image, const std::vector<kernel::EnvironmentRow>& rows) {
  Totals out;
  const double cell_width = 2 * std::numbers::pi / image.width();
  for (int y = 0; y < image.height(); ++y) {
    const float* const row = image.row(y);
    double sum = 0;
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width()); ++x) {
      const double texel = sum_of(row + 3 * x);
      sum += texel;
      out.brightest = std::max(out.brightest, texel);
    }
    // A texel owns half of each adjacent cell row, and all of the cells at a pole.
    const auto at = static_cast<std::size_t>(y);
    const double above = std::abs(rows[at].width), below = std::abs(rows[at + 1].width);
    const double height = (y == 0 ? above : above / 2) + (y + 1 == image.height() ? below : below / 2);
    out.integral += sum * height * cell_width;
  }
  return out;
}

/// Builds the sums over two by two cells, four by four cells, and so on.
class SumPyramid {
 public:
  SumPyramid(const LatLongMap& image, kernel::Environment& view) : image_(image), view_(view) {}

  /// Result     the integral of the interpolated weight over all directions
  double build(std::vector<float>& sums) {
    struct Grid {
      std::size_t width, height;
      std::size_t blocks_wide() const { return (width + 1) / 2; }
      std::size_t blocks_high() const { return (height + 1) / 2; }
    };
    // From the finest level to the coarsest; each has a float per node, in blocks of four.
    std::vector<Grid> grids;
    for (Grid grid{(columns() + 1) / 2, (view_.height + 2) / 2}; grid.width > 1 || grid.height > 1;
         grid = {grid.blocks_wide(), grid.blocks_high()})
      grids.push_back(grid);
    std::size_t size = 0;
    std::vector<std::size_t> begins;
    for (const Grid& grid : grids) {
      begins.push_back(size);
      size += 4 * grid.blocks_wide() * grid.blocks_high();
    }
    sums.assign(size, 0.0F);
    const auto node = [&](std::size_t level, std::size_t x, std::size_t y) -> float& {
      return sums[begins[level] + 4 * ((y / 2) * grids[level].blocks_wide() + x / 2) + 2 * (y % 2) + x % 2];
    };
    double total = 0;
    std::vector<double> row((columns() + 1) / 2);
    for (std::size_t y = 0; y < (view_.height + 2) / 2; ++y) {
      std::fill(row.begin(), row.end(), 0.0);
      add_cells(2 * y, row);
      add_cells(2 * y + 1, row);
      for (std::size_t x = 0; x < row.size(); ++x) {
        total += row[x];
        if (!grids.empty()) node(0, x, y) = static_cast<float>(row[x]);
      }
    }
    for (std::size_t level = 1; level < grids.size(); ++level)
      for (std::size_t y = 0; y < grids[level].height; ++y)
        for (std::size_t x = 0; x < grids[level].width; ++x) {
          const float* const block = &node(level - 1, 2 * x, 2 * y);
          node(level, x, y) = static_cast<float>((static_cast<double>(block[0]) + static_cast<double>(block[1])) +
                                                 (static_cast<double>(block[2]) + static_cast<double>(block[3])));
        }
    view_.level_count = static_cast<std::uint32_t>(grids.size());
    for (std::size_t level = 0; level < grids.size(); ++level)
      view_.levels[grids.size() - 1 - level] = {sums.data() + begins[level],
                                                static_cast<std::uint32_t>(grids[level].blocks_wide())};
    return total * 2 * std::numbers::pi / static_cast<double>(columns()) / 4;
  }

 private:
  std::size_t columns() const { return view_.width; }

  double weight(int y, std::size_t x) const {
    const int inside = std::clamp(y, 0, image_.height() - 1);
    return std::max(sum_of(image_.row(inside) + 3 * x) * view_.weight_scale - view_.weight_offset, 0.0);
  }

  /// Adds a row of cells, four times their integral, to the sums over pairs of them.
  void add_cells(std::size_t row, std::vector<double>& sums) const {
    const double height = row <= view_.height ? std::abs(view_.rows[row].width) : 0;
    if (height == 0) return;
    const int below = static_cast<int>(row);
    const auto column = [&](std::size_t x) { return weight(below - 1, x) + weight(below, x); };
    const double first = column(0);
    double left = first;
    for (std::size_t x = 0; x < columns(); ++x) {
      const double right = x + 1 < columns() ? column(x + 1) : first;
      sums[x / 2] += (left + right) * height;
      left = right;
    }
  }

  const LatLongMap& image_;
  kernel::Environment& view_;
};

void set_sun(const scene::Sun& sun, const EnvironmentSettings& settings, kernel::Environment& view) {
  view.has_sun = sun.one_minus_cos > 0 && sun.radiance.x + sun.radiance.y + sun.radiance.z > 0;
  if (!view.has_sun) return;
  const math::Vec3d axis = math::normalized(rotated(sun.direction, view.turn));
  const math::Vec3d across = std::abs(axis.y) < 0.5 ? math::Vec3d{0, 1, 0} : math::Vec3d{1, 0, 0};
  const math::Vec3d tangent = math::normalized(math::cross(across, axis));
  view.sun = axis;
  view.sun_tangent = tangent;
  view.sun_bitangent = math::cross(axis, tangent);
  view.sun_one_minus_cos = sun.one_minus_cos;
  view.sun_radiance = sun.radiance * settings.scale;
}

}  // namespace

std::uint64_t environment_bytes(int width, int height, EnvironmentSampling sampling) {
  const std::uint64_t texels = math::pixel_count(width, height);
  // A quarter of a float per texel for the finest sums, a sixteenth for the next, and so on.
  return texels * 3 * sizeof(float) + (sampling == EnvironmentSampling::kNone ? 0 : texels * sizeof(float) / 3);
}

std::uint64_t EnvironmentMap::bytes() const noexcept {
  return environment_bytes(image_->width(), image_->height(), EnvironmentSampling::kNone) +
         sums_.size() * sizeof(float);
}

EnvironmentSampling environment_sampling(kernel::DirectLighting lighting) noexcept {
  switch (lighting) {
    case kernel::DirectLighting::kMis: return EnvironmentSampling::kCompensated;
    case kernel::DirectLighting::kBsdf: return EnvironmentSampling::kNone;
    case kernel::DirectLighting::kLight: return EnvironmentSampling::kComplete;
  }
  return EnvironmentSampling::kNone;
}

std::shared_ptr<const EnvironmentMap> EnvironmentMap::with_sampling(EnvironmentSampling sampling) const {
  EnvironmentSettings settings = settings_;
  settings.sampling = sampling;
  return std::make_shared<const EnvironmentMap>(image_, settings);
}

EnvironmentMap::EnvironmentMap(std::shared_ptr<const LatLongMap> image, const EnvironmentSettings& settings)
    : image_(std::move(image)), settings_(settings) {
  view_.texels = image_->row(0);
  view_.width = static_cast<std::uint32_t>(image_->width());
  view_.height = static_cast<std::uint32_t>(image_->height());
  view_.scale = settings.scale;
  view_.turn = settings.rotation / 360 - std::floor(settings.rotation / 360);
  view_.light_group = settings.light_group;
  view_.visible = settings.visible;
  set_sun(image_->sun, settings, view_);

  rows_ = cell_rows(image_->height());
  const Totals totals = totals_of(*image_, rows_);
  const double sun_solid_angle = 2 * std::numbers::pi * view_.sun_one_minus_cos;
  const double sun_power = sun_solid_angle * (view_.sun_radiance.x + view_.sun_radiance.y + view_.sun_radiance.z) / 3;
  view_.power = totals.integral * settings.scale / 3 + sun_power;
  if (settings.sampling == EnvironmentSampling::kNone) return;

  // A power of two, so that scaling is exact; the weights are at most 1.
  double map_power = 0, integral = 0;
  if (totals.brightest > 0) {
    view_.rows = rows_.data();
    int exponent = 0;
    std::frexp(totals.brightest, &exponent);
    view_.weight_scale = std::ldexp(1.0, -exponent);
    const bool is_compensated = settings.sampling == EnvironmentSampling::kCompensated;
    view_.weight_offset = is_compensated ? totals.integral / kFullSphere * view_.weight_scale : 0;
    integral = SumPyramid(*image_, view_).build(sums_);
    const double excess = integral / view_.weight_scale;
    if (excess > totals.integral * kMinExcess) map_power = excess * settings.scale / 3;
  }
  view_.sun_probability = sun_power > 0 ? sun_power / (sun_power + map_power) : 0;
  view_.sun_density = view_.has_sun ? view_.sun_probability / sun_solid_angle : 0;
  view_.map_density = map_power > 0 ? (1 - view_.sun_probability) / integral : 0;
  view_.is_sampled = view_.sun_probability > 0 || view_.map_density > 0;
  if (view_.map_density > 0) return;
  view_.rows = nullptr;
  view_.level_count = 0;
  sums_ = {};
}

}  // namespace orrery::compile
