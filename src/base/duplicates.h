// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace orrery::base {

/// Index of an item whose key equals that of an earlier item, and index of the first item with this key.
struct Duplicate {
  std::size_t index, first;
};

/// What find_duplicates() needs to know of keys; called on any thread.
struct ItemKeys {
  /// Sets the hashes of the items begin .. end - 1; 0 for a key that equals no other.
  std::function<void(std::size_t begin, std::size_t end, std::uint64_t* hashes)> hash;
  std::function<bool(std::size_t, std::size_t)> equal;
};

/// Finds all items of 0 .. count - 1 whose key equals that of an earlier item, in ascending order.
///
/// Errors     base::Error(kStopped) in a StopScope
/// Cost       two passes over the keys, on all threads; memory 1 to 3 bytes per item, plus 40 bytes per duplicate
std::vector<Duplicate> find_duplicates(std::size_t count, const ItemKeys& keys);

template <std::size_t N>
std::uint64_t hash_of(const std::array<double, N>& key) {
  std::uint64_t h = 0x9E3779B97F4A7C15u;
  for (const double x : key) {
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0xD6E8FEB86659FD93u;
    h ^= h >> 32;
  }
  return h * 0xD6E8FEB86659FD93u;
}

/// The same for keys of N numbers, std::array<double, N>: -0 equals 0, and a key with a NaN equals no other.
template <std::size_t N, class KeyOf>
std::vector<Duplicate> find_duplicates(std::size_t count, KeyOf key_of) {
  ItemKeys keys;
  keys.hash = [&](std::size_t begin, std::size_t end, std::uint64_t* hashes) {
    for (std::size_t i = begin; i < end; ++i) {
      std::array<double, N> key = key_of(i);
      for (double& x : key) x += 0.0;  // -0 becomes 0
      hashes[i - begin] = key == key ? hash_of(key) | 1 : 0;
    }
  };
  keys.equal = [&](std::size_t a, std::size_t b) { return key_of(a) == key_of(b); };
  return find_duplicates(count, keys);
}

}  // namespace orrery::base
