// SPDX-License-Identifier: Apache-2.0
#include "film/sums.h"

#include <algorithm>
#include <numeric>

#include "math/pixels.h"

namespace orrery::film {
namespace {

/// The size of each array, bytes.
std::vector<std::size_t> sizes_of(const Sums& p) {
  std::vector<std::size_t> out;
  const auto add = [&](const auto&... arrays) { (out.push_back(arrays.size() * sizeof(arrays[0])), ...); };
  const LayerSums& l = p.layers;
  add(p.light[0], p.light[1], p.guides[0], p.guides[1], p.largest, p.counts, p.goals);
  add(l.light, l.squares, l.normal, l.albedo, l.covered, l.hit, l.depth, l.z, l.position, l.shares);
  return out;
}

}  // namespace

RenderWork& RenderWork::operator+=(const RenderWork& other) {
  paths += other.paths;
  rays += other.rays;
  bad_samples += other.bad_samples;
  seconds += other.seconds;
  return *this;
}

Sums::Sums(int width_px, int height_px, const LayerRequest& request, bool is_adaptive)
    : width(width_px), height(height_px), counts(math::pixel_count(width_px, height_px)) {
  light[0].resize(pixel_count());
  if (is_adaptive || request.guides()) light[1].resize(pixel_count());
  if (request.guides())
    for (auto& half : guides) half.resize(pixel_count());
  if (is_adaptive) largest.resize(pixel_count());
  layers = LayerSums(request, pixel_count());
}

bool Sums::has_arrays_of(const Sums& other) const {
  const std::vector<std::size_t> own = sizes_of(*this), wanted = sizes_of(other);
  return std::equal(own.begin(), own.end(), wanted.begin(),
                    [](std::size_t a, std::size_t b) { return b == 0 || a == b; });
}

std::size_t Sums::bytes() const {
  const std::vector<std::size_t> sizes = sizes_of(*this);
  return std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
}

void Sums::add(const Sums& other) {
  const auto add_all = [](auto& to, const auto& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  };
  for (std::size_t half = 0; half < 2; ++half) {
    add_all(light[half], other.light[half]);
    add_all(guides[half], other.guides[half]);
  }
  add_all(counts, other.counts);
  layers.add(other.layers);
  work += other.work;
}

bool Sums::has_known_spheres(std::size_t count) const {
  const auto is_known = [count](const SphereCoverage& s) { return s.sphere == kernel::kNone || s.sphere < count; };
  return std::all_of(layers.hit.begin(), layers.hit.end(), [count](std::uint32_t hit) { return hit <= count; }) &&
         std::all_of(layers.shares.begin(), layers.shares.end(),
                     [&](const auto& shares) { return std::all_of(shares.begin(), shares.end(), is_known); });
}

void Sums::mean(std::size_t pixel, float* rgb) const {
  const kernel::PixelSum total = sum(pixel);
  for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(film::mean(total.rgb[c], total.weight));
}

float Sums::coverage(std::size_t pixel) const {
  if (paths(pixel) == 0) return 0;
  return static_cast<float>(static_cast<double>(layers.covered[pixel]) * kernel::kGuideUnit /
                            static_cast<double>(paths(pixel)));
}

}  // namespace orrery::film
