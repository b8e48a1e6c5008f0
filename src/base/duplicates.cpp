// SPDX-License-Identifier: Apache-2.0
#include "base/duplicates.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <span>

#include "base/stop_point.h"

namespace orrery::base {
namespace {

constexpr std::size_t kParts = 256;

/// Which part of a filter a hash belongs to. No two parts share memory.
std::size_t part_of(std::uint64_t hash) { return hash >> 56; }

/// A Bloom filter of hashes, with a false-positive rate of at most 1 in 50.
///
/// Reference  bloom1970
class HashFilter {
 public:
  explicit HashFilter(std::size_t count)
      : shift_(std::min(56, 63 - static_cast<int>(std::bit_width(static_cast<std::uint64_t>(count) / 8)))),
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

/// Calls visit(first item, hashes) for blocks of items, on all threads.
template <class Visit>
void each_block(std::size_t count, const ItemKeys& keys, Visit visit) {
  constexpr std::size_t kBlock = std::size_t{1} << 18;
  const StopPoint stop;
  tbb::parallel_for(std::size_t{0}, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    stop.check();
    const std::size_t begin = block * kBlock, end = std::min(count, begin + kBlock);
    std::vector<std::uint64_t> hashes(end - begin);
    keys.hash(begin, end, hashes.data());
    visit(begin, std::span<const std::uint64_t>(hashes));
  });
}

/// Collects the hashes that occur more than once, and a few others.
class SuspectHashes {
 public:
  explicit SuspectHashes(std::size_t count) : filter_(count) {}

  /// Adds hashes in the order of their parts, so that a filter of hundreds of megabytes is not accessed at random.
  void add(std::span<const std::uint64_t> hashes) {
    std::array<std::size_t, kParts + 1> begin{};
    for (const std::uint64_t hash : hashes) ++begin[part_of(hash) + 1];
    for (std::size_t part = 0; part < kParts; ++part) begin[part + 1] += begin[part];
    std::array<std::size_t, kParts + 1> next = begin;
    std::vector<std::uint64_t> sorted(hashes.size());
    for (const std::uint64_t hash : hashes) sorted[next[part_of(hash)]++] = hash;
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::scoped_lock lock(parts_[part].mutex);
      for (std::size_t i = begin[part]; i < begin[part + 1]; ++i)
        if (sorted[i] != 0 && filter_.insert(sorted[i])) parts_[part].found.push_back(sorted[i]);
    }
  }

  std::vector<std::uint64_t> take() {
    std::vector<std::uint64_t> out;
    for (const Part& part : parts_) out.insert(out.end(), part.found.begin(), part.found.end());
    return out;
  }

 private:
  struct Part {
    std::mutex mutex;
    std::vector<std::uint64_t> found;
  };

  HashFilter filter_;
  std::array<Part, kParts> parts_;
};

struct Entry {
  std::uint64_t hash;
  std::size_t index;
};

/// The items with the hashes of `suspects`, and a few others.
std::vector<Entry> entries_of(const std::vector<std::uint64_t>& suspects, std::size_t count, const ItemKeys& keys) {
  HashFilter suspected(suspects.size());
  for (const std::uint64_t hash : suspects) suspected.insert(hash);
  std::vector<Entry> out;
  std::mutex mutex;
  each_block(count, keys, [&](std::size_t first, std::span<const std::uint64_t> hashes) {
    std::vector<Entry> found;
    for (std::size_t i = 0; i < hashes.size(); ++i)
      if (hashes[i] != 0 && suspected.has(hashes[i])) found.push_back({hashes[i], first + i});
    const std::scoped_lock lock(mutex);
    out.insert(out.end(), found.begin(), found.end());
  });
  return out;
}

}  // namespace

// Sorting the hashes of a hundred million keys would take a quarter of the memory of their spheres. The filters drop
// nearly all unique keys, and only the rest is sorted.
std::vector<Duplicate> find_duplicates(std::size_t count, const ItemKeys& keys) {
  std::vector<Duplicate> out;
  std::vector<std::uint64_t> suspects;
  {
    SuspectHashes all(count);
    each_block(count, keys, [&](std::size_t, std::span<const std::uint64_t> hashes) { all.add(hashes); });
    suspects = all.take();
  }
  if (suspects.empty()) return out;
  std::vector<Entry> entries = entries_of(suspects, count, keys);
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.hash != b.hash ? a.hash < b.hash : a.index < b.index; });
  // First items with one hash; more than one only if different keys have the same hash.
  std::vector<std::size_t> firsts;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (e == 0 || entries[e].hash != entries[e - 1].hash) firsts.clear();
    const std::size_t i = entries[e].index;
    const auto first = std::find_if(firsts.begin(), firsts.end(), [&](std::size_t f) { return keys.equal(f, i); });
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
