// SPDX-License-Identifier: Apache-2.0
#include "compile/sphere_store.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace orrery::compile
