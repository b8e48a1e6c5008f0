// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/stop_point.h"

namespace orrery::base {

/// A Bloom filter of hashes, with a false-positive rate of at most 1 in 50.
///
/// Reference  bloom1970
class HashFilter {
 public:
  explicit HashFilter(std::size_t count)
      : shift_(63 - static_cast<int>(std::bit_width(static_cast<std::uint64_t>(count) / 8))),
        words_(std::size_t{1} << (64 - shift_)) {}

  /// Inserts a hash.
  ///
  /// Result     true if the filter contained it before
  bool insert(std::uint64_t hash) {
    std::uint64_t& word = words_[hash >> shift_];
    const bool had = (word & bits(hash)) == bits(hash);
    word |= bits(hash);
    return had;
  }
  bool has(std::uint64_t hash) const { return (words_[hash >> shift_] & bits(hash)) == bits(hash); }

 private:
  /// Both bits are in the same word, which costs one cache miss per hash.
  static std::uint64_t bits(std::uint64_t hash) {
    return std::uint64_t{1} << (hash >> 8 & 63) | std::uint64_t{1} << (hash >> 14 & 63);
  }

  int shift_;
  std::vector<std::uint64_t> words_;
};

/// Inserts hashes into a filter and collects those that it already contains. Hashes are buffered and inserted in the
/// order of their upper bits, so that a filter of hundreds of megabytes is not accessed at random.
class DuplicateHashes {
 public:
  explicit DuplicateHashes(std::size_t count) : filter_(count) {}

  void add(std::uint64_t hash) {
    pending_.push_back(hash);
    if (pending_.size() == kChunk) flush();
  }
  std::vector<std::uint64_t> take() {
    flush();
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kChunk = 1 << 18, kParts = 256;

  void flush() {
    std::array<std::size_t, kParts + 1> begin{};
    for (const std::uint64_t hash : pending_) ++begin[(hash >> 56) + 1];
    for (std::size_t part = 0; part < kParts; ++part) begin[part + 1] += begin[part];
    sorted_.resize(pending_.size());
    for (const std::uint64_t hash : pending_) sorted_[begin[hash >> 56]++] = hash;
    for (const std::uint64_t hash : sorted_)
      if (filter_.insert(hash)) found_.push_back(hash);
    pending_.clear();
  }

  HashFilter filter_;
  std::vector<std::uint64_t> pending_, sorted_, found_;
};

template <std::size_t N>
std::uint64_t hash_of(const std::array<double, N>& key) {
  std::uint64_t h = 0x9E3779B97F4A7C15u;
  for (const double x : key) {
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0xD6E8FEB86659FD93u;
    h ^= h >> 32;
  }
  return h * 0xD6E8FEB86659FD93u;
}

/// Index of an item whose key equals that of an earlier item, and index of the first item with this key.
struct Duplicate {
  std::size_t index, first;
};

/// Finds all items of 0 .. count - 1 whose key equals that of an earlier item, in ascending order.
///
/// `key_of(i)` returns N numbers as a std::array; -0 equals 0, and a key with a NaN equals no other.
/// Errors     base::Error(kStopped) in a StopScope
/// Cost       on two busy cores 0.4 s for ten million items, 4 s for a hundred million; memory 1 to 3 bytes per item,
///            plus 40 bytes per duplicate
template <std::size_t N, class KeyOf>
std::vector<Duplicate> find_duplicates(std::size_t count, KeyOf key_of) {
  // Sorting the hashes of a hundred million keys would take a quarter of the memory of their spheres. The filters drop
  // nearly all unique keys, and only the rest is sorted.
  const StopPoint stop;
  const auto each = [&](auto visit) {
    for (std::size_t i = 0; i < count; ++i) {
      stop.check(i);
      std::array<double, N> key = key_of(i);
      for (double& x : key) x += 0.0;  // -0 becomes 0
      if (key == key) visit(i, hash_of(key));
    }
  };
  std::vector<std::uint64_t> suspects;
  {
    DuplicateHashes hashes(count);
    each([&](std::size_t, std::uint64_t hash) { hashes.add(hash); });
    suspects = hashes.take();
  }
  std::vector<Duplicate> out;
  if (suspects.empty()) return out;
  HashFilter suspected(suspects.size());
  for (const std::uint64_t hash : suspects) suspected.insert(hash);
  std::vector<std::uint64_t>().swap(suspects);

  struct Entry {
    std::uint64_t hash;
    std::size_t index;
  };
  std::vector<Entry> entries;
  each([&](std::size_t i, std::uint64_t hash) {
    if (suspected.has(hash)) entries.push_back({hash, i});
  });
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.hash != b.hash ? a.hash < b.hash : a.index < b.index; });
  std::vector<std::size_t>
      firsts;  // first items with one hash; more than one only if different keys have the same hash
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (e == 0 || entries[e].hash != entries[e - 1].hash) firsts.clear();
    const std::size_t i = entries[e].index;
    const auto first =
        std::find_if(firsts.begin(), firsts.end(), [&](std::size_t f) { return key_of(f) == key_of(i); });
    if (first == firsts.end()) {
      firsts.push_back(i);
    } else {
      out.push_back({i, *first});
    }
  }
  std::sort(out.begin(), out.end(), [](const Duplicate& a, const Duplicate& b) { return a.index < b.index; });
  return out;
}

}  // namespace orrery::base
