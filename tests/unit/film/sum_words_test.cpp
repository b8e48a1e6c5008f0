// SPDX-License-Identifier: Apache-2.0
#include "film/sums.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "base/error.h"

namespace orrery::film {
namespace {

/// Requests layers that need every array.
LayerRequest every_layer(std::size_t light_groups = 1) {
  LayerRequest r;
  r.z = r.normal = r.position = r.albedo = r.variance = r.coverage = r.deep = true;
  r.light_groups = true;
  r.groups.assign(light_groups, {"g", true, true});
  return r;
}

/// Sums with a different value in every number.
Sums full_partial(bool is_adaptive, bool goals, bool layers, bool halves, std::size_t light_groups = 1) {
  LayerRequest request = layers ? every_layer(light_groups) : LayerRequest{};
  request.halves = halves;
  Sums p(5, 3, request, is_adaptive);
  std::mt19937_64 random(3);
  const auto number = [&] { return static_cast<std::int64_t>(random()); };
  const auto count = [&] { return static_cast<std::uint32_t>(random()); };
  const auto large = [&] { return static_cast<kernel::Int128>(number()) * 0x100000001 + number(); };
  for (auto& sums : p.light)
    for (kernel::PixelSum& s : sums) s = {{large(), -large(), large()}, count()};
  for (auto& sums : p.guides)
    for (kernel::GuideSum& s : sums)
      s = {large(), number(), {number(), number(), number()}, {number(), number(), number()}};
  for (float& v : p.largest) v = static_cast<float>(random() % 1000) / 7;
  for (std::uint32_t& n : p.counts) n = count();
  if (goals)
    for (const std::uint32_t n : p.counts) p.goals.push_back(n + 7);
  LayerSums& l = p.layers;
  for (auto* sums : {&l.light, &l.squares, &l.normal, &l.albedo})
    for (auto& channels : *sums)
      for (auto& v : channels) v = large();
  for (auto& v : l.covered) v = number();
  for (auto& v : l.hit) v = count();
  for (double& v : l.depth) v = static_cast<double>(number());
  for (float& v : l.z) v = 1 / static_cast<float>(number());
  for (auto& at : l.position)
    for (float& v : at) v = static_cast<float>(number());
  for (auto& shares : l.shares)
    for (std::uint32_t s = 0; s < random() % 4; ++s)
      shares.push_back({3 * s, number(), {large(), large(), large()}, 0.1 * s, 1e30});
  p.work = {1ull << 40, 1ull << 50, 3, 12.625};
  return p;
}

TEST(FilmSumWords, RoundTrip) {
  for (int kind = 0; kind < 16; ++kind) {
    const Sums p = full_partial((kind & 1) != 0, (kind & 2) != 0, (kind & 4) != 0, (kind & 8) != 0);
    const std::vector<std::uint32_t> words = to_words(p);
    const Sums q = from_words(words, 5, 3);
    EXPECT_EQ(to_words(q), words) << kind;
    EXPECT_EQ(q.width, 5);
    EXPECT_EQ(q.height, 3);
    EXPECT_TRUE(q.has_arrays_of(p) && p.has_arrays_of(q));
    EXPECT_EQ(q.counts, p.counts);
    EXPECT_EQ(q.goals, p.goals);
    EXPECT_EQ(q.largest, p.largest);
    EXPECT_EQ(q.is_adaptive(), p.is_adaptive());
    EXPECT_TRUE(q.light[0][7].rgb[1] == p.light[0][7].rgb[1]);
    EXPECT_EQ(q.work.seconds, 12.625);
    if (p.has_halves()) {
      EXPECT_TRUE(q.light[1][14].rgb[2] == p.light[1][14].rgb[2]);
    }
    if (!p.guides[0].empty()) {
      EXPECT_TRUE(q.guides[1][14].inverse_depth == p.guides[1][14].inverse_depth);
      EXPECT_EQ(q.guides[0][3].normal[2], p.guides[0][3].normal[2]);
      EXPECT_EQ(q.guides[0][3].weight, p.guides[0][3].weight);
    }
    if (p.layers.hit.empty()) continue;
    EXPECT_EQ(q.layers.shares[3].size(), p.layers.shares[3].size());
    EXPECT_TRUE(q.layers.normal[14][2] == p.layers.normal[14][2]);
    EXPECT_TRUE(q.layers.squares[2][1] == p.layers.squares[2][1]);
    EXPECT_EQ(q.layers.position[9][1], p.layers.position[9][1]);
    EXPECT_EQ(q.layers.depth, p.layers.depth);
  }
}

TEST(FilmSumWords, LightGroupsRoundTrip) {
  Sums p = full_partial(false, false, true, false, 3);
  for (std::size_t cell = 0; cell < 24; ++cell) p.layers.light[4 * 24 + cell] = {};  // a pixel of another shard
  const std::vector<std::uint32_t> words = to_words(p);
  const Sums q = from_words(words, 5, 3);
  EXPECT_EQ(to_words(q), words);
  ASSERT_EQ(q.layers.light.size(), 15 * 24u);
  EXPECT_TRUE(q.layers.light == p.layers.light);
}

TEST(FilmSumWords, TruncatedWordsAreRefused) {
  const std::vector<std::uint32_t> words = to_words(full_partial(true, true, true, true));
  for (std::size_t length = 0; length < words.size(); length += 7)
    EXPECT_THROW(from_words({words.begin(), words.begin() + static_cast<std::ptrdiff_t>(length)}, 5, 3), base::Error)
        << length;
}

TEST(FilmSumWords, TheWrongSizeIsRefused) {
  const std::vector<std::uint32_t> words = to_words(full_partial(false, false, false, false));
  EXPECT_THROW(from_words(words, 3, 5), base::Error);
}

TEST(FilmSumWords, ConstantPlanesAreStoredAsOneWord) {
  const Sums empty(500, 400, every_layer());
  EXPECT_LT(to_words(empty).size(), 1000u);
  EXPECT_EQ(to_words(from_words(to_words(empty), 500, 400)), to_words(empty));
}

TEST(FilmSumWords, InvalidLargestSamplesAreRefused) {
  for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Sums p = full_partial(true, false, false, false);
    p.largest[7] = bad;
    EXPECT_THROW(from_words(to_words(p), 5, 3), base::Error) << bad;
  }
}

TEST(FilmSumWords, DamagedWordsAreRefusedOrRead) {
  const std::vector<std::uint32_t> words = to_words(full_partial(true, true, true, true));
  std::minstd_rand random(5);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint32_t> damaged = words;
    damaged[i < 64 ? static_cast<std::size_t>(i) % 12 : random() % words.size()] ^= 1u << random() % 32;
    try {
      from_words(damaged, 5, 3);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace orrery::film
