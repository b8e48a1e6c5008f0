// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "points/rows.h"

namespace orrery::points {

/// Unwraps the positions of the rows: p + i a + j b + k c, with the periodic image flags i, j, k of the file.
void unwrap(const data::Table& table, const Rows& rows, const data::FrameInfo& info, scene::PointArray& centers);

/// The transform of a points table: scale, then rotations about x, y and z, then translation.
///
/// Precision  sines and cosines are rounded from long double, so that they do not depend on the math library
data::Transform transform_of(const scene::PointsTransform& t);

/// Returns a transformed point.
data::Vec3d applied(const data::Transform& t, data::Vec3d p);

/// One copy of all spheres, or of those in some chains.
struct Copy {
  data::Transform transform;
  const std::vector<std::string>* chains = nullptr;  ///< null: all
};

/// The copies of an assembly; without an assembly, a single identity copy. Reports an assembly that the file does not
/// define or that has no transforms, and replication without a box.
std::vector<Copy> copies_of(const data::FrameInfo& info, const scene::PointsKeys& points, KeyFaults& faults);

/// Repeats the copies in each periodic image of the box, of which there are `counts` along each edge.
///
/// Cost       100 bytes per copy and image: callers check the memory first
std::vector<Copy> replicated(const std::vector<Copy>& copies, const data::Box& box, data::Vec3d counts);

/// The copies in the outermost images: those at the corners of the block of images that replicated() makes.
std::vector<Copy> outermost(const std::vector<Copy>& copies, const data::Box& box, data::Vec3d counts);

/// Whether make_copies() rounds the centres to single precision, in which they take half the memory: those of an
/// assembly, unless its only transform changes nothing, or the rounding could move a sphere by more than a thousandth
/// of the smallest radius. `copies` may be only the outermost ones.
bool are_rounded(const std::vector<Copy>& copies, const scene::PointsKeys& points, const scene::PointArray& centers,
                 const scene::NumberArray& radii);

/// The number of spheres that make_copies() creates from `count` spheres; an upper bound if a copy lists a chain twice.
std::uint64_t copied_count(const std::vector<Copy>& copies, const Labels& chains, std::size_t count);

/// The spheres of each copy, in the order in which make_copies() puts them.
class CopiedSpheres {
 public:
  static constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);

  /// `count`    number of spheres before they are copied
  CopiedSpheres(const std::vector<Copy>& copies, const Labels& chains, std::size_t count);

  std::size_t copies() const { return copies_.size(); }
  /// Returns the index of the copy of a sphere; kNone if the copy is limited to other chains.
  std::uint32_t at(std::size_t copy, std::uint32_t sphere) const;

  /// Replaces values of the spheres with those of the copies, copy by copy: `f(value, copy)`.
  template <class Array, class F>
  void repeat(Array& values, F f) const {
    if (values.empty()) return;
    Array out;
    out.reserve(total_);
    for (std::size_t copy = 0; copy < copies_.size(); ++copy) {
      if (copies_[copy].subset == kAll) {
        for (std::size_t i = 0; i < values.size(); ++i) out.push_back(f(values[i], copy));
      } else {
        for (const std::uint32_t i : subsets_[copies_[copy].subset]) out.push_back(f(values[i], copy));
      }
    }
    values = std::move(out);
  }
  template <class Array>
  void repeat(Array& values) const {
    repeat(values, [](auto value, std::size_t) { return value; });
  }

 private:
  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);
  struct Place {
    std::size_t first = 0, subset = kAll;
  };

  std::vector<Place> copies_;
  std::vector<std::vector<std::uint32_t>> subsets_;  ///< spheres of a set of chains, ascending
  std::size_t total_ = 0;                            ///< number of spheres in all copies
};

/// Replaces the spheres, and the row number of each, with their copies, copy by copy, and applies the transform of the
/// points table.
///
/// `chains`   chain of each sphere; ignored unless a copy is limited to some chains
void make_copies(const std::vector<Copy>& copies, const Labels& chains, scene::Points& points,
                 std::vector<std::uint32_t>* rows = nullptr);

/// Keeps the values at these places, which ascend.
template <class Array>
void keep(Array& values, const std::vector<std::uint32_t>& places) {
  for (std::size_t i = 0; i < places.size(); ++i)
    if constexpr (requires { values.set(i, values[i]); })
      values.set(i, values[places[i]]);
    else
      values[i] = values[places[i]];
  values.resize(places.size());
}

/// Removes the spheres whose centres are outside `points.clip`, their row numbers, and their bonds.
void clip(scene::Points& points, std::vector<std::uint32_t>* rows = nullptr);

/// Spheres of the head of an arrow.
inline constexpr std::size_t kHeadSpheres = 12;

/// Adds an arrow at each sphere of `points`, along its vector: a bond as the shaft, and spheres of falling radius as
/// the head, after all other spheres. They have the colour, material and opacity of the sphere. Consumes
/// `points.sphere_vectors`, and sets `points.arrow_count` and `points.rms_vector`.
///
/// Vectors that are not finite, and those no longer than the shaft is thick, have no arrow; the former are reported.
///
/// `rows`     row number of each sphere, extended to the spheres of the heads; may be null
/// Domain     after transform.scale; `points.bond_radius` is that of the shafts
void add_arrows(scene::Points& points, std::vector<std::uint32_t>* rows, KeyFaults& faults);

}  // namespace orrery::points
