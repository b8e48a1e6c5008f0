// SPDX-License-Identifier: Apache-2.0
#include "compile/sphere_store.h"

#include <gtest/gtest.h>
#include <cstdint>
#include <random>

#include <cmath>
#include <vector>

#include "kernel/sphere.h"
#include "scene/scene.h"

namespace orrery::compile {
namespace {

using kernel::Sphere;

SphereStore stored(const std::vector<Sphere>& plain, const std::vector<Sphere>& points) {
  SphereStore store;
  for (const Sphere& s : plain) store.push_back(s);
  scene::Points set;
  for (const Sphere& s : points) {
    set.centers.push_back({s.x, s.y, s.z});
    set.radii.push_back(s.radius);
  }
  const std::size_t before = store.bytes();
  store.append({&set, 1});
  EXPECT_EQ(store.bytes() - before, SphereStore::bytes_of({&set, 1}));
  return store;
}

void expect_holds(const SphereStore& store, const std::vector<Sphere>& plain, const std::vector<Sphere>& points) {
  ASSERT_EQ(store.size(), plain.size() + points.size());
  for (std::size_t i = 0; i < store.size(); ++i) {
    const Sphere want = i < plain.size() ? plain[i] : points[i - plain.size()], is = store[i];
    EXPECT_EQ(is.x, want.x) << i;
    EXPECT_EQ(is.y, want.y) << i;
    EXPECT_EQ(is.z, want.z) << i;
    EXPECT_EQ(is.radius, want.radius) << i;
  }
}

const std::vector<Sphere> kPlain = {{0.1, 0.2, 0.3, 0.4}, {1, 2, 3, 4}};

TEST(CompileSphereStore, OneRadiusAndSinglePrecisionTakeTwelveBytes) {
  const std::vector<Sphere> points = {
      {1, -0.5, 0.25, 0.1}, {2, 3, 0x1p-140, 0.1}, {static_cast<double>(0.1F), 0, -0.0, 0.1}};
  const SphereStore store = stored(kPlain, points);
  expect_holds(store, kPlain, points);
  EXPECT_EQ(store.bytes(), 2 * sizeof(Sphere) + 3 * 12) << "the common radius may be any double";
  EXPECT_TRUE(std::signbit(store[4].z));
}

TEST(CompileSphereStore, SharesTheCentresOfASingleFile) {
  std::vector<scene::Points> points(2);
  for (int i = 0; i < 100; ++i) points[1].centers.push_back({i + 0.5, 2, 3});
  points[1].radii.assign(100, 0.1);
  SphereStore store;
  store.append(points);
  EXPECT_EQ(SphereStore::bytes_of(points), 0u);
  EXPECT_EQ(store.view().centers, points[1].centers.numbers().singles()->data());
  points[1].centers.set(7, {9, 9, 9});
  EXPECT_EQ(store[7].x, 7.5);
}

/// Spheres with so many different radii that these are not stored as indices.
std::vector<Sphere> with_many_radii(double step) {
  std::vector<Sphere> out;
  for (int i = 1; i <= 100; ++i) out.push_back({1, 2, 3, i * step});
  return out;
}

TEST(CompileSphereStore, FewDifferentRadiiTakeOneByteMore) {
  const std::vector<Sphere> points = {{1, 2, 3, 0.1}, {4, 5, 6, 0.25}, {7, 8, 9, 0.1}};
  const SphereStore store = stored(kPlain, points);
  expect_holds(store, kPlain, points);
  EXPECT_EQ(store.bytes(), 2 * sizeof(Sphere) + 3 * 13) << "the radii may be any doubles";
}

/// Sets share a palette of up to 256 radii, without signs.
TEST(CompileSphereStore, SetsShareTheirRadii) {
  for (const int sets : {1, 3, 16, 17}) {
    std::vector<scene::Points> points(static_cast<std::size_t>(sets));
    std::vector<Sphere> want;
    for (int i = 0; i < 16 * sets; ++i) {
      scene::Points& set = points[static_cast<std::size_t>(i / 16)];
      set.centers.push_back({1, 2, 3});
      set.radii.push_back(i % 2 == 0 ? 0.1 + i : -0.25 - i);
      want.push_back({1, 2, 3, std::abs(set.radii[set.radii.size() - 1])});
    }
    points.push_back({});
    points.back().centers.push_back({1, 2, 3});
    points.back().radii.push_back(0.1);
    want.push_back({1, 2, 3, 0.1});
    SphereStore store;
    store.append(points);
    expect_holds(store, {}, want);
    EXPECT_EQ(store.bytes(), want.size() * (sets <= 16 ? 13 : sizeof(Sphere))) << sets;
  }
}

TEST(CompileSphereStore, RadiiInSinglePrecisionTakeFourBytesMore) {
  const std::vector<Sphere> points = with_many_radii(0.25);
  const SphereStore store = stored(kPlain, points);
  expect_holds(store, kPlain, points);
  EXPECT_EQ(store.bytes(), 2 * sizeof(Sphere) + points.size() * 16);
}

TEST(CompileSphereStore, ValuesThatSinglePrecisionWouldChangeStayDouble) {
  for (const std::vector<Sphere>& points : {std::vector<Sphere>{{1, 2, 3, 0.5}, {0.1, 5, 6, 0.5}},
                                            {{1, 2, 3, 0.5}, {4, 5, 1e300, 0.5}},
                                            with_many_radii(0.1)}) {
    const SphereStore store = stored(kPlain, points);
    expect_holds(store, kPlain, points);
    EXPECT_EQ(store.bytes(), (2 + points.size()) * sizeof(Sphere));
    EXPECT_TRUE(store.view().all_plain());
  }
}

TEST(CompileSphereStore, MayBeEmpty) {
  EXPECT_TRUE(stored({}, {}).empty());
  expect_holds(stored({}, {{1, 2, 3, 4}}), {}, {{1, 2, 3, 4}});
}

constexpr std::size_t kPadding = 3;

PackedIndices packed(const std::vector<std::uint32_t>& indices) {
  PackedIndices out;
  for (const std::uint32_t i : indices) out.push_back(i);
  return out;
}

TEST(CompileSphereStore, EqualIndicesTakeNoBytesEach) {
  for (const std::uint32_t index : {0u, 7u, 70'000u, 0xffffffffu}) {
    const PackedIndices indices = packed(std::vector<std::uint32_t>(1000, index));
    EXPECT_EQ(indices.size(), 1000u);
    EXPECT_EQ(indices.bytes(), 4u);
    EXPECT_EQ(indices[999], index);
  }
}

TEST(CompileSphereStore, OthersTakeAsManyAsTheLargest) {
  EXPECT_EQ(packed({0, 255, 3}).bytes(), 3 + kPadding);
  EXPECT_EQ(packed({0, 256, 3}).bytes(), 6 + kPadding);
  EXPECT_EQ(packed({65'535, 0}).bytes(), 4 + kPadding) << "the first is the largest";
  EXPECT_EQ(packed({0, 65'536}).bytes(), 8 + kPadding);
  EXPECT_EQ(packed({0xffffffffu, 0}).bytes(), 8 + kPadding);
}

TEST(CompileSphereStore, WideningKeepsThem) {
  std::mt19937 random(1);
  for (int run = 0; run < 200; ++run) {
    std::vector<std::uint32_t> want;
    PackedIndices indices;
    for (int i = 0; i < 300; ++i) {
      want.push_back(static_cast<std::uint32_t>(random() >> (8 + random() % 24)));
      if (i % 100 == 99) want.back() = static_cast<std::uint32_t>(random());
      indices.push_back(want.back());
    }
    for (std::size_t i = 0; i < want.size(); ++i) ASSERT_EQ(indices[i], want[i]) << run << ' ' << i;
  }
}

}  // namespace
}  // namespace orrery::compile
