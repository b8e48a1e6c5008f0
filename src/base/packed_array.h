// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/huge_pages.h"

namespace orrery::base {

/// Unsigned integers in one to four bytes each, depending on the largest.
class PackedArray {
 public:
  PackedArray() = default;
  /// Creates `size` elements with the value `largest`, which is the maximum of the array.
  PackedArray(std::size_t size, std::uint32_t largest) : size_(size) {
    while (width_ < 4 && largest >> (8 * width_) != 0) ++width_;
    mask_ = 0xFFFFFFFFu >> (32 - 8 * width_);
    bytes_.resize(size * width_ + sizeof(mask_) - width_);  // elements are read as four bytes
    for (std::size_t i = 0; i < size; ++i) set(i, largest);
  }

  std::size_t size() const noexcept { return size_; }
  std::size_t bytes() const noexcept { return bytes_.size(); }

  std::uint32_t operator[](std::size_t i) const noexcept {
    std::uint32_t value;
    std::memcpy(&value, address(i), sizeof(value));
    return value & mask_;
  }
  /// Threads may set different elements concurrently.
  void set(std::size_t i, std::uint32_t value) noexcept { std::memcpy(&bytes_[i * width_], &value, width_); }

  /// The address of an element, for prefetching.
  const std::uint8_t* address(std::size_t i) const noexcept { return &bytes_[i * width_]; }

 private:
  HugeVector<std::uint8_t> bytes_;
  std::size_t size_ = 0;
  unsigned width_ = 1;  ///< bytes per element
  std::uint32_t mask_ = 0xFF;
};

}  // namespace orrery::base
