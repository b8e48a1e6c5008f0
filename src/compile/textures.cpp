// SPDX-License-Identifier: Apache-2.0
#include "compile/textures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "scene/lat_long_map.h"
#include "scene/texture.h"

namespace orrery::compile {
namespace {

using math::set;
using math::Vec3d;

// Both enumerations have the same order.
static_assert(static_cast<int>(scene::TextureType::kImage) == static_cast<int>(kernel::TextureKind::kImage));

/// Unit vectors distributed uniformly: points in a ball, normalized. Only the generator and correctly rounded
/// operations decide their bits.
const double* gradients() {
  static const std::vector<double> all = [] {
    std::mt19937_64 random{1985};
    const auto component = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
    std::vector<double> out;
    while (out.size() < std::size_t{4} * kernel::kGradients) {
      const Vec3d v{component(), component(), component()};
      const double square = math::dot(v, v);
      if (square > 1 || square < 0.01) continue;
      const double length = std::sqrt(square);
      out.insert(out.end(), {v.x / length, v.y / length, v.z / length, 0});
    }
    return out;
  }();
  return all.data();
}

/// The mean of a map over the sphere.
Vec3d mean_of(const scene::LatLongMap& image) {
  const auto cosine_at = [&](int edge) {
    return static_cast<double>(std::cos(std::numbers::pi_v<long double> * edge / image.height()));
  };
  Vec3d sum{};
  for (int y = 0; y < image.height(); ++y) {
    const float* const row = image.row(y);
    Vec3d of_row{};
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width()); ++x)
      of_row = of_row + Vec3d{static_cast<double>(row[3 * x]), static_cast<double>(row[3 * x + 1]),
                              static_cast<double>(row[3 * x + 2])};
    sum = sum + of_row * ((cosine_at(y) - cosine_at(y + 1)) / 2);
  }
  return sum * (1.0 / image.width());
}

}  // namespace

Vec3d mean_of(const scene::Texture& texture) {
  if (texture.type != scene::TextureType::kImage) return (texture.low + texture.high) * 0.5;
  return texture.image ? mean_of(*texture.image) : Vec3d{0.5, 0.5, 0.5};
}

std::uint32_t TextureStore::add(const scene::Texture& texture, Vec3d factor) {
  kernel::Texture out;
  out.kind = static_cast<kernel::TextureKind>(texture.type);
  out.scale = texture.scale;
  out.seed = texture.seed;
  out.gradients = gradients();
  set(out.low, texture.low * factor);
  set(out.high, texture.high * factor);
  if (texture.type == scene::TextureType::kImage) {
    if (!texture.image) return kernel::kNone;
    const auto image = std::make_shared<Image>();
    image->texels = texture.image;
    const auto add_level = [&](const scene::LatLongMap& level) {
      image->view.levels[image->view.level_count++] = {level.row(0), static_cast<std::uint32_t>(level.width()),
                                                       static_cast<std::uint32_t>(level.height())};
    };
    add_level(*texture.image);
    for (const scene::LatLongMap& level : texture.image->reduced) add_level(level);
    // An environment's left edge is at -z; seen from outside, that of a texture is at -x.
    const double turn = -0.25 - texture.rotation / 360;
    image->view.turn = turn - std::floor(turn);
    images_.push_back(image);
    out.image = &image->view;
    set(out.low, {0, 0, 0});
    set(out.high, factor);
  }
  textures_.push_back(out);
  return static_cast<std::uint32_t>(textures_.size() - 1);
}

std::uint32_t TextureStore::add_scaled(std::uint32_t index, Vec3d factor) {
  kernel::Texture out = textures_[index];
  const double by[3] = {factor.x, factor.y, factor.z};
  for (int k = 0; k < 3; ++k) {
    out.low[k] *= by[k];
    out.high[k] *= by[k];
  }
  textures_.push_back(out);
  return static_cast<std::uint32_t>(textures_.size() - 1);
}

bool TextureStore::has_levels() const noexcept {
  return std::any_of(images_.begin(), images_.end(), [](const auto& image) { return image->view.level_count > 1; });
}

std::uint64_t TextureStore::bytes() const noexcept {
  std::uint64_t bytes = 0;
  std::set<const scene::LatLongMap*> counted;
  for (const auto& image : images_)
    if (counted.insert(image->texels.get()).second)
      for (std::uint32_t k = 0; k < image->view.level_count; ++k)
        bytes += 3 * sizeof(float) * std::uint64_t{image->view.levels[k].width} * image->view.levels[k].height;
  return bytes;
}

}  // namespace orrery::compile
