// SPDX-License-Identifier: Apache-2.0
#include "compile/mip_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "base/stop_point.h"
#include "math/pixels.h"

namespace orrery::compile {
namespace {

constexpr int kMinHeight = 16, kMinWidth = 2 * kMinHeight;

bool has_next(int width, int height) { return width / 2 >= kMinWidth && height / 2 >= kMinHeight; }

/// A texel of the finer level and its weight in a texel of the coarser one.
struct Tap {
  int index;
  double weight;
};

/// Splits 0..`from` into `to` equal parts, and returns the texels that each covers. `measure(a, b)` is the weight of
/// the interval a..b.
template <class Measure>
std::vector<std::vector<Tap>> taps(int from, int to, Measure measure) {
  std::vector<std::vector<Tap>> out(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double begin = static_cast<double>(i) * from / to, end = static_cast<double>(i + 1) * from / to;
    for (int k = static_cast<int>(begin); k < from && k < end; ++k)
      out[static_cast<std::size_t>(i)].push_back(
          {k, measure(std::max(begin, static_cast<double>(k)), std::min(end, static_cast<double>(k + 1)))});
  }
  return out;
}

scene::LatLongMap reduced(const scene::LatLongMap& from) {
  scene::LatLongMap out(from.width() / 2, from.height() / 2);
  const auto columns = taps(from.width(), out.width(), [](double a, double b) { return b - a; });
  // The solid angle between two latitudes.
  const auto rows = taps(from.height(), out.height(), [&](double a, double b) {
    const long double half_row = std::numbers::pi_v<long double> / 2 / from.height();
    const auto sum = static_cast<long double>(a + b), difference = static_cast<long double>(b - a);
    return static_cast<double>(std::sin(half_row * sum) * std::sin(half_row * difference));
  });
  std::vector<double> sums(3 * static_cast<std::size_t>(out.width()));
  const base::StopPoint stop;
  for (int y = 0; y < out.height(); ++y) {
    stop.check();
    std::fill(sums.begin(), sums.end(), 0.0);
    double total = 0;
    for (const Tap& row : rows[static_cast<std::size_t>(y)]) {
      const float* const texels = from.row(row.index);
      for (std::size_t x = 0; x < columns.size(); ++x)
        for (const Tap& column : columns[x])
          for (std::size_t c = 0; c < 3; ++c)
            sums[3 * x + c] += row.weight * column.weight *
                               static_cast<double>(texels[3 * static_cast<std::size_t>(column.index) + c]);
      total += row.weight;
    }
    total *= static_cast<double>(from.width()) / out.width();
    for (std::size_t i = 0; i < sums.size(); ++i) out.row(y)[i] = static_cast<float>(sums[i] / total);
  }
  return out;
}

}  // namespace

void add_mip_map(scene::LatLongMap& image) {
  image.reduced.clear();
  while (true) {
    const scene::LatLongMap& last = image.reduced.empty() ? image : image.reduced.back();
    if (!has_next(last.width(), last.height())) return;
    image.reduced.push_back(reduced(last));
  }
}

std::uint64_t mip_map_bytes(int width, int height) {
  std::uint64_t texels = 0;
  while (true) {
    texels += math::pixel_count(width, height);
    if (!has_next(width, height)) return texels * 3 * sizeof(float);
    width /= 2;
    height /= 2;
  }
}

}  // namespace orrery::compile
