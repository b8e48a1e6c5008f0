// SPDX-License-Identifier: Apache-2.0
#include "compile/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "kernel/scene_view.h"
#include "math/scalar.h"

namespace orrery::compile {
namespace {

using kernel::LightNode;
using kernel::LightRange;
using kernel::Lights;

/// Maximum relative error by which rounding makes a bounding sphere too small.
constexpr double kRounding = 1 + 0x1p-45;

/// A leaf while the tree is built.
struct Leaf {
  LightNode node;
  std::uint32_t sphere;
};

/// Sorts leaves so that halves of every range are separated along its longest axis, and computes the nodes.
class Builder {
 public:
  Builder(const kernel::SceneView& scene, LightTree& tree) : scene_(scene), tree_(tree) {
    leaves_.reserve(tree.spheres.size());
    for (const std::uint32_t id : tree.spheres) leaves_.push_back({kernel::light_leaf(scene, id), id});
  }

  void build() {
    tree_.nodes.resize(leaves_.size());
    if (leaves_.size() <= Lights::kFew) {
      for (std::size_t i = 0; i < leaves_.size(); ++i) tree_.nodes[i] = leaves_[i].node;
      return;
    }
    divide({0, static_cast<std::uint32_t>(leaves_.size())});
    for (std::size_t i = 0; i < leaves_.size(); ++i) tree_.spheres[i] = leaves_[i].sphere;
  }

 private:
  /// Returns the power of the range. Nothing depends on the order in which the library leaves the halves.
  double divide(LightRange range) {
    if (range.end - range.begin == 1) return leaves_[range.begin].node.power;
    const std::uint32_t middle = Lights::middle(range);
    const auto begin = leaves_.begin() + range.begin, end = leaves_.begin() + range.end;
    LightNode& node = tree_.nodes[middle];
    int longest = 0;
    double extent = -1;
    for (int k = 0; k < 3; ++k) {
      double lower = math::kInfinity, upper = -math::kInfinity;
      for (auto leaf = begin; leaf != end; ++leaf) {
        lower = std::min(lower, leaf->node.center[k] - leaf->node.radius);
        upper = std::max(upper, leaf->node.center[k] + leaf->node.radius);
      }
      node.center[k] = lower + (upper - lower) / 2;
      if (upper - lower > extent) {
        extent = upper - lower;
        longest = k;
      }
    }
    node.radius = 0;
    for (auto leaf = begin; leaf != end; ++leaf) {
      double square = 0;
      for (int k = 0; k < 3; ++k) {
        const double away = leaf->node.center[k] - node.center[k];
        square += away * away;
      }
      node.radius = std::max(node.radius, std::sqrt(square) + leaf->node.radius);
    }
    node.radius *= kRounding;
    std::nth_element(begin, leaves_.begin() + middle, end, [longest](const Leaf& a, const Leaf& b) {
      return a.node.center[longest] != b.node.center[longest] ? a.node.center[longest] < b.node.center[longest]
                                                              : a.sphere < b.sphere;
    });
    const double power = divide({range.begin, middle});
    return node.power = power + divide({middle, range.end});
  }

  const kernel::SceneView& scene_;
  LightTree& tree_;
  std::vector<Leaf> leaves_;
};

/// Builds the lookup of leaves by object.
void index_leaves(LightTree& tree) {
  tree.leaves.resize(tree.spheres.size());
  std::iota(tree.leaves.begin(), tree.leaves.end(), 0U);
  std::sort(tree.leaves.begin(), tree.leaves.end(),
            [&](std::uint32_t a, std::uint32_t b) { return tree.spheres[a] < tree.spheres[b]; });
}

/// Whether a sphere or half of a rod emits.
bool is_lamp(const kernel::SceneView& scene, std::uint32_t id) {
  if (scene.opacity != nullptr && scene.opacity[id] == 0) return false;
  const double* const rgb = scene.emission[scene.object_materials[id]].radiance;
  return (rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0) && !scene.is_duplicate(id);
}

/// Appends the halves of rods that emit.
void add_rods(const kernel::SceneView& scene, std::vector<std::uint32_t>& ids) {
  const kernel::RodArray& rods = scene.rods;
  for (std::size_t i = 0; i < rods.count; ++i) {
    if (is_lamp(scene, rods.id(i))) ids.push_back(rods.id(i));
    const kernel::Rod rod = rods[i];
    const bool has_second_half = rods.moves(i) || !std::equal(rod.a, rod.a + 3, rod.b);
    if (has_second_half && is_lamp(scene, rods.id(i) + 1)) ids.push_back(rods.id(i) + 1);
  }
}

}  // namespace

Lights LightTree::view() const noexcept {
  Lights out;
  out.spheres = spheres.data();
  out.nodes = nodes.data();
  out.leaves = leaves.data();
  out.count = static_cast<std::uint32_t>(spheres.size());
  return out;
}

std::size_t LightTree::bytes() const noexcept {
  return spheres.size() * sizeof(spheres[0]) + nodes.size() * sizeof(nodes[0]) + leaves.size() * sizeof(leaves[0]);
}

std::size_t LightTree::bytes_of_build() const noexcept { return bytes() + spheres.size() * sizeof(Leaf); }

LightTree build_light_tree(const kernel::SceneView& scene) {
  LightTree tree;
  for (std::uint32_t id = 0; id < scene.sphere_count; ++id)
    if (is_lamp(scene, id)) tree.spheres.push_back(id);
  add_rods(scene, tree.spheres);
  if (tree.spheres.empty()) return tree;
  Builder(scene, tree).build();
  index_leaves(tree);
  return tree;
}

}  // namespace orrery::compile
