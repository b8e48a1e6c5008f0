// SPDX-License-Identifier: Apache-2.0
#include "film/partial.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "base/error.h"
#include "film/film.h"
#include "film/layer_pixel.h"
#include "kernel/path_record.h"

namespace orrery::film {
namespace {

/// A partial render with a different value in every number.
Partial full_partial(bool is_adaptive, bool goals, bool layers, bool halves, std::size_t light_groups = 1) {
  Partial p(5, 3);
  std::mt19937_64 random(3);
  const auto number = [&] { return static_cast<std::int64_t>(random()); };
  const auto large = [&] { return static_cast<kernel::Int128>(number()) * 0x100000001 + number(); };
  const auto fill = [&](Film& film) {
    for (kernel::PixelSum& s : film.sums()) s = {{large(), -large(), large()}, number()};
  };
  fill(p.film);
  if (is_adaptive) p.add_second_half();
  for (float& v : p.largest) v = static_cast<float>(random() % 1000) / 7;
  fill(p.second);
  for (std::uint32_t& n : p.counts) n = static_cast<std::uint32_t>(random());
  if (goals)
    for (const std::uint32_t n : p.counts) p.goals.push_back(n + 7);
  if (layers) p.layers.resize(15);
  for (LayerPixel& l : p.layers) {
    l.light.resize(light_groups * kernel::kLobes);
    for (auto& cell : l.light)
      for (auto& v : cell) v = large();
    for (auto* vector : {&l.squares, &l.normal, &l.albedo})
      for (auto& v : *vector) v = large();
    for (auto* v : {&l.weight, &l.lit, &l.covered}) *v = number();
    l.depth = static_cast<double>(number());
    l.z = 1 / l.depth;
    for (double& v : l.position) v = static_cast<double>(number());
    l.sphere = static_cast<std::uint32_t>(random());
    for (std::uint32_t s = 0; s < random() % 4; ++s)
      l.shares.push_back({3 * s, number(), {large(), large(), large()}, 0.1 * s, 1e30});
  }
  if (halves) p.halves.resize(15);
  for (Halves& pixel : p.halves)
    for (HalfSums& half : pixel) {
      half.light = {{large(), -large(), large()}, number()};
      half.guides = {large(), number(), {number(), number(), number()}, {number(), number(), number()}};
    }
  p.work = {1ull << 40, 1ull << 50, 3, 12.625};
  return p;
}

TEST(FilmPartialWords, RoundTrip) {
  for (int kind = 0; kind < 16; ++kind) {
    const Partial p = full_partial((kind & 1) != 0, (kind & 2) != 0, (kind & 4) != 0, (kind & 8) != 0);
    const std::vector<std::uint32_t> words = to_words(p);
    const Partial q = from_words(words, 5, 3);
    EXPECT_EQ(to_words(q), words) << kind;
    EXPECT_EQ(q.film.width(), 5);
    EXPECT_EQ(q.film.height(), 3);
    EXPECT_EQ(q.counts, p.counts);
    EXPECT_EQ(q.goals, p.goals);
    EXPECT_EQ(q.largest, p.largest);
    EXPECT_EQ(q.is_adaptive(), p.is_adaptive());
    EXPECT_TRUE(q.film.sums()[7].rgb[1] == p.film.sums()[7].rgb[1]);
    EXPECT_EQ(q.work.seconds, 12.625);
    ASSERT_EQ(q.halves.size(), p.halves.size());
    if (!p.halves.empty()) {
      EXPECT_TRUE(q.halves[14][1].light.rgb[2] == p.halves[14][1].light.rgb[2]);
      EXPECT_TRUE(q.halves[14][1].guides.inverse_depth == p.halves[14][1].guides.inverse_depth);
      EXPECT_EQ(q.halves[3][0].guides.normal[2], p.halves[3][0].guides.normal[2]);
      EXPECT_EQ(q.halves[3][0].guides.weight, p.halves[3][0].guides.weight);
    }
    ASSERT_EQ(q.layers.size(), p.layers.size());
    if (p.layers.empty()) continue;
    EXPECT_EQ(q.layers[3].shares.size(), p.layers[3].shares.size());
    EXPECT_TRUE(q.layers[14].normal[2] == p.layers[14].normal[2]);
    EXPECT_TRUE(q.layers[2].squares[1] == p.layers[2].squares[1]);
    EXPECT_EQ(q.layers[9].position[1], p.layers[9].position[1]);
  }
}

TEST(FilmPartialWords, LightGroupsRoundTrip) {
  Partial p = full_partial(false, false, true, false, 3);
  p.layers[4].light.clear();  // a pixel of another shard
  const std::vector<std::uint32_t> words = to_words(p);
  const Partial q = from_words(words, 5, 3);
  EXPECT_EQ(to_words(q), words);
  ASSERT_EQ(q.layers[14].light.size(), 24u);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_TRUE(q.layers[14].light[i] == p.layers[14].light[i]);
  EXPECT_TRUE(q.layers[4].light[23][2] == 0);
  for (LayerPixel& l : p.layers) l.light.clear();  // layers without light
  EXPECT_TRUE(from_words(to_words(p), 5, 3).layers[14].light.empty());
}

TEST(FilmPartialWords, TruncatedWordsAreRefused) {
  const std::vector<std::uint32_t> words = to_words(full_partial(true, true, true, true));
  for (std::size_t length = 0; length < words.size(); length += 7)
    EXPECT_THROW(from_words({words.begin(), words.begin() + static_cast<std::ptrdiff_t>(length)}, 5, 3), base::Error)
        << length;
}

TEST(FilmPartialWords, TheWrongSizeIsRefused) {
  const std::vector<std::uint32_t> words = to_words(full_partial(false, false, false, false));
  EXPECT_THROW(from_words(words, 3, 5), base::Error);
}

TEST(FilmPartialWords, ConstantPlanesAreStoredAsOneWord) {
  Partial empty(500, 400);
  empty.layers.resize(empty.pixel_count());
  empty.halves.resize(empty.pixel_count());
  EXPECT_LT(to_words(empty).size(), 1000u);
  EXPECT_EQ(to_words(from_words(to_words(empty), 500, 400)), to_words(empty));
}

TEST(FilmPartialWords, InvalidLargestSamplesAreRefused) {
  for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Partial p = full_partial(true, false, false, false);
    p.largest[7] = bad;
    EXPECT_THROW(from_words(to_words(p), 5, 3), base::Error) << bad;
  }
}

TEST(FilmPartialWords, DamagedWordsAreRefusedOrRead) {
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
