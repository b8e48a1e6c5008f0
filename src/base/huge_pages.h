// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

namespace orrery::base {

/// Allocates large arrays in huge pages, where the system supports them: nearly every step of a ray touches a different
/// page, and the TLB holds only a few small pages.
template <class T>
struct HugePageAllocator {
  using value_type = T;

  /// Size of a huge page, bytes; smaller arrays are allocated as usual.
  static constexpr std::size_t kPage = std::size_t{1} << 21;

  HugePageAllocator() = default;
  template <class U>
  HugePageAllocator(const HugePageAllocator<U>&) noexcept {}  // NOLINT(google-explicit-constructor): as std::allocator

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kPage) return static_cast<T*>(::operator new(bytes, kAlignment));
    const std::size_t whole = (bytes + kPage - 1) / kPage * kPage;
    void* const p = std::aligned_alloc(kPage, whole);
    if (p == nullptr) throw std::bad_alloc();
    madvise(p, whole, MADV_HUGEPAGE);  // without effect where it fails
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t count) noexcept {
    if (count * sizeof(T) < kPage) return ::operator delete(p, kAlignment);
    std::free(p);
  }

  template <class U>
  bool operator==(const HugePageAllocator<U>&) const noexcept {
    return true;
  }

 private:
  static constexpr std::align_val_t kAlignment{alignof(T)};
};

template <class T>
using HugeVector = std::vector<T, HugePageAllocator<T>>;

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
