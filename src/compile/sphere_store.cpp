// SPDX-License-Identifier: Apache-2.0
#include "compile/sphere_store.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/stop_point.h"
#include "math/scalar.h"
#include "scene/number_array.h"
#include "scene/scene.h"

namespace orrery::compile {
namespace {

static_assert(std::endian::native == std::endian::little, "elements are read from their lowest byte on");

/// Bytes of an index.
std::uint32_t width_of(std::uint32_t index) { return index < 1u << 8 ? 1 : index < 1u << 16 ? 2 : 4; }

/// Distinct radii of all sets if each stores a palette; empty if one does not, or if there are more radii than a
/// one-byte index allows.
std::vector<double> common_palette(std::span<const scene::Points> sets) {
  constexpr std::size_t kMax = 256;
  std::vector<double> out;
  const auto add = [&](double radius) {
    radius = std::abs(radius);
    if (std::find(out.begin(), out.end(), radius) == out.end()) out.push_back(radius);
  };
  for (const scene::Points& points : sets) {
    if (points.radii.empty()) continue;
    if (!points.radii.is_uniform() && points.radii.palette().empty()) return {};
    if (points.radii.is_uniform()) add(points.radii[0]);
    for (const double radius : points.radii.palette()) add(radius);
    if (out.size() > kMax) return {};
  }
  return out;
}

/// Appends the index of each radius in the palette.
void append_indices(const scene::NumberArray& radii, const std::vector<double>& palette,
                    std::vector<std::uint8_t>& out) {
  const auto index = [&](double radius) {
    return static_cast<std::uint8_t>(std::find(palette.begin(), palette.end(), std::abs(radius)) - palette.begin());
  };
  if (radii.is_uniform()) {
    if (!radii.empty()) out.insert(out.end(), radii.size(), index(radii[0]));
    return;
  }
  std::vector<std::uint8_t> of_palette;
  for (const double radius : radii.palette()) of_palette.push_back(index(radius));
  for (const std::uint8_t i : radii.palette_indices()) out.push_back(of_palette[i]);
}

void append_singles(const scene::NumberArray& numbers, base::HugeVector<float>& out) {
  if (const auto singles = numbers.singles())
    out.insert(out.end(), singles->begin(), singles->end());
  else
    for (const double number : numbers) out.push_back(static_cast<float>(number));
}

/// The centres of all sets, if those are the floats of one of them; else null.
std::shared_ptr<const base::HugeVector<float>> shared_centers(std::span<const scene::Points> sets, std::size_t count) {
  for (const scene::Points& points : sets)
    if (points.centers.size() == count) return points.centers.numbers().singles();
  return nullptr;
}

/// How the spheres of points files are stored.
struct Layout {
  std::vector<double> palette;  ///< distinct radii, if they are stored as indices
  std::size_t count = 0;        ///< number of spheres
  bool is_compact = true;       ///< in single precision
};

Layout layout_of(std::span<const scene::Points> sets) {
  Layout out;
  out.palette = common_palette(sets);
  for (const scene::Points& points : sets) {
    out.count += points.centers.size();
    out.is_compact = out.is_compact && points.centers.numbers().fits_single() &&
                     (!out.palette.empty() || points.radii.fits_single());
  }
  return out;
}

}  // namespace

void PackedIndices::push_back(std::uint32_t index) {
  if (size_ == 0) std::memcpy(bytes_.data(), &index, sizeof(index));
  if (width_ > 0 ? width_of(index) > width_ : index != (*this)[0]) widen(width_of(std::max(index, (*this)[0])));
  if (width_ > 0) {
    bytes_.resize(size_ * width_ + width_ + kPadding);
    set(size_, index);
  }
  ++size_;
}

void PackedIndices::widen(std::uint32_t width) {
  PackedIndices wide;
  wide.width_ = width;
  wide.bytes_.reserve(std::max(reserved_, size_) * wide.width_ + kPadding);
  wide.bytes_.resize(size_ * wide.width_ + kPadding);
  for (std::size_t i = 0; i < size_; ++i) wide.set(i, (*this)[i]);
  bytes_ = std::move(wide.bytes_);
  width_ = wide.width_;
}

void PackedIndices::set(std::size_t i, std::uint32_t index) { std::memcpy(&bytes_[i * width_], &index, width_); }

std::size_t SphereStore::bytes_of(std::span<const scene::Points> sets) {
  const Layout layout = layout_of(sets);
  if (!layout.is_compact) return layout.count * sizeof(kernel::Sphere);
  const std::size_t radius = layout.palette.empty() ? sizeof(float) : layout.palette.size() > 1 ? 1 : 0;
  return layout.count * ((shared_centers(sets, layout.count) ? 0 : 3 * sizeof(float)) + radius);
}

std::size_t SphereStore::bytes_of_replacing(std::span<const scene::Points> sets) {
  std::size_t bytes = bytes_of(sets);
  if (!layout_of(sets).is_compact)
    for (const scene::Points& points : sets) bytes -= points.centers.bytes();
  return bytes;
}

void SphereStore::append(std::span<const scene::Points> sets, const OnCopied& on_copied) {
  Layout layout = layout_of(sets);
  const auto copied = [&](std::size_t set, std::size_t begin, std::size_t end) {
    if (on_copied && begin < end) on_copied(set, begin, end);
  };
  const base::StopPoint stop;
  if (!layout.is_compact) {
    constexpr std::size_t kBlock = std::size_t{1} << 20;
    plain_.reserve(plain_.size() + layout.count);
    for (std::size_t set = 0; set < sets.size(); ++set)
      for (std::size_t begin = 0; begin < sets[set].centers.size(); begin += kBlock) {
        const scene::Points& points = sets[set];
        const std::size_t end = std::min(points.centers.size(), begin + kBlock);
        for (std::size_t i = begin; i < end; ++i) {
          stop.check(i);
          const math::Vec3d c = points.centers[i];
          plain_.push_back({c.x, c.y, c.z, std::abs(points.radii[i])});
        }
        copied(set, begin, end);
      }
    return;
  }
  stop.check();
  radius_palette_ = std::move(layout.palette);
  if (layout.count == 0) return;
  centers_ = shared_centers(sets, layout.count);
  if (!centers_) {
    base::HugeVector<float> centers;
    centers.reserve(3 * layout.count);
    for (std::size_t set = 0; set < sets.size(); ++set) {
      append_singles(sets[set].centers.numbers(), centers);
      copied(set, 0, sets[set].centers.size());
    }
    centers_ = std::make_shared<const base::HugeVector<float>>(std::move(centers));
  }
  if (radius_palette_.empty()) radii_.reserve(layout.count);
  if (radius_palette_.size() > 1) radius_indices_.reserve(layout.count);
  for (const scene::Points& points : sets) {
    if (radius_palette_.empty()) append_singles(points.radii, radii_);
    if (radius_palette_.size() > 1) append_indices(points.radii, radius_palette_, radius_indices_);
  }
  for (float& radius : radii_) radius = std::abs(radius);
}

Bounds bounds_of(const SphereStore& spheres) {
  if (spheres.empty()) return {};
  using math::kInfinity;
  Bounds b{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  const base::StopPoint stop;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    stop.check(i);
    const kernel::Sphere s = spheres[i];
    const math::Vec3d center{s.x, s.y, s.z}, reach{s.radius, s.radius, s.radius};
    b.lower = math::least(b.lower, center - reach);
    b.upper = math::greatest(b.upper, center + reach);
  }
  return b;
}

}  // namespace orrery::compile
