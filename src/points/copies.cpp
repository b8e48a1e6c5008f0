// SPDX-License-Identifier: Apache-2.0
#include "points/copies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "math/scalar.h"
#include "math/vec3.h"

namespace orrery::points {
namespace {

using data::Transform;
using data::Vec3d;

bool is_identity(const Transform& t) {
  const Transform identity;
  return t.rows == identity.rows && t.translation == identity.translation;
}

/// Returns a transformed direction, without the translation.
Vec3d turned(const Transform& t, Vec3d v) {
  return {math::dot(t.rows[0], v), math::dot(t.rows[1], v), math::dot(t.rows[2], v)};
}

/// Rounding to single precision moves a coordinate by up to this fraction of itself.
constexpr double kRounding = 0x1p-24;

/// Centres are not rounded where this could move one by more than this fraction of the smallest radius.
constexpr double kMaxDisplacement = 1e-3;

Vec3d in_single_precision(Vec3d p) {
  return {math::in_single_precision(p.x), math::in_single_precision(p.y), math::in_single_precision(p.z)};
}

bool leaves_unchanged(const std::vector<Copy>& copies) {
  return copies.size() == 1 && is_identity(copies[0].transform) && copies[0].chains == nullptr;
}

/// The largest absolute coordinate among the corners of the copies' bounding boxes.
///
/// Domain     at least one centre
double largest_coordinate(const std::vector<Copy>& copies, const Transform& placement,
                          const scene::PointArray& centers) {
  Vec3d lower = centers[0], upper = lower;
  for (const Vec3d c : centers) {
    lower = math::least(lower, c);
    upper = math::greatest(upper, c);
  }
  double largest = 0;
  for (const Copy& copy : copies)
    for (const double x : {lower.x, upper.x})
      for (const double y : {lower.y, upper.y})
        for (const double z : {lower.z, upper.z}) {
          const Vec3d p = applied(placement, applied(copy.transform, {x, y, z}));
          largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        }
  return largest;
}

const data::Assembly* find_assembly(const data::FrameInfo& info, const std::string& name, KeyFaults& faults) {
  if (const data::Assembly* const found = data::find_named(info.assemblies, name)) return found;
  std::vector<std::string> names;
  for (const data::Assembly& a : info.assemblies) names.push_back(a.name);
  faults.error(".assembly", fmt::format("the file has no assembly {}; it has {}", name,
                                        names.empty() ? std::string("none") : base::joined(names)));
  return nullptr;
}

/// Multiplies radii by a factor. Creates a separate array, since old and new radii together can be too many for a
/// palette.
void scale(scene::NumberArray& radii, double factor) {
  scene::NumberArray scaled;
  scaled.reserve(radii.size());
  for (const double radius : radii) scaled.push_back(radius * factor);
  radii = std::move(scaled);
}

}  // namespace

Vec3d applied(const Transform& t, Vec3d p) {
  return {math::dot(t.rows[0], p) + t.translation.x, math::dot(t.rows[1], p) + t.translation.y,
          math::dot(t.rows[2], p) + t.translation.z};
}

Transform transform_of(const scene::PointsTransform& t) {
  const auto turn = [](double degrees) {
    const long double angle = static_cast<long double>(degrees) / 180 * std::numbers::pi_v<long double>;
    return std::pair{static_cast<double>(std::cos(angle)), static_cast<double>(std::sin(angle))};
  };
  const auto [cx, sx] = turn(t.rotate.x);
  const auto [cy, sy] = turn(t.rotate.y);
  const auto [cz, sz] = turn(t.rotate.z);
  Transform out;
  out.rows[0] = Vec3d{cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx} * t.scale;
  out.rows[1] = Vec3d{sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx} * t.scale;
  out.rows[2] = Vec3d{-sy, cy * sx, cy * cx} * t.scale;
  out.translation = t.translate;
  return out;
}

void unwrap(const data::Table& table, const Rows& rows, const data::FrameInfo& info, scene::PointArray& centers) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for_each_number(*table.find(info.roles.image[axis]), rows,
                    [&](std::size_t i, double n) { centers.set(i, centers[i] + info.box->edges[axis] * n); });
}

std::vector<Copy> copies_of(const data::FrameInfo& info, const scene::PointsKeys& points, KeyFaults& faults) {
  std::vector<Copy> out;
  if (!points.assembly.empty()) {
    if (const data::Assembly* assembly = find_assembly(info, points.assembly, faults)) {
      for (const data::AssemblyPart& part : assembly->parts)
        for (const Transform& t : part.transforms) out.push_back({t, part.chains.empty() ? nullptr : &part.chains});
      if (out.empty())
        faults.error(".assembly", fmt::format("assembly {} of the file has no transforms, for example because it was "
                                              "edited; leave it out to show the particles of the file",
                                              points.assembly));
    }
  } else {
    out.push_back({});
  }
  const Vec3d n = points.replicate;
  if (n.x != std::floor(n.x) || n.y != std::floor(n.y) || n.z != std::floor(n.z))
    faults.error(".replicate", "the numbers of copies must be integers");
  else if (!(n == Vec3d{1, 1, 1}) && !info.box)
    faults.error(".replicate", "the file has no periodic box");
  else
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const double counts[] = {n.x, n.y, n.z}; counts[axis] > 1 && info.box->edges[axis] == Vec3d{})
        faults.error(".replicate", std::string("edge ") + "abc"[axis] + " of the box has no length");
  return out;
}

std::vector<Copy> replicated(const std::vector<Copy>& copies, const data::Box& box, Vec3d counts) {
  std::vector<Copy> out;
  for (double k = 0; k < counts.z; ++k)
    for (double j = 0; j < counts.y; ++j)
      for (double i = 0; i < counts.x; ++i)
        for (Copy copy : copies) {
          copy.transform.translation =
              copy.transform.translation + box.edges[0] * i + box.edges[1] * j + box.edges[2] * k;
          out.push_back(copy);
        }
  return out;
}

std::vector<Copy> outermost(const std::vector<Copy>& copies, const data::Box& box, Vec3d counts) {
  data::Box whole = box;
  whole.edges = {box.edges[0] * (counts.x - 1), box.edges[1] * (counts.y - 1), box.edges[2] * (counts.z - 1)};
  return replicated(copies, whole, {2, 2, 2});
}

bool are_rounded(const std::vector<Copy>& copies, const scene::PointsKeys& points, const scene::PointArray& centers,
                 const scene::NumberArray& radii) {
  if (points.assembly.empty() || leaves_unchanged(copies) || centers.empty()) return false;
  double smallest = std::abs(radii[0]);
  for (const double radius : radii) smallest = std::min(smallest, std::abs(radius));
  return largest_coordinate(copies, transform_of(points.transform), centers) * kRounding <=
         smallest * points.transform.scale * kMaxDisplacement;
}

CopiedSpheres::CopiedSpheres(const std::vector<Copy>& copies, const Labels& chains, std::size_t count) {
  std::vector<const std::vector<std::string>*> sets;
  for (const Copy& copy : copies) {
    Place place{total_, kAll};
    if (copy.chains != nullptr) {
      place.subset = static_cast<std::size_t>(std::find(sets.begin(), sets.end(), copy.chains) - sets.begin());
      if (place.subset == sets.size()) {
        sets.push_back(copy.chains);
        std::vector<std::uint8_t> is_in;
        for (const std::string& name : chains.names) is_in.push_back(base::contains(*copy.chains, name) ? 1 : 0);
        subsets_.emplace_back();
        for (std::uint32_t i = 0; i < chains.of_rows.size(); ++i)
          if (is_in[chains.of_rows[i]] != 0) subsets_.back().push_back(i);
      }
    }
    copies_.push_back(place);
    total_ += place.subset == kAll ? count : subsets_[place.subset].size();
  }
}

std::uint32_t CopiedSpheres::at(std::size_t copy, std::uint32_t sphere) const {
  const Place& place = copies_[copy];
  if (place.subset == kAll) return static_cast<std::uint32_t>(place.first + sphere);
  const std::vector<std::uint32_t>& subset = subsets_[place.subset];
  const auto found = std::lower_bound(subset.begin(), subset.end(), sphere);
  if (found == subset.end() || *found != sphere) return kNone;
  return static_cast<std::uint32_t>(place.first) + static_cast<std::uint32_t>(found - subset.begin());
}

std::uint64_t copied_count(const std::vector<Copy>& copies, const Labels& chains, std::size_t count) {
  std::vector<std::uint64_t> counts(chains.names.size());
  for (const std::uint32_t label : chains.of_rows) ++counts[label];
  std::uint64_t total = 0;
  for (const Copy& copy : copies) {
    if (copy.chains == nullptr) {
      total += count;
      continue;
    }
    for (const std::string& name : *copy.chains) {
      const auto at = std::lower_bound(chains.names.begin(), chains.names.end(), name);
      if (at != chains.names.end() && *at == name) total += counts[static_cast<std::size_t>(at - chains.names.begin())];
    }
  }
  return total;
}

void clip(scene::Points& points, std::vector<std::uint32_t>* rows) {
  const auto& planes = points.clip;
  if (!planes[0] && !planes[1] && !planes[2]) return;
  const auto holds = [](const std::optional<scene::Interval>& interval, double at) {
    return !interval || (at >= interval->low && at <= interval->high);
  };
  const std::size_t count = points.centers.size();
  const auto is_inside = [&](std::uint32_t i) {
    const Vec3d c = points.centers[i];
    return holds(planes[0], c.x) && holds(planes[1], c.y) && holds(planes[2], c.z);
  };
  std::size_t inside = 0;
  for (std::uint32_t i = 0; i < count; ++i) inside += is_inside(i);
  std::vector<std::uint32_t> kept;
  kept.reserve(inside);  // a vector that grows takes up to three times the memory
  for (std::uint32_t i = 0; i < count; ++i)
    if (is_inside(i)) kept.push_back(i);
  keep(points.centers, kept);
  keep(points.radii, kept);
  points.each_sphere_value([&](auto& values) { keep(values, kept); });
  points.each_vector([&](auto& vectors) { keep(vectors, kept); });
  if (rows != nullptr) keep(*rows, kept);
  if (points.bond_count() == 0) return;
  std::vector<std::uint32_t> new_index(count, CopiedSpheres::kNone);
  for (std::uint32_t i = 0; i < kept.size(); ++i) new_index[kept[i]] = i;
  const auto renumber = [&](std::uint32_t& a, std::uint32_t& b) {
    a = new_index[a];
    b = new_index[b];
    return a != CopiedSpheres::kNone && b != CopiedSpheres::kNone;
  };
  std::erase_if(points.bond_pairs, [&](scene::SphereBond& bond) { return !renumber(bond.a, bond.b); });
  std::erase_if(points.bond_stubs, [&](scene::BondStub& stub) { return !renumber(stub.sphere, stub.partner); });
}

void make_copies(const std::vector<Copy>& copies, const Labels& chains, scene::Points& points,
                 std::vector<std::uint32_t>* rows) {
  const Transform placement = transform_of(points.transform);
  const bool is_placed = !is_identity(placement);
  if (leaves_unchanged(copies)) {
    if (!is_placed) return;
    for (std::size_t i = 0; i < points.centers.size(); ++i)
      points.centers.set(i, applied(placement, points.centers[i]));
    points.each_vector([&](auto& vectors) {
      for (std::size_t i = 0; i < vectors.size(); ++i) vectors.set(i, turned(placement, vectors[i]));
    });
    scale(points.radii, points.transform.scale);
    return;
  }
  const CopiedSpheres spheres(copies, chains, points.centers.size());
  const bool rounds = are_rounded(copies, points, points.centers, points.radii);
  spheres.repeat(points.centers, [&](Vec3d center, std::size_t copy) {
    center = applied(copies[copy].transform, center);
    if (is_placed) center = applied(placement, center);
    return rounds ? in_single_precision(center) : center;
  });
  spheres.repeat(points.radii);
  points.each_sphere_value([&](auto& values) { spheres.repeat(values); });
  points.each_vector([&](auto& vectors) {
    spheres.repeat(vectors, [&](Vec3d vector, std::size_t copy) {
      return turned(placement, turned(copies[copy].transform, vector));
    });
  });
  if (rows != nullptr) spheres.repeat(*rows);
  if (is_placed) scale(points.radii, points.transform.scale);
}

}  // namespace orrery::points
