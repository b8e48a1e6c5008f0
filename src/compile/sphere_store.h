// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/huge_pages.h"
#include "kernel/sphere.h"
#include "math/vec3.h"
#include "scene/forward.h"
#include "scene/scene.h"

namespace orrery::compile {

/// Unsigned integers, each stored in as few bytes as the largest needs; in zero bytes if all are equal.
class PackedIndices {
 public:
  std::size_t size() const noexcept { return size_; }
  std::size_t bytes() const noexcept { return bytes_.size(); }
  std::uint32_t operator[](std::size_t i) const noexcept { return view()[i]; }

  void reserve(std::size_t count) { reserved_ = count; }
  void push_back(std::uint32_t index);

  /// Returns a view that is valid until this is modified.
  kernel::IndexArray view() const noexcept { return {bytes_.data(), width_}; }

 private:
  /// Bytes that kernel::IndexArray reads after the first one of an element.
  static constexpr std::size_t kPadding = 3;

  void widen(std::uint32_t width);
  void set(std::size_t i, std::uint32_t index);

  std::uint32_t width_ = 0;
  std::size_t size_ = 0, reserved_ = 0;
  std::vector<unsigned char> bytes_ = std::vector<unsigned char>(1 + kPadding);
};

/// The spheres of a compiled scene, stored in 12 or 13 bytes each where that is lossless.
class SphereStore {
 public:
  std::size_t size() const noexcept { return plain_.size() + (centers_ ? centers_->size() / 3 : 0); }
  bool empty() const noexcept { return size() == 0; }
  kernel::Sphere operator[](std::size_t id) const noexcept { return view()[id]; }

  /// Called after the centres begin .. end - 1 of a set of points have been copied.
  using OnCopied = std::function<void(std::size_t set, std::size_t begin, std::size_t end)>;

  /// Appends a sphere in full precision. Must not be called after compact spheres have been appended.
  void push_back(const kernel::Sphere& sphere) { plain_.push_back(sphere); }

  /// Appends the spheres of points files, the last ones: compact if their centres are exact in single precision, and
  /// their radii are exact as well or have few distinct values. Compact centres of a single file are shared with the
  /// scene, not copied.
  ///
  /// `on_copied`  may be empty
  void append(std::span<const scene::Points> points, const OnCopied& on_copied = {});

  /// Bytes that append() allocates.
  static std::size_t bytes_of(std::span<const scene::Points> points);
  /// Bytes that it takes at its peak, if the centres are released as they are copied.
  static std::size_t bytes_of_replacing(std::span<const scene::Points> points);

  /// Returns a view that is valid until this is modified.
  kernel::SphereArray view() const noexcept {
    kernel::SphereArray v(plain_.data());
    if (!centers_) return v;
    v.plain_count = plain_.size();
    v.centers = centers_->data();
    v.radii = radii_.empty() ? nullptr : radii_.data();
    v.radius_indices = radius_indices_.empty() ? nullptr : radius_indices_.data();
    v.radius_palette = radius_palette_.data();
    return v;
  }

  std::size_t bytes() const noexcept {
    const std::size_t numbers = (centers_ ? centers_->size() : 0) + radii_.size();
    return plain_.size() * sizeof(kernel::Sphere) + numbers * sizeof(float) + radius_indices_.size();
  }

 private:
  base::HugeVector<kernel::Sphere> plain_;
  std::shared_ptr<const base::HugeVector<float>> centers_;  ///< null: none are compact
  base::HugeVector<float> radii_;
  std::vector<std::uint8_t> radius_indices_;
  std::vector<double> radius_palette_;
};

/// An axis-aligned box.
struct Bounds {
  math::Vec3d lower;
  math::Vec3d upper;
};

/// Returns the bounding box of all spheres; unspecified if there are none.
///
/// Errors     base::Error(kStopped) in a base::StopScope
Bounds bounds_of(const SphereStore& spheres);

}  // namespace orrery::compile
