// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace orrery::base {

/// Allocates arrays whose elements are zero without being written: the operating system clears a page of a large array
/// when a thread first touches it, so that it costs neither time nor memory before.
template <class T>
struct ZeroPageAllocator {
  using value_type = T;
  static_assert(std::is_trivially_copyable_v<T>);

  /// Size of a huge page, bytes; smaller arrays are allocated as usual.
  static constexpr std::size_t kPage = std::size_t{1} << 21;

  ZeroPageAllocator() = default;
  template <class U>
  ZeroPageAllocator(const ZeroPageAllocator<U>&) noexcept {}  // NOLINT(google-explicit-constructor): as std::allocator

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    void* const p = bytes < kPage ? std::calloc(count, sizeof(T))
                                  : mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (p == nullptr || p == MAP_FAILED) throw std::bad_alloc();
    if (bytes >= kPage) madvise(p, bytes, MADV_HUGEPAGE);  // without effect where it fails
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t count) noexcept {
    if (count * sizeof(T) < kPage)
      std::free(p);
    else
      munmap(p, count * sizeof(T));
  }
  /// Elements that a vector adds without a value are those of the pages.
  template <class U, class... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) > 0) ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
  }

  template <class U>
  bool operator==(const ZeroPageAllocator<U>&) const noexcept {
    return true;
  }
};

/// A vector whose elements are zero until they are set. Its size changes once: elements of an earlier size keep values.
template <class T>
using ZeroVector = std::vector<T, ZeroPageAllocator<T>>;

}  // namespace orrery::base
