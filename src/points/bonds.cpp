// SPDX-License-Identifier: Apache-2.0
#include "points/bonds.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "data/elements.h"
#include "scene/limits.h"

namespace orrery::points {
namespace {

using data::Vec3d;

/// Atoms closer than this fraction of the largest length of a bond, 0.4 times the sum of the radii with the default
/// factor, are alternative positions of one atom.
constexpr double kSmallestFraction = 1.0 / 3;

constexpr double kElementBondRadius = 0.15, kBondRadiusOfSphere = 0.3;

template <class T>
void sort_unique(std::vector<T>& values) {
  tbb::parallel_sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

BondSource bond_source(const data::FrameInfo& info, const scene::PointsBonds& bonds, KeyFaults& faults) {
  BondSource out;
  const bool has_bonds = info.has_bonds;
  const bool has_distance = bonds.factor || bonds.length;
  const bool by_default = bonds.from.empty();
  out.is_file = by_default ? has_bonds && !(has_distance && info.lists_all_bonds) : bonds.from != "distance";
  out.is_distance = by_default ? !out.is_file || !info.lists_all_bonds : bonds.from != "file";
  if (out.is_file && !has_bonds)
    faults.error(".bonds.from", "the file has no bonds; set `from = \"distance\"`, or --bonds distance");
  if (bonds.factor && bonds.length) faults.error(".bonds", "only one of `factor` and `length` can be set");
  if (!out.is_distance && has_distance)
    faults.warning(bonds.factor ? ".bonds.factor" : ".bonds.length", "has no effect: the bonds are those of the file");
  if (out.is_distance && !bonds.length) {
    out.element = info.roles.element;
    if (out.element.empty())
      faults.error(".bonds",
                   fmt::format("the file has no {}column of chemical elements; set `bonds.length`, or --bonds "
                               "length=X, to the largest length of a bond in the unit of the file",
                               has_bonds ? "" : "bonds and no "));
  }
  return out;
}

Reach reach_of(const data::Table& table, const Rows& rows, const BondSource& source, const scene::PointsBonds& bonds,
               KeyFaults& faults) {
  Reach out;
  if (source.element.empty()) {
    out.of_label = {*bonds.length / 2};
    return out;
  }
  out.smallest = kSmallestFraction;
  Labels labels = labels_of(*table.find(source.element), rows, kMaxTypes);
  std::vector<std::string> missing;
  for (const std::string& name : labels.names) {
    const data::Element* const element = data::find_element(name);
    if (element == nullptr) missing.push_back(fmt::format("`{}`", name));
    out.are_metals.push_back(element != nullptr && data::is_metal(*element));
    out.of_label.push_back(element == nullptr ? 0
                                              : element->covalent * bonds.factor.value_or(scene::kDefaultBondFactor));
  }
  if (labels.of_rows.size() != rows.size()) missing = {"most names"};
  if (!missing.empty())
    faults.error(".bonds", fmt::format("no covalent radius is known for {} in column `{}`; leave these rows out with "
                                       "`select`, set `bonds.length`, or use the bonds of the file: `from = \"file\"`",
                                       base::joined(missing), source.element));
  if (out.of_label.empty()) out.of_label = {0};
  out.labels = std::move(labels.of_rows);
  return out;
}

void remove_metal_bonds(const Reach& reach, BondSet& bonds) {
  const auto& metals = reach.are_metals;
  if (std::find(metals.begin(), metals.end(), false) == metals.end()) return;
  const auto are_metals = [&](const auto& bond) {
    return metals[reach.labels[bond.a]] && metals[reach.labels[bond.b]];
  };
  std::erase_if(bonds.pairs, are_metals);
  std::erase_if(bonds.crossing, are_metals);
}

BondSet bonds_of_rows(const std::vector<data::Bond>& bonds, const Rows& rows, std::size_t row_count,
                      const scene::PointArray& centers, const Lattice& lattice) {
  std::vector<std::uint32_t> spheres(rows.is_all() ? 0 : row_count, CopiedSpheres::kNone);
  if (!rows.is_all())
    for (std::size_t i = 0; i < rows.size(); ++i) spheres[rows[i]] = static_cast<std::uint32_t>(i);
  BondSet out;
  out.pairs.reserve(bonds.size());
  for (const data::Bond& bond : bonds) {
    auto [a, b] = rows.is_all() ? std::pair{bond.a, bond.b} : std::pair{spheres[bond.a], spheres[bond.b]};
    if (a == CopiedSpheres::kNone || b == CopiedSpheres::kNone) continue;
    if (a > b) std::swap(a, b);
    const Shift shift = lattice.shift_to_nearest(centers[a], centers[b]);
    if (shift == Shift{0, 0, 0})
      out.pairs.push_back({a, b});
    else
      out.crossing.push_back({a, b, shift});
  }
  sort_unique(out.pairs);
  sort_unique(out.crossing);
  return out;
}

void join_molecules(const BondSet& bonds, const Lattice& lattice, scene::PointArray& centers) {
  struct Neighbor {
    std::uint32_t point = 0;
    Shift shift{};
  };
  const std::size_t count = centers.size();
  // Shifts wrap around: a damaged file may have bonds of any length.
  const auto moved = [](const Shift& a, const Shift& b, bool forth) {
    Shift out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto from = static_cast<std::uint32_t>(a[axis]), by = static_cast<std::uint32_t>(b[axis]);
      out[axis] = static_cast<std::int32_t>(forth ? from + by : from - by);
    }
    return out;
  };
  const auto each_end = [&](auto visit) {
    for (const scene::SphereBond& bond : bonds.pairs) {
      visit(bond.a, Neighbor{bond.b, {}});
      visit(bond.b, Neighbor{bond.a, {}});
    }
    for (const CrossingBond& bond : bonds.crossing) {
      visit(bond.a, Neighbor{bond.b, bond.shift});
      visit(bond.b, Neighbor{bond.a, moved({}, bond.shift, false)});
    }
  };
  std::vector<std::size_t> ends(count + 1);  // of the neighbours of each point
  each_end([&](std::uint32_t from, const Neighbor&) { ++ends[from + 1]; });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<Neighbor> neighbors(ends.back());
  std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
  each_end([&](std::uint32_t from, const Neighbor& to) { neighbors[next[from]++] = to; });
  std::vector<bool> is_placed(count);
  std::vector<Shift> shifts(count);
  std::vector<std::uint32_t> molecule;
  for (std::uint32_t start = 0; start < count; ++start) {
    if (is_placed[start]) continue;
    molecule = {start};
    is_placed[start] = true;
    Vec3d sum{0, 0, 0};
    for (std::size_t i = 0; i < molecule.size(); ++i) {
      const std::uint32_t from = molecule[i];
      sum = sum + centers[from] + lattice.translation(shifts[from]);
      for (std::size_t k = ends[from]; k < ends[from + 1]; ++k) {
        const std::uint32_t to = neighbors[k].point;
        if (is_placed[to]) continue;
        is_placed[to] = true;
        shifts[to] = moved(shifts[from], neighbors[k].shift, true);
        molecule.push_back(to);
      }
    }
    const Shift home = lattice.image_of(sum / static_cast<double>(molecule.size()));
    for (const std::uint32_t i : molecule)
      centers.set(i, centers[i] + lattice.translation(moved(shifts[i], home, false)));
  }
}

void merge(BondSet& bonds, BondSet more) {
  bonds.pairs.insert(bonds.pairs.end(), more.pairs.begin(), more.pairs.end());
  bonds.crossing.insert(bonds.crossing.end(), more.crossing.begin(), more.crossing.end());
  sort_unique(bonds.pairs);
  sort_unique(bonds.crossing);
}

double bond_radius(const data::FrameInfo& info, const scene::PointsBonds& bonds, const scene::NumberArray& radii) {
  if (bonds.radius) return *bonds.radius;
  if (!info.roles.element.empty()) return kElementBondRadius;
  double sum = 0;
  for (const double radius : radii) sum += std::abs(radius);
  return radii.empty() ? 1 : kBondRadiusOfSphere * sum / static_cast<double>(radii.size());
}

void copy_bonds(const BondSet& bonds, const std::vector<Copy>& copies, const Labels& chains, const Lattice& lattice,
                scene::Points& points) {
  const CopiedSpheres index(copies, chains, points.centers.size());
  points.bond_pairs.clear();
  points.bond_stubs.clear();
  for (std::size_t copy = 0; copy < index.copies(); ++copy)
    for (const scene::SphereBond& bond : bonds.pairs) {
      const std::uint32_t a = index.at(copy, bond.a), b = index.at(copy, bond.b);
      if (a != CopiedSpheres::kNone && b != CopiedSpheres::kNone) points.bond_pairs.push_back({a, b});
    }
  if (bonds.crossing.empty()) return;
  // There is one copy in each image.
  const data::Transform placement = transform_of(points.transform);
  const auto whole = [](auto x) { return static_cast<std::int32_t>(x); };
  const Shift counts = {whole(points.replicate.x), whole(points.replicate.y), whole(points.replicate.z)};
  const std::int64_t in_row = counts[0], in_plane = in_row * counts[1];
  const auto copy_at = [&](const Shift& image) {
    return static_cast<std::size_t>(image[2] * in_plane + image[1] * in_row + image[0]);
  };
  const auto add_stub = [&](std::uint32_t from, const Shift& image, std::uint32_t to, const Shift& partner,
                            Vec3d half) {
    const Vec3d start = points.centers[from] + lattice.translation(image);
    points.bond_stubs.push_back(
        {index.at(copy_at(image), from), index.at(copy_at(partner), to), applied(placement, start + half)});
  };
  for (std::int64_t copy = 0; copy < in_plane * counts[2]; ++copy) {
    const Shift image = {whole(copy % in_row), whole(copy % in_plane / in_row), whole(copy / in_plane)};
    for (const CrossingBond& bond : bonds.crossing) {
      Shift at{}, partner{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis] = image[axis] + bond.shift[axis];
        partner[axis] = (at[axis] % counts[axis] + counts[axis]) % counts[axis];
      }
      if (partner == at) {
        const std::uint32_t a = index.at(copy_at(image), bond.a), b = index.at(copy_at(partner), bond.b);
        points.bond_pairs.push_back({std::min(a, b), std::max(a, b)});
        continue;
      }
      const Vec3d half = (points.centers[bond.b] + lattice.translation(bond.shift) - points.centers[bond.a]) * 0.5;
      add_stub(bond.a, image, bond.b, partner, half);
      add_stub(bond.b, partner, bond.a, image, half * -1.0);
    }
  }
}

}  // namespace orrery::points
