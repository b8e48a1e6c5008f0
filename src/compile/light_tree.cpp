// SPDX-License-Identifier: Apache-2.0
#include "compile/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace orrery::compile {
namespace {

using kernel::LightNode;
using kernel::LightRange;
using kernel::Lights;

/// Rounding may make a bounding sphere this much too small, relative to its radius.
constexpr double kRounding = 1 + 0x1p-45;

/// The smallest sphere around two spheres.
LightNode merged(const LightNode& a, const LightNode& b) {
  const double between[3] = {b.center[0] - a.center[0], b.center[1] - a.center[1], b.center[2] - a.center[2]};
  const double distance = std::sqrt((between[0] * between[0] + between[1] * between[1]) + between[2] * between[2]);
  LightNode out = a.radius >= b.radius ? a : b;
  out.power = a.power + b.power;
  if (distance + std::min(a.radius, b.radius) <= out.radius) return out;
  out.radius = (a.radius + b.radius + distance) / 2;
  const double share = (out.radius - a.radius) / distance;
  for (int k = 0; k < 3; ++k) out.center[k] = a.center[k] + between[k] * share;
  out.radius *= kRounding;
  return out;
}

/// Spreads the low 21 bits: bit i moves to bit 3i.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffff;
  v = (v | v << 16) & 0x001f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

class Builder {
 public:
  Builder(const kernel::SceneView& scene, LightTree& tree) : scene_(scene), tree_(tree) {}

  void build() {
    sort_leaves();
    tree_.nodes.resize(tree_.spheres.size());
    if (!tree_.spheres.empty()) fill({0, static_cast<std::uint32_t>(tree_.spheres.size())});
  }

 private:
  /// Sorts the leaves along the Morton curve through their bounding cube.
  void sort_leaves() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double lower[3] = {kInfinity, kInfinity, kInfinity}, extent = 0;
    const auto center = [&](std::uint32_t id, int k) { return (&scene_.spheres[id].x)[k]; };
    for (int k = 0; k < 3; ++k) {
      double upper = -kInfinity;
      for (const std::uint32_t id : tree_.spheres) {
        lower[k] = std::min(lower[k], center(id, k));
        upper = std::max(upper, center(id, k));
      }
      extent = std::max(extent, upper - lower[k]);
    }
    constexpr double kCells = 0x1p21 - 1;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(tree_.spheres.size());
    for (const std::uint32_t id : tree_.spheres) {
      std::uint64_t code = 0;
      for (int k = 0; k < 3; ++k) {
        const double at = extent > 0 ? (center(id, k) - lower[k]) / extent : 0;
        code |= spread(static_cast<std::uint64_t>(at * kCells)) << k;
      }
      order.emplace_back(code, id);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i) tree_.spheres[i] = order[i].second;
  }

  LightNode fill(LightRange range) {
    if (range.end - range.begin == 1) return kernel::light_leaf(scene_, tree_.spheres[range.begin]);
    const std::uint32_t middle = Lights::middle(range);
    const LightNode left = fill({range.begin, middle});
    return tree_.nodes[middle] = merged(left, fill({middle, range.end}));
  }

  const kernel::SceneView& scene_;
  LightTree& tree_;
};

}  // namespace

Lights LightTree::view() const noexcept {
  Lights out;
  out.spheres = spheres.data();
  out.nodes = nodes.data();
  out.leaves = leaves.data();
  out.first_sphere = first_sphere;
  out.end_sphere = first_sphere + static_cast<std::uint32_t>(leaves.size());
  out.count = static_cast<std::uint32_t>(spheres.size());
  return out;
}

std::size_t LightTree::bytes() const noexcept {
  return spheres.size() * sizeof(spheres[0]) + nodes.size() * sizeof(nodes[0]) + leaves.size() * sizeof(leaves[0]);
}

LightTree build_light_tree(const kernel::SceneView& scene) {
  LightTree tree;
  for (std::uint32_t id = 0; id < scene.sphere_count; ++id) {
    const double* const rgb = scene.emission[scene.sphere_materials[id]].radiance;
    if (rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0) tree.spheres.push_back(id);
  }
  if (tree.spheres.empty()) return tree;
  tree.first_sphere = tree.spheres.front();
  tree.leaves.assign(tree.spheres.back() - tree.first_sphere + 1, Lights::kNoLeaf);
  Builder(scene, tree).build();
  for (std::uint32_t leaf = 0; leaf < tree.spheres.size(); ++leaf)
    tree.leaves[tree.spheres[leaf] - tree.first_sphere] = leaf;
  return tree;
}

}  // namespace orrery::compile
