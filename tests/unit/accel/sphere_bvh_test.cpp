// SPDX-License-Identifier: Apache-2.0
// The bounds of a SphereBvh: whatever a ray may hit lies within them. Rods are in it as the spheres that enclose them.
#include "accel/sphere_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

#include "accel/box_frame.h"
#include "base/error.h"
#include "support/accel_rays.h"

namespace orrery::accel {
namespace {

using kernel::Rod;
using kernel::Sphere;
using test::Random;

std::vector<std::uint32_t> all_of(const std::vector<Sphere>& spheres) {
  std::vector<std::uint32_t> ids(spheres.size());
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

struct Tree {
  std::vector<Sphere> spheres;
  std::vector<Rod> rods;
  BoundedRods bounded;
  std::vector<Sphere> objects;  ///< the spheres, then those that enclose the rods
  BoxFrame frame;
  SphereBvh bvh;

  explicit Tree(std::vector<Sphere> of, std::vector<Rod> and_rods = {})
      : spheres(std::move(of)),
        rods(std::move(and_rods)),
        bounded{{rods.data(), rods.size(), nullptr, 0, spheres.size()}},
        objects(spheres),
        frame(spheres.data(), all_of(spheres), bounded) {
    std::vector<std::uint32_t> ids = all_of(spheres);
    for (std::size_t i = 0; i < rods.size(); ++i) {
      ids.push_back(bounded.rods.id(i));
      objects.push_back(enclosing_sphere(rods[i]));
    }
    bvh = SphereBvh(spheres.data(), ids, frame, {}, bounded);
  }

  double in_box(double world, int axis) const { return (world - frame.middle[axis]) * frame.scale; }
  double center(std::size_t object, int axis) const {
    const Sphere& s = objects[object];
    return in_box(axis == 0 ? s.x : axis == 1 ? s.y : s.z, axis);
  }
  double radius(std::size_t object) const { return objects[object].radius * frame.scale; }

  /// Calls f(object) for each sphere or rod below a node or leaf.
  template <class F>
  void each_below(std::uint32_t reference, F f) const {
    if ((reference & SphereBvh::kLeafBit) != 0) {
      const std::uint32_t leaf = reference & ~SphereBvh::kLeafBit;
      for (unsigned i = 0; i < bvh.count_in(leaf); ++i) f(bounded.rods.object(bvh.leaves[leaf].ids[i]));
      return;
    }
    const SphereBvh::Node& node = bvh.nodes[reference];
    for (std::uint32_t i = 0; i < node.count; ++i) each_below(node.first + i, f);
  }
};

std::vector<Tree> trees() {
  Random random;
  std::vector<Tree> out;
  out.emplace_back(std::vector<Sphere>{{1, 2, 3, 4}});
  out.emplace_back(std::vector<Sphere>(300, {0.1, 0.2, 0.3, 0.01}));  // all centres coincide
  out.emplace_back(test::scattered(random, 17, 1, 0.5, 0));
  out.emplace_back(test::scattered(random, 256, 1e-12, 1e-13, 0));
  out.emplace_back(test::scattered(random, 70'000, 1e6, 1e4, 1e9));
  std::vector<Sphere> flat = test::scattered(random, 5000, 1, 0.01, 0);
  for (Sphere& s : flat) s.y = 0, s.radius = 0.01;
  out.emplace_back(flat);
  out.emplace_back(test::scattered(random, 1000, 1, 0.02, 0), test::random_rods(random, 1500, 0.1, 0.01));
  out.emplace_back(std::vector<Sphere>{}, test::random_rods(random, 40, 0.5, 0.001));
  return out;
}

/// The ends of rods, with what is needed around them.
TEST(AccelSphereBvh, LeavesHoldTheAxesOfRods) {
  long rods = 0;
  for (const Tree& tree : trees())
    for (std::uint32_t l = 0; l < tree.bvh.rods.size(); ++l) {
      const SphereBvh::LeafRods& leaf = tree.bvh.rods[l];
      for (unsigned i = 0; i < tree.bvh.count_in(l); ++i) {
        const std::uint32_t id = tree.bvh.leaves[l].ids[i];
        ASSERT_EQ((leaf.rods >> i & 1u) != 0, tree.bounded.rods.contains(id));
        if (!tree.bounded.rods.contains(id)) continue;
        ++rods;
        const Rod& rod = tree.rods[tree.bounded.rods.index(id)];
        double square = 0;
        for (int axis = 0; axis < 3; ++axis)
          square += std::pow((rod.b[axis] - rod.a[axis]) / 2 * tree.frame.scale -
                                 static_cast<double>(leaf.half[axis][i]) * static_cast<double>(leaf.step),
                             2);
        EXPECT_LE(std::sqrt(square), 0.87 * leaf.step);
        EXPECT_GE(leaf.radius, rod.radius * tree.frame.scale);
        EXPECT_LE(leaf.least_radius, rod.radius * tree.frame.scale);
      }
    }
  EXPECT_EQ(rods, 1540);
}

/// At any time, a sphere is where its leaf says, with the margin that rays use.
TEST(AccelSphereBvh, LeavesHoldThePathsOfMovingSpheres) {
  Random random;
  const std::vector<Sphere> spheres = test::scattered(random, 500, 1, 0.05, 0);
  std::vector<Sphere> motion = test::scattered(random, 500, 0.05, 0, 0);
  for (Sphere& change : motion) change.radius = 0;
  const BoundedSpheres moving(spheres.data(), false, motion.data(), motion.size());
  const BoxFrame frame(moving, all_of(spheres));
  const SphereBvh bvh(moving, all_of(spheres), frame);
  ASSERT_TRUE(bvh.moves);
  ASSERT_EQ(bvh.rods.size(), bvh.leaves.size());
  for (std::uint32_t l = 0; l < bvh.leaves.size(); ++l)
    for (unsigned i = 0; i < bvh.count_in(l); ++i)
      for (const double time : {0.0, 0.3, 1.0}) {
        const SphereBvh::Leaf& leaf = bvh.leaves[l];
        const Sphere& s = spheres[leaf.ids[i]];
        const Sphere& change = motion[leaf.ids[i]];
        const double at[3] = {s.x + change.x * time, s.y + change.y * time, s.z + change.z * time};
        double square = 0;
        for (int axis = 0; axis < 3; ++axis)
          square += std::pow((at[axis] - frame.middle[axis]) * frame.scale - double{leaf.origin[axis]} -
                                 double{leaf.step} * leaf.center[axis][i] -
                                 double{bvh.rods[l].step} * bvh.rods[l].half[axis][i] * (2 * time - 1),
                             2);
        EXPECT_LE(std::sqrt(square), 0.875 * leaf.step + 0.876 * bvh.rods[l].step);
        const bool is_one = bvh.radii.empty();
        const float step = is_one ? 0 : bvh.radii[l].step;
        const float most = is_one ? bvh.radius : step * static_cast<float>(bvh.radii[l].radius[i]);
        EXPECT_GE(most, s.radius * frame.scale);
        EXPECT_LE(most, s.radius * frame.scale * 1.0001 + double{step}) << "not larger";
      }
}

TEST(AccelSphereBvh, EverySphereIsInOneLeafAndBelowItsStartNode) {
  for (const Tree& tree : trees()) {
    std::vector<int> seen(tree.objects.size(), 0);
    tree.each_below(tree.bvh.root(), [&](std::size_t object) { ++seen[object]; });
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(seen.size()));
    for (std::size_t object = 0; object < seen.size(); ++object) {
      bool found = false;
      tree.each_below(tree.bvh.start_node(object), [&](std::size_t other) { found = found || other == object; });
      EXPECT_TRUE(found) << object;
    }
  }
}

/// A build sorts ids first, then the spheres of one part after another.
TEST(AccelSphereBvh, DoesNotDependOnTheSizeOfParts) {
  for (const Tree& tree : trees())
    for (const std::size_t part : {256u, 4096u}) {
      std::vector<std::uint32_t> ids = all_of(tree.spheres);
      for (std::size_t i = 0; i < tree.rods.size(); ++i) ids.push_back(tree.bounded.rods.id(i));
      const SphereBvh other(tree.spheres.data(), ids, tree.frame, {}, tree.bounded, part);
      const auto is_same = [](const auto& a, const auto& b) {
        return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
      };
      EXPECT_TRUE(is_same(other.leaves, tree.bvh.leaves));
      EXPECT_TRUE(is_same(other.radii, tree.bvh.radii));
      EXPECT_TRUE(is_same(other.rods, tree.bvh.rods));
      EXPECT_TRUE(is_same(other.nodes, tree.bvh.nodes));
      EXPECT_TRUE(is_same(other.cells, tree.bvh.cells));
      EXPECT_EQ(other.level_begin, tree.bvh.level_begin);
      for (std::size_t object = 0; object < tree.objects.size(); ++object)
        ASSERT_EQ(other.start_node(object), tree.bvh.start_node(object));
    }
}

/// Memory of ids is released after each part of a million.
TEST(AccelSphereBvh, PartsOfABuildAreReleasedWhenTheyAreFinished) {
  Random random;
  const Tree tree(test::scattered(random, (1 << 20) + 1000, 1, 0.01, 0));
  std::vector<std::uint8_t> seen(tree.spheres.size(), 0);
  for (std::uint32_t l = 0; l < tree.bvh.leaves.size(); ++l)
    for (unsigned i = 0; i < tree.bvh.count_in(l); ++i) {
      const SphereBvh::Leaf& leaf = tree.bvh.leaves[l];
      ASSERT_LT(leaf.ids[i], seen.size());
      ++seen[leaf.ids[i]];
      ASSERT_NEAR(static_cast<double>(leaf.origin[0] + static_cast<float>(leaf.center[0][i]) * leaf.step),
                  tree.center(leaf.ids[i], 0), static_cast<double>(leaf.step));
    }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(seen.size()));
}

/// Codes are decoded as the traversal does, in single precision.
TEST(AccelSphereBvh, LeavesHoldCentresAndRadii) {
  for (const Tree& tree : trees())
    for (std::uint32_t l = 0; l < tree.bvh.leaves.size(); ++l) {
      const SphereBvh::Leaf& leaf = tree.bvh.leaves[l];
      for (unsigned i = 0; i < tree.bvh.count_in(l); ++i) {
        const std::size_t id = tree.bounded.rods.object(leaf.ids[i]);
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const double decoded = std::fma(static_cast<double>(leaf.center[axis][i]), static_cast<double>(leaf.step),
                                          static_cast<double>(leaf.origin[axis]));
          square += std::pow(decoded - tree.center(id, axis), 2);
        }
        EXPECT_LE(std::sqrt(square), 0.87 * leaf.step + 8 * 0x1p-24 * tree.frame.reach);
        const double radius = tree.bvh.radii.empty()
                                  ? static_cast<double>(tree.bvh.radius)
                                  : static_cast<double>(tree.bvh.radii[l].radius[i]) * tree.bvh.radii[l].step;
        EXPECT_GE(radius * (1 + 0x1p-23), tree.radius(id));
        const double least = tree.bvh.radii.empty() ? radius : radius - static_cast<double>(tree.bvh.radii[l].step);
        EXPECT_LE(least * (1 - 0x1p-23), tree.radius(id));
      }
    }
}

TEST(AccelSphereBvh, BoxesEnclosePaddedSpheres) {
  for (const Tree& tree : trees()) {
    // The derived bound of the rounding errors of a ray against a box, in units of the frame's reach.
    const double needed = 19 * 0x1p-24 * tree.frame.reach;
    for (const SphereBvh::Node& node : tree.bvh.nodes)
      for (std::uint32_t child = 0; child < node.count; ++child)
        tree.each_below(node.first + child, [&](std::size_t object) {
          for (int axis = 0; axis < 3; ++axis) {
            double lower = tree.center(object, axis) - tree.radius(object), upper = lower + 2 * tree.radius(object);
            if (object >= tree.spheres.size()) {
              const Rod& rod = tree.rods[object - tree.spheres.size()];
              const double a = tree.in_box(rod.a[axis], axis), b = tree.in_box(rod.b[axis], axis);
              lower = std::min(a, b) - rod.radius * tree.frame.scale;
              upper = std::max(a, b) + rod.radius * tree.frame.scale;
            }
            const auto bound = [&](int side) {
              return static_cast<double>(node.origin[axis]) +
                     static_cast<double>(node.bound[side][axis][child]) * static_cast<double>(node.step[axis]);
            };
            EXPECT_LE(bound(0), lower - needed);
            EXPECT_GE(bound(1), upper + needed);
          }
        });
  }
}

TEST(AccelSphereBvh, NoOtherSphereReachesIntoACell) {
  for (const Tree& tree : trees()) {
    long cells = 0;
    for (std::uint32_t n = 0; n < tree.bvh.nodes.size(); ++n) {
      const SphereBvh::Cell& cell = tree.bvh.cells[n];
      if (!(cell.lower[0] <= cell.upper[0] && cell.lower[1] <= cell.upper[1] && cell.lower[2] <= cell.upper[2]))
        continue;
      ++cells;
      std::vector<bool> own(tree.objects.size(), false);
      tree.each_below(n, [&](std::size_t object) { own[object] = true; });
      for (std::size_t id = 0; id < own.size(); ++id) {
        if (own[id]) continue;
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const double at = tree.center(id, axis);
          const double nearest =
              std::clamp(at, static_cast<double>(cell.lower[axis]), static_cast<double>(cell.upper[axis]));
          square += (at - nearest) * (at - nearest);
        }
        ASSERT_GT(std::sqrt(square), tree.radius(id) + 19 * 0x1p-24 * tree.frame.reach) << n;
      }
    }
    EXPECT_GE(cells, 1) << "the root's cell is everything";
  }
}

TEST(AccelSphereBvh, TakesFewBytes) {
  Random random;
  std::vector<Sphere> spheres = test::scattered(random, 100'000, 1, 0.01, 0);
  const Tree own(spheres);
  for (Sphere& s : spheres) s.radius = 0.01;
  const Tree one(spheres);
  EXPECT_LT(static_cast<double>(one.bvh.bytes()), 13.0 * static_cast<double>(spheres.size()));
  EXPECT_LT(static_cast<double>(own.bvh.bytes()), 14.5 * static_cast<double>(spheres.size()));
}

/// Both while ids are sorted and while parts are.
TEST(AccelSphereBvh, BuildsCanBeStopped) {
  Random random;
  const Tree tree(test::scattered(random, 20'000, 1, 0.01, 0));
  for (const int calls_before : {1, 10}) {
    double last = 0;
    int calls = 0;
    const auto monitor = [&](double fraction) {
      last = std::max(last, fraction);
      return ++calls < calls_before;
    };
    try {
      SphereBvh(tree.spheres.data(), all_of(tree.spheres), tree.frame, monitor, {}, 4096);
      FAIL() << "the build was not stopped";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kStopped);
    }
    EXPECT_EQ(last > 0, calls_before > 1);
    EXPECT_LT(last, 0.5);
  }
}

}  // namespace
}  // namespace orrery::accel
