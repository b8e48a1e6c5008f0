// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
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

}  // namespace orrery::base
