// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/sphere.h"

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

}  // namespace orrery::compile
