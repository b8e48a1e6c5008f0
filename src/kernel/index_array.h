// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace orrery::kernel {

/// Non-owning view of unsigned integers of 0, 1, 2 or 4 bytes each.
///
/// Reading an element loads four bytes from its start, so three bytes after the last element must be readable.
struct IndexArray {
  const unsigned char* data = nullptr;
  std::uint32_t stride = 0;  ///< bytes; 0: all are equal, and stored in four bytes
  std::uint32_t mask = 0;    ///< mask of the bits that belong to an element

  IndexArray() = default;
  IndexArray(const unsigned char* bytes, std::uint32_t bytes_each)
      : data(bytes), stride(bytes_each), mask(bytes_each % 4 == 0 ? 0xffffffffu : (1u << 8 * bytes_each) - 1) {}
  IndexArray(const std::uint32_t* elements)  // NOLINT(google-explicit-constructor): implicit view of an array
      : IndexArray(reinterpret_cast<const unsigned char*>(elements), sizeof(std::uint32_t)) {}

  std::uint32_t operator[](std::size_t i) const noexcept {
    std::uint32_t element = 0;
    std::memcpy(&element, data + i * stride, sizeof(element));
    return element & mask;
  }
};

}  // namespace orrery::kernel
