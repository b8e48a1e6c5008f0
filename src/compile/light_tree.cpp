// SPDX-License-Identifier: Apache-2.0
#include "compile/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "base/duplicates.h"
#include "kernel/coincidence.h"
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

/// Maximum number of entries per emitter in a table of all ids from the first to the last emitter. For larger ranges,
/// leaves are found by binary search.
constexpr std::uint32_t kMaxEntries = 2;

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

/// Builds the lookup of leaves by sphere.
void index_leaves(LightTree& tree) {
  const auto count = static_cast<std::uint32_t>(tree.spheres.size());
  const auto [first, last] = std::minmax_element(tree.spheres.begin(), tree.spheres.end());
  tree.first_sphere = *first;
  tree.end_sphere = *last + 1;
  tree.scattered = (tree.end_sphere - tree.first_sphere) / kMaxEntries > count;
  if (tree.scattered) {
    tree.leaves.resize(count);
    std::iota(tree.leaves.begin(), tree.leaves.end(), 0U);
    std::sort(tree.leaves.begin(), tree.leaves.end(),
              [&](std::uint32_t a, std::uint32_t b) { return tree.spheres[a] < tree.spheres[b]; });
    return;
  }
  tree.leaves.assign(tree.end_sphere - tree.first_sphere, Lights::kNoLeaf);
  for (std::uint32_t leaf = 0; leaf < count; ++leaf) tree.leaves[tree.spheres[leaf] - tree.first_sphere] = leaf;
}

/// Whether a sphere or half of a rod emits.
bool is_lamp(const kernel::SceneView& scene, std::uint32_t id) {
  if (scene.opacity != nullptr && scene.opacity[id] == 0) return false;
  const double* const rgb = scene.emission[scene.object_materials[id]].radiance;
  return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0;
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

/// Finds rods that coincide with an earlier one while the shutter is open.
std::vector<base::Duplicate> coincident_rods(const kernel::SceneView& scene, kernel::Precision precision) {
  const auto key = [&](std::size_t i) {
    std::array<double, 14> out;
    for (const std::size_t time : {0U, 1U}) {
      const kernel::Rod rod = scene.rods.at(i, static_cast<double>(time));
      const double numbers[] = {rod.a[0], rod.a[1], rod.a[2], rod.b[0], rod.b[1], rod.b[2], rod.radius};
      std::copy(std::begin(numbers), std::end(numbers), out.begin() + (time == 0 ? 0 : 7));
    }
    if (precision == kernel::Precision::kFast)
      for (double& x : out) x = math::in_single_precision(x);
    return out;
  };
  return base::find_duplicates<14>(scene.rods.count, key);
}

/// Finds spheres up to `count` that coincide with an earlier one while the shutter is open.
std::vector<base::Duplicate> coincident_spheres(const kernel::SceneView& scene, kernel::Precision precision,
                                                std::size_t count) {
  const auto place = [&](std::size_t id) { return kernel::coincidence_key<4>(scene, id, precision); };
  const auto path = [&](std::size_t id) { return kernel::coincidence_key<8>(scene, id, precision); };
  return scene.moving_count > 0 ? base::find_duplicates<8>(count, path) : base::find_duplicates<4>(count, place);
}

}  // namespace

Lights LightTree::view() const noexcept {
  Lights out;
  out.spheres = spheres.data();
  out.nodes = nodes.data();
  out.leaves = leaves.data();
  out.first_sphere = first_sphere;
  out.end_sphere = end_sphere;
  out.count = static_cast<std::uint32_t>(spheres.size());
  out.scattered = scattered;
  return out;
}

std::size_t LightTree::bytes() const noexcept {
  return spheres.size() * sizeof(spheres[0]) + nodes.size() * sizeof(nodes[0]) + leaves.size() * sizeof(leaves[0]);
}

std::size_t LightTree::bytes_of_build() const noexcept { return bytes() + spheres.size() * sizeof(Leaf); }

std::vector<std::uint32_t> without_coincident(const kernel::SceneView& scene, kernel::Precision precision,
                                              std::vector<std::uint32_t> ids) {
  const auto remove = [&](const std::vector<base::Duplicate>& found, auto begin, auto end, auto index_of) {
    ids.erase(std::remove_if(begin, end,
                             [&](std::uint32_t id) {
                               return std::ranges::binary_search(found, index_of(id), {}, &base::Duplicate::index);
                             }),
              end);
  };
  const auto first_rod = std::ranges::lower_bound(ids, scene.sphere_count);
  const auto spheres = first_rod - ids.begin();
  if (first_rod != ids.end())
    remove(coincident_rods(scene, precision), first_rod, ids.end(),
           [&](std::uint32_t id) { return std::size_t{scene.rods.index(id)}; });
  if (spheres == 0 || kernel::is_distinct(scene, precision)) return ids;
  const auto end = ids.begin() + spheres;
  remove(coincident_spheres(scene, precision, std::size_t{end[-1]} + 1), ids.begin(), end,
         [](std::uint32_t id) { return std::size_t{id}; });
  return ids;
}

LightTree build_light_tree(const kernel::SceneView& scene, kernel::Precision precision) {
  LightTree tree;
  tree.precision = precision;
  for (std::uint32_t id = 0; id < scene.sphere_count; ++id)
    if (is_lamp(scene, id)) tree.spheres.push_back(id);
  add_rods(scene, tree.spheres);
  tree.spheres = without_coincident(scene, precision, std::move(tree.spheres));
  if (tree.spheres.empty()) return tree;
  Builder(scene, tree).build();
  index_leaves(tree);
  return tree;
}

}  // namespace orrery::compile
