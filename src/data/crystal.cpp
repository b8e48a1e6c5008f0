// SPDX-License-Identifier: Apache-2.0
#include "data/crystal.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <gemmi/symmetry.hpp>
#include <gemmi/unitcell.hpp>
#include <utility>

#include "base/text.h"
#include "data/text_lines.h"

namespace orrery::data {
namespace {

Operators operators_of(const gemmi::GroupOps& group) {
  constexpr double kUnit = 1.0 / gemmi::Op::DEN;
  const auto row = [&](const std::array<int, 3>& r) { return Vec3d{r[0] * kUnit, r[1] * kUnit, r[2] * kUnit}; };
  Operators out;
  for (const gemmi::Op& op : group) out.push_back({{row(op.rot[0]), row(op.rot[1]), row(op.rot[2])}, row(op.tran)});
  return out;
}

/// Reads one coordinate of an operator: terms with signs, each a number, an axis, or a number times an axis.
bool read_coordinate(std::string_view text, Vec3d& row, double& shift) {
  bool is_first = true;
  const auto take = [&](char c) {
    text = trimmed(text);
    if (!text.starts_with(c)) return false;
    text.remove_prefix(1);
    return true;
  };
  const auto take_number = [&](double& number) {
    text = trimmed(text);
    const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
    if (!base::from_text(text.substr(0, digits), number)) return false;
    text.remove_prefix(digits);
    return true;
  };
  for (text = trimmed(text); !text.empty(); is_first = false, text = trimmed(text)) {
    const bool is_negative = take('-');
    if (!is_negative && !take('+') && !is_first) return false;
    double factor = 1, divisor = 1;
    const bool has_number = take_number(factor);
    if (has_number && take('/') && !take_number(divisor)) return false;
    if (has_number) take('*');
    text = trimmed(text);
    const std::size_t axis = text.empty() ? std::string_view::npos : std::string_view("xyzXYZ").find(text[0]);
    const bool has_axis = axis != std::string_view::npos;
    if (has_axis) text.remove_prefix(1);
    if (has_axis && take('/') && !take_number(divisor)) return false;
    if ((!has_axis && !has_number) || divisor == 0) return false;
    double& to = !has_axis ? shift : axis % 3 == 0 ? row.x : axis % 3 == 1 ? row.y : row.z;
    to += (is_negative ? -factor : factor) / divisor;
  }
  return !is_first;
}

}  // namespace

std::optional<Box> cell_box(const std::array<double, 6>& cell) {
  gemmi::UnitCell unit;
  try {
    unit.set(cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]);
  } catch (const std::exception&) {
    return std::nullopt;  // an angle of a multiple of 180 degrees
  }
  if (!unit.is_crystal() || !(unit.volume > 0)) return std::nullopt;
  Box box;
  for (std::size_t i = 0; i < 3; ++i) {
    const gemmi::Vec3 edge = unit.orth.mat.column_copy(static_cast<int>(i));
    box.edges[i] = {edge.x, edge.y, edge.z};
    if (!math::is_finite(box.edges[i])) return std::nullopt;
  }
  return box;
}

std::optional<Transform> operator_of(std::string_view text) {
  Transform out{{Vec3d{0, 0, 0}, Vec3d{0, 0, 0}, Vec3d{0, 0, 0}}, {0, 0, 0}};
  const std::vector<std::string_view> parts = words_of(text, ",");
  double* const shifts[] = {&out.translation.x, &out.translation.y, &out.translation.z};
  if (parts.size() != 3) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i)
    if (!read_coordinate(parts[i], out.rows[i], *shifts[i])) return std::nullopt;
  return out;
}

std::optional<Operators> operators_of_hall(const std::string& symbol) {
  for (const gemmi::SpaceGroup& group : gemmi::spacegroup_tables::main)
    if (words_of(group.hall) == words_of(symbol)) return operators_of(group.operations());
  return std::nullopt;
}

std::optional<Operators> operators_of_group(const std::string& name, const std::array<double, 6>& cell) {
  const gemmi::SpaceGroup* group = gemmi::find_spacegroup_by_name(name, cell[3], cell[5]);
  // A number does not say which axes a rhombohedral cell has; the symbol with the angles does.
  if (int number = 0; group != nullptr && base::from_text(name, number))
    group = gemmi::find_spacegroup_by_name(group->hm, cell[3], cell[5]);
  return group == nullptr ? std::nullopt : std::optional(operators_of(group->operations()));
}

std::vector<Vec3d> images_in_cell(Vec3d point, const Operators& operators, const Box& box) {
  // Atoms on two sides of a mirror that are closer than this are one atom, at either of two places.
  constexpr double kSamePlace = 0.4;
  const auto wrapped = [](double x) {
    x -= std::floor(x);
    return x < 1 ? x : 0;  // -1e-20 rounds to 1
  };
  const auto to_nearest = [](Vec3d d) {
    return Vec3d{d.x - std::nearbyint(d.x), d.y - std::nearbyint(d.y), d.z - std::nearbyint(d.z)};
  };
  Box origin_free = box;
  origin_free.origin = {0, 0, 0};
  std::vector<Vec3d> out;
  for (const Transform& op : operators) {
    const Vec3d at{wrapped(math::dot(op.rows[0], point) + op.translation.x),
                   wrapped(math::dot(op.rows[1], point) + op.translation.y),
                   wrapped(math::dot(op.rows[2], point) + op.translation.z)};
    if (std::none_of(out.begin(), out.end(), [&](Vec3d other) {
          return math::length(point_in(origin_free, to_nearest(at - other))) < kSamePlace;
        }))
      out.push_back(at);
  }
  return out;
}

}  // namespace orrery::data
