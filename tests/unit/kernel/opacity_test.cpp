// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "support/chi_square.h"

#include "kernel/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Whether an object is visible to rays with these keys, 1 or 0, by the lanes of T.
template <class T>
void visible_in(const std::uint32_t* keys, std::size_t count, std::uint32_t id, float opacity, std::uint8_t* out) {
  const hn::ScalableTag<T> d;
  const KeyTag<decltype(d)> d32;
  HWY_ALIGN T lanes[hn::MaxLanes(d)];
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto visible = are_visible(d, hn::LoadU(d32, keys + i), hn::Set(d32, id), hn::Set(d, T{opacity}));
    hn::Store(hn::IfThenElseZero(visible, hn::Set(d, T{1})), d, lanes);
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) out[i + k] = lanes[k] != 0 ? 1 : 0;
  }
}
void visible_in_double(const std::uint32_t* keys, std::size_t count, std::uint32_t id, float opacity,
                       std::uint8_t* out) {
  visible_in<double>(keys, count, id, opacity, out);
}
void visible_in_float(const std::uint32_t* keys, std::size_t count, std::uint32_t id, float opacity,
                      std::uint8_t* out) {
  visible_in<float>(keys, count, id, opacity, out);
}

/// The keys of the rays from vertices of one path after the other: next, shadow, next, shadow, ...
void keys_of_paths(std::uint32_t* out, std::size_t count) {
  const hn::FixedTag<double, 1> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (std::size_t i = 0; i < count; i += 2) {
    const std::uint64_t n = i / 2;
    const auto keys = keys_at_vertex(du, 1, hn::Set(du, n / 64), hn::Set(du, n / 4 % 16), n % 4);
    store_keys(d, keys.next, out + i);
    store_keys(d, keys.shadow, out + i + 1);
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

using Visible = std::vector<std::uint8_t>;
constexpr std::size_t kCount = std::size_t{1} << 18;

std::vector<std::uint32_t> path_keys(std::size_t count = kCount) {
  std::vector<std::uint32_t> keys(count);
  HWY_NAMESPACE::keys_of_paths(keys.data(), count);
  return keys;
}

Visible visible(const std::vector<std::uint32_t>& keys, std::uint32_t id, float opacity) {
  Visible out(keys.size());
  HWY_NAMESPACE::visible_in_double(keys.data(), keys.size(), id, opacity, out.data());
  return out;
}

TEST(KernelOpacity, ZeroIsNeverVisibleAndOneAlways) {
  const auto keys = path_keys();
  for (const std::uint32_t id : {0u, 1u, 77u, 0xffffffffu}) {
    EXPECT_EQ(visible(keys, id, 0), Visible(kCount, 0)) << id;
    EXPECT_EQ(visible(keys, id, 1), Visible(kCount, 1)) << id;
  }
}

/// Of all keys from 0 to 2^26, about four have the hash 0.
TEST(KernelOpacity, ZeroIsNotVisibleToTheSmallestHash) {
  std::vector<std::uint32_t> keys(kCount);
  for (std::uint32_t begin = 0; begin < 1u << 26; begin += kCount) {
    std::iota(keys.begin(), keys.end(), begin);
    ASSERT_EQ(visible(keys, 5, 0), Visible(kCount, 0));
  }
}

TEST(KernelOpacity, BothPrecisionsDecideAlike) {
  const auto keys = path_keys();
  for (std::uint32_t id = 0; id < 20; ++id) {
    const float opacity = 0.1F + 0.04F * static_cast<float>(id);
    Visible in_float(kCount);
    HWY_NAMESPACE::visible_in_float(keys.data(), kCount, id, opacity, in_float.data());
    EXPECT_EQ(visible(keys, id, opacity), in_float) << id;
  }
}

/// The quarter of 0..1 in which each decision lies.
Visible quarters(const std::vector<std::uint32_t>& keys, std::uint32_t id) {
  Visible out(kCount, 3);
  for (const float opacity : {0.25F, 0.5F, 0.75F}) {
    const Visible below = visible(keys, id, opacity);
    for (std::size_t i = 0; i < kCount; ++i) out[i] = static_cast<std::uint8_t>(out[i] - below[i]);
  }
  return out;
}

TEST(KernelOpacity, DecisionsAboutTwoObjectsAreIndependentAndUniform) {
  const auto keys = path_keys();
  std::mt19937 random(3);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i < 40; ++i) pairs.emplace_back(i, i + 1);
  for (std::uint32_t bit = 0; bit < 32; ++bit) {
    const auto id = static_cast<std::uint32_t>(random());
    pairs.emplace_back(0, 1u << bit);
    pairs.emplace_back(id, id ^ (1u << bit));
  }
  for (const auto& [a, b] : pairs) {
    const Visible of_a = quarters(keys, a), of_b = quarters(keys, b);
    std::vector<std::uint64_t> counts(16);
    for (std::size_t i = 0; i < kCount; ++i) ++counts[of_a[i] * 4u + of_b[i]];
    EXPECT_LT(std::abs(test::chi_square_of_equal_bins(counts).z), test::kLargestZ) << a << ", " << b;
  }
}

/// A hash of the sum of key and id would fail.
TEST(KernelOpacity, DecisionsAreIndependentOfTheBitInWhichIdsDiffer) {
  constexpr int kLevels = 16;
  const auto keys = path_keys(std::size_t{1} << 20);
  const auto levels = [&](std::uint32_t id) {
    Visible out(keys.size(), kLevels - 1);
    for (int level = 1; level < kLevels; ++level) {
      const Visible below = visible(keys, id, static_cast<float>(level) / kLevels);
      for (std::size_t i = 0; i < keys.size(); ++i) out[i] = static_cast<std::uint8_t>(out[i] - below[i]);
    }
    return out;
  };
  const Visible of_first = levels(0);
  for (std::uint32_t bit = 0; bit < 32; ++bit) {
    const Visible of_other = levels(1u << bit);
    std::vector<std::uint64_t> counts(std::size_t{kLevels} * kLevels);
    for (std::size_t i = 0; i < keys.size(); ++i) ++counts[of_first[i] * std::size_t{kLevels} + of_other[i]];
    EXPECT_LT(std::abs(test::chi_square_of_equal_bins(counts).z), test::kLargestZ) << "bit " << bit;
  }
}

TEST(KernelOpacity, DecisionsOfConsecutiveRaysAreIndependent) {
  const auto keys = path_keys();
  for (std::uint32_t id = 0; id < 40; ++id) {
    const Visible of_rays = quarters(keys, id);
    for (const std::size_t step : {1, 2, 8, 128}) {  // shadow ray, next vertex, next sample, next pixel
      std::vector<std::uint64_t> counts(16);
      for (std::size_t i = 0; i + step < kCount; i += 2 * step)
        for (std::size_t k = 0; k < step && i + step + k < kCount; ++k)
          ++counts[of_rays[i + k] * 4u + of_rays[i + step + k]];
      EXPECT_LT(std::abs(test::chi_square_of_equal_bins(counts).z), test::kLargestZ) << id << ", " << step;
    }
  }
}

}  // namespace
}  // namespace orrery::kernel
