// SPDX-License-Identifier: Apache-2.0
#include "film/partial.h"

#include <algorithm>

#include "film/layers.h"
#include "math/pixels.h"

namespace orrery::film {

RenderWork& RenderWork::operator+=(const RenderWork& other) {
  paths += other.paths;
  rays += other.rays;
  bad_samples += other.bad_samples;
  seconds += other.seconds;
  return *this;
}

void Partial::add_second_half() {
  second = Film(film.width(), film.height());
  largest.resize(pixel_count());
}

void Partial::add(const Partial& other) {
  film.add(other.film);
  layers.resize(std::max(layers.size(), other.layers.size()));
  halves.resize(std::max(halves.size(), other.halves.size()));
  for (std::size_t i = 0; i < other.pixel_count(); ++i) {
    counts[i] += other.counts[i];
    if (!other.layers.empty()) layers[i].add(other.layers[i]);
    if (!other.halves.empty())
      for (std::size_t half = 0; half < 2; ++half) halves[i][half] += other.halves[i][half];
  }
  work += other.work;
}

bool Partial::has_known_spheres(std::size_t count) const {
  const auto is_known = [count](std::uint32_t s) { return s == kernel::kNone || s < count; };
  return std::all_of(layers.begin(), layers.end(), [&](const LayerPixel& p) {
    return is_known(p.sphere) &&
           std::all_of(p.shares.begin(), p.shares.end(), [&](const SphereCoverage& s) { return is_known(s.sphere); });
  });
}

void Partial::mean(int x, int y, float* rgb) const {
  const std::size_t i = math::pixel_index(x, y, film.width());
  const kernel::PixelSum total = sum(i);
  for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(film::mean(total.rgb[c], total.weight));
}

}  // namespace orrery::film
