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

void add_times(kernel::PixelSum& to, const kernel::PixelSum& sum, std::int64_t times) {
  for (int c = 0; c < 3; ++c) to.rgb[c] += sum.rgb[c] * times;
  to.weight += sum.weight * static_cast<std::uint32_t>(times);
}

void add_times(kernel::GuideSum& to, const kernel::GuideSum& sum, std::int64_t times) {
  to.inverse_depth += sum.inverse_depth * times;
  to.weight += sum.weight * times;
  for (int k = 0; k < 3; ++k) {
    to.albedo[k] += sum.albedo[k] * times;
    to.normal[k] += sum.normal[k] * times;
  }
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

std::uint32_t Sums::paths_of(std::size_t half, std::size_t pixel) const {
  const std::uint32_t all = counts[pixel];
  if (is_adaptive() || !has_halves()) return all;
  const std::uint32_t in_first = std::min(all, empty.first_half);
  return half == 0 ? in_first : all - in_first;
}

kernel::PixelSum Sums::light_of(std::size_t half, std::size_t pixel) const {
  kernel::PixelSum out = light[half][pixel];
  if (empty.is_known()) add_times(out, empty.light, paths_of(half, pixel));
  return out;
}

kernel::GuideSum Sums::guides_of(std::size_t half, std::size_t pixel) const {
  kernel::GuideSum out = guides[half][pixel];
  if (empty.is_known()) add_times(out, empty.guides, paths_of(half, pixel));
  return out;
}

kernel::PixelSum Sums::sum(std::size_t pixel) const {
  kernel::PixelSum out = light_of(0, pixel);
  if (has_halves()) out += light_of(1, pixel);
  return out;
}

void Sums::add_light(std::size_t half, std::size_t pixel, kernel::PixelSum sum, std::uint32_t paths) {
  if (empty.is_known()) add_times(sum, empty.light, -std::int64_t{paths});
  light[half][pixel] += sum;
}

void Sums::add_guides(std::size_t half, std::size_t pixel, kernel::GuideSum sum, std::uint32_t paths) {
  if (empty.is_known()) add_times(sum, empty.guides, -std::int64_t{paths});
  guides[half][pixel] += sum;
}

void Sums::add_empty(std::size_t half, std::size_t pixel, const EmptyPath& path, std::uint32_t paths) {
  if (paths == 0) return;
  if (is_adaptive()) largest[pixel] = std::max(largest[pixel], path.largest);
  if (empty.is_known()) return;
  add_times(light[half][pixel], path.light, paths);
  if (!guides[half].empty()) add_times(guides[half][pixel], path.guides, paths);
}

void Sums::add_empty_to_sums() {
  for (std::size_t half = 0; half < 2; ++half)
    for (std::size_t i = 0; i < pixel_count() && empty.is_known(); ++i) {
      if (!light[half].empty()) light[half][i] = light_of(half, i);
      if (!guides[half].empty()) guides[half][i] = guides_of(half, i);
    }
  empty = {};
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
  const auto sum = static_cast<double>(std::max<std::int64_t>(layers.covered[pixel], 0));  // see add_coverage()
  return static_cast<float>(sum * kernel::kGuideUnit / static_cast<double>(paths(pixel)));
}

}  // namespace orrery::film
