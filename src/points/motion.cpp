// SPDX-License-Identifier: Apache-2.0
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include "base/huge_pages.h"
#include "data/columns.h"
#include "points/bonds.h"
#include "points/sources.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::points {
namespace {

using data::Vec3d;

/// Displacements above this in a frame are refused, so that motion ends within the domain of scenes.
constexpr double kLargestDisplacement = scene::kLargestLength / (10 * scene::kLongestShutter);

/// Displacements above this fraction of the width of a periodic box are reported: above a half, the nearest image is
/// another one.
constexpr double kUncertainFraction = 0.25;

/// Returns the row with the same id for each of these rows, ascending by id; CopiedSpheres::kNone if there is none.
template <class IdHere, class IdThere>
std::vector<std::uint32_t> joined_by_id(const Rows& here, const Rows& there, IdHere id_here, IdThere id_there) {
  std::vector<std::uint32_t> out(here.size(), CopiedSpheres::kNone);
  std::size_t next = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    const auto id = id_here(here[i]);
    while (next < there.size() && id_there(there[next]) < id) ++next;
    if (next < there.size() && id_there(there[next]) == id) out[i] = static_cast<std::uint32_t>(there[next++]);
  }
  return out;
}

/// The rows of another frame with the ids of these rows.
std::vector<std::uint32_t> rows_with_ids(const data::Column& ids, const Rows& rows, const data::Column& other_ids) {
  std::size_t repeated = 0;
  const Rows others = rows_by_id(other_ids, {}, repeated);
  return std::visit(
      [&](const auto& here) {
        using Ids = std::decay_t<decltype(here)>;
        if constexpr (!std::is_same_v<Ids, data::Words>) {
          // In the type in which the file stores them: a double cannot represent all 64-bit ids.
          if (const auto* const there = std::get_if<Ids>(&other_ids.values))
            return joined_by_id(
                rows, others, [&](std::size_t row) { return here[row]; },
                [&](std::size_t row) { return (*there)[row]; });
        }
        return joined_by_id(  // text matches nothing
            rows, others, [&](std::size_t row) { return ids.number(row); },
            [&](std::size_t row) { return other_ids.number(row); });
      },
      ids.values);
}

bool is_uncertain(const Lattice& lattice, Vec3d from, Vec3d d) {
  const Vec3d edges = lattice.fractional(from + d) - lattice.fractional(from);
  const double along[] = {edges.x, edges.y, edges.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.is_periodic(axis) && std::abs(along[axis]) > kUncertainFraction) return true;
  return false;
}

}  // namespace

std::vector<std::string> velocity_columns(const data::FrameInfo& info, const scene::PointsMotion& motion,
                                          KeyFaults& faults) {
  if (motion.next_frame) {
    if (motion.frame_time || !motion.columns.empty())
      faults.error(".motion", "`next_frame` excludes `columns` and `frame_time`, by which spheres move by velocities");
    return {};
  }
  std::vector<std::string> out = motion.columns.empty() ? velocity_of(info) : motion.columns;
  if (!motion.frame_time)
    faults.error(".motion", "`columns` need `frame_time`, the time between two frames in the unit of the velocities");
  if (out.empty())
    faults.error(".motion", fmt::format("the file has no velocities such as vx, vy and vz; its columns are {}; set "
                                        "`motion.columns`, or `motion.next_frame` if the file has several frames",
                                        data::listed(info.columns)));
  else if (out.size() != 3)
    faults.error(".motion.columns",
                 fmt::format("has {} columns; a velocity has three, e.g. vx, vy and vz", out.size()));
  for (const std::string& column : out) require_column(info, column, true, ".motion.columns", faults);
  return out;
}

scene::PointArray displacements(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                                const data::FrameInfo& info, const data::Table& other, const data::Roles& roles,
                                KeyFaults& faults) {
  const data::Column *const ids = table.find(info.roles.id), *const other_ids = other.find(roles.id);
  std::vector<std::uint32_t> found;
  if (ids != nullptr && other_ids != nullptr) {
    found = rows_with_ids(*ids, rows, *other_ids);
  } else if (table.rows == other.rows) {
    found = rows.list();
  } else {
    faults.error(".motion.next_frame",
                 fmt::format("the frame has {} particles and the one beside it {}, without ids that say which are the "
                             "same; set `motion.frame_time` to move them by velocities",
                             table.rows, other.rows));
    return {};
  }
  const std::size_t missing = static_cast<std::size_t>(std::count(found.begin(), found.end(), CopiedSpheres::kNone));
  if (missing > 0)
    faults.warning(
        ".motion.next_frame",
        fmt::format("{} of {} particles are not in the frame beside it, and do not move", missing, found.size()));
  std::array<const data::Column*, 3> position{};
  for (std::size_t axis = 0; axis < 3; ++axis) position[axis] = other.find(roles.position[axis]);
  const Lattice lattice(info.box);
  double width = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.is_periodic(axis)) width = std::min(width, lattice.width(axis));
  base::HugeVector<double> out(3 * found.size());
  std::atomic<std::size_t> far = 0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      Vec3d d;
      if (found[i] != CopiedSpheres::kNone) {
        const Vec3d from = centers[i],
                    to{position[0]->number(found[i]), position[1]->number(found[i]), position[2]->number(found[i])};
        d = to - from;
        if (!(math::length(d) < width / 2) && math::is_finite(d))  // else no other image is closer
          d = d + lattice.translation(lattice.shift_to_nearest(from, to));
        if (math::length(d) > kUncertainFraction * width) far += is_uncertain(lattice, from, d) ? 1 : 0;
      }
      out[3 * i] = d.x;
      out[3 * i + 1] = d.y;
      out[3 * i + 2] = d.z;
    }
  });
  if (far > 0)
    faults.warning(".motion.next_frame",
                   fmt::format("{} of {} particles move by more than a quarter of the periodic box in a frame, and may "
                               "have moved the other way; set `motion.frame_time` to move them by velocities",
                               far.load(), found.size()));
  return scene::PointArray(scene::NumberArray(std::move(out)));
}

scene::PointArray valid_displacements(const scene::PointsKeys& points, const Rows& rows,
                                      const scene::PointArray& displacements, double factor, KeyFaults& faults) {
  base::HugeVector<float> out(3 * displacements.size());
  std::size_t bad = 0;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    const Vec3d d = displacements[i] * factor;
    const bool is_valid = math::length(d) * points.transform.scale <= kLargestDisplacement;
    out[3 * i] = is_valid ? static_cast<float>(d.x) : 0;
    out[3 * i + 1] = is_valid ? static_cast<float>(d.y) : 0;
    out[3 * i + 2] = is_valid ? static_cast<float>(d.z) : 0;
    if (!is_valid && ++bad <= scene::kMaxReported && !points.skip_bad) {
      faults.error(".motion",
                   fmt::format("{} moves by {} in a frame", row_name(points, rows[i]), scene::vector_text(d)));
    }
  }
  if (bad > 0 && points.skip_bad)
    faults.warning(".motion", fmt::format("{} of {} particles do not move: their motion is not finite, or above {}",
                                          bad, rows.size(), scene::number_text(kLargestDisplacement)));
  else if (bad > 0)
    faults.error(".motion",
                 fmt::format("the motion of {} of {} particles is not finite, or above {}; `skip_bad = true`, "
                             "or --skip-bad, lets them rest",
                             bad, rows.size(), scene::number_text(kLargestDisplacement)));
  return scene::PointArray(scene::NumberArray(std::move(out)));
}

void advance(scene::Points& points, double frames) {
  if (points.to_next.empty() || frames == 0) return;
  for (scene::BondStub& stub : points.bond_stubs)
    stub.end = stub.end + (points.to_next[stub.sphere] + points.to_next[stub.partner]) * (frames / 2);
  for (std::size_t i = 0; i < points.centers.size(); ++i)
    points.centers.set(i, points.centers[i] + points.to_next[i] * frames);
}

}  // namespace orrery::points
