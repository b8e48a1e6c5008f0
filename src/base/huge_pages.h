// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace orrery::base {

/// Allocates large arrays in huge pages, where the system supports them: nearly every step of a ray touches a different
/// page, and the TLB holds only a few small pages. Elements that a vector adds without a value are not initialized, so
/// that threads can touch their pages first. Behind the last element kPadding bytes are readable, for loads of vectors.
template <class T>
struct HugePageAllocator {
  using value_type = T;

  /// Size of a huge page, bytes; smaller arrays are allocated as usual.
  static constexpr std::size_t kPage = std::size_t{1} << 21;
  static constexpr std::size_t kPadding = 16;

  HugePageAllocator() = default;
  template <class U>
  HugePageAllocator(const HugePageAllocator<U>&) noexcept {}  // NOLINT(google-explicit-constructor): as std::allocator

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kPage) return static_cast<T*>(::operator new(bytes + kPadding, kAlignment));
    const std::size_t whole = (bytes + kPadding + kPage - 1) / kPage * kPage;
    void* const p = std::aligned_alloc(kPage, whole);
    if (p == nullptr) throw std::bad_alloc();
    madvise(p, whole, MADV_HUGEPAGE);  // without effect where it fails
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t count) noexcept {
    if (count * sizeof(T) < kPage) return ::operator delete(p, kAlignment);
    std::free(p);
  }
  template <class U, class... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0)
      ::new (static_cast<void*>(p)) U;
    else
      ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
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

/// Returns the memory of elements that are not needed any more to the operating system, except at the ends, where a
/// page has other contents. It stays allocated; the values are indeterminate from then on.
template <class T>
void release_memory(std::span<T> elements) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(elements.data()) + page - 1) / page * page,
             last = reinterpret_cast<std::uintptr_t>(elements.data() + elements.size()) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

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
  const std::uint8_t* address(std::size_t i) const noexcept { return bytes_.data() + i * width_; }

 private:
  HugeVector<std::uint8_t> bytes_;
  std::size_t size_ = 0;
  unsigned width_ = 1;  ///< bytes per element
  std::uint32_t mask_ = 0xFF;
};

}  // namespace orrery::base
