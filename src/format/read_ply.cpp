// SPDX-License-Identifier: Apache-2.0
#include "format/read_ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "data/faults.h"
#include "data/ply_rows.h"
#include "format/source_text.h"
#include "scene/validate.h"
#include "scene/value_text.h"

namespace orrery::format {
namespace {

/// Maximum size of a points file, bytes: room for a hundred million spheres in double precision.
constexpr std::uint64_t kLargestFile = std::uint64_t{8} << 30;

/// Indices of the properties that are used in a vertex; -1: absent.
struct VertexLayout {
  int x = -1, y = -1, z = -1, radius = -1, material = -1;
  bool r_is_color = false;

  bool uses(int property) const {
    return property == x || property == y || property == z || property == radius || property == material;
  }
};

constexpr std::array<std::string_view, 3> kRadiusNames = {"radius", "scalar_radius", "r"};

VertexLayout layout_of(const data::PlyElement& vertex) {
  VertexLayout layout;
  const auto has = [&](const char* name) {
    return std::any_of(vertex.properties.begin(), vertex.properties.end(),
                       [&](const data::PlyProperty& p) { return p.name == name; });
  };
  layout.r_is_color = has("r") && has("g") && has("b");
  std::size_t radius_rank = kRadiusNames.size();
  for (int i = 0; i < static_cast<int>(vertex.properties.size()); ++i) {
    const data::PlyProperty& p = vertex.properties[static_cast<std::size_t>(i)];
    if (p.is_list) continue;
    if (p.name == "x") layout.x = i;
    if (p.name == "y") layout.y = i;
    if (p.name == "z") layout.z = i;
    if (p.name == "material") layout.material = i;
    if (p.name == "r" && layout.r_is_color) continue;
    for (std::size_t k = 0; k < kRadiusNames.size(); ++k)
      if (p.name == kRadiusNames[k] && k < radius_rank) {
        layout.radius = i;
        radius_rank = k;
      }
  }
  return layout;
}

void read_vertices(data::Faults& faults, const data::PlyElement& vertex, data::PlyCursor& cursor,
                   std::size_t material_count, scene::Points& points) {
  const VertexLayout at = layout_of(vertex);
  if (at.x < 0 || at.y < 0 || at.z < 0) faults.fail(0, "`vertex` needs x, y and z");
  if (at.radius < 0 && !points.radius)
    faults.fail(0, std::string("`vertex` has no `radius`") +
                       (at.r_is_color ? ", and `r` is a colour because of `g` and `b`" : "") +
                       "; add one, or set `radius` in [[points]]");
  for (std::size_t k = 0; k < vertex.properties.size(); ++k)
    if (!at.uses(static_cast<int>(k))) points.unused.push_back(vertex.properties[k].name);
  const auto count = static_cast<std::size_t>(vertex.count);
  points.centers.resize(count);
  points.radii.resize(count);
  if (at.material >= 0) points.materials.resize(count);
  std::vector<double> row(vertex.properties.size());
  for (std::size_t i = 0; i < count; ++i) {
    data::read_row(
        faults, vertex, cursor, [&] { return "vertex " + std::to_string(i) + " of " + std::to_string(count); },
        [&](const data::PlyProperty& property, std::size_t k) {
          return property.is_list ? cursor.skip(property) : cursor.take(property.type, row[k]);
        });
    const auto line = static_cast<std::uint64_t>(cursor.line());
    const auto value = [&](int property) { return row[static_cast<std::size_t>(property)]; };
    points.centers[i] = {value(at.x), value(at.y), value(at.z)};
    points.radii[i] = points.radius ? *points.radius : value(at.radius);
    if (!math::is_finite(points.centers[i]) || !std::isfinite(points.radii[i]))
      faults.add_of_many(line, "vertex " + std::to_string(i) + " has a non-finite value");
    if (at.material < 0) continue;
    const double material = value(at.material);
    if (!(material >= 0 && material < static_cast<double>(material_count)) || material != std::floor(material)) {
      faults.add_of_many(line, "vertex " + std::to_string(i) + " has material " + scene::number_text(material) +
                                   "; the scene has " + std::to_string(material_count) + ", counted from 0");
    } else {
      points.materials[i] = static_cast<std::uint32_t>(material);
    }
  }
}

}  // namespace

void read_ply(const std::filesystem::path& file, std::size_t material_count, scene::Points& points) {
  const std::string bytes = read_file(file, kLargestFile);
  data::Faults faults(file);
  data::PlyHeader header;
  int line = 0;
  if (const std::string fault = data::parse_ply_header(bytes, header, line); !fault.empty())
    faults.fail(static_cast<std::uint64_t>(line), fault);
  data::PlyCursor cursor(std::string_view(bytes).substr(header.bytes), header.encoding, header.lines + 1);
  scene::Points read;
  read.radius = points.radius;
  bool has_vertices = false;
  for (const data::PlyElement& element : header.elements) {
    data::check_count(faults, element, header, cursor.bytes_left());
    if (element.name != "vertex") {
      data::skip_element(faults, element, header, cursor);
      continue;
    }
    has_vertices = true;
    read_vertices(faults, element, cursor, material_count, read);
  }
  if (!has_vertices) faults.fail(0, "there is no element `vertex`");
  faults.raise_if_any();
  data::check_end(faults, cursor);
  points.centers = std::move(read.centers);
  points.radii = std::move(read.radii);
  points.materials = std::move(read.materials);
  points.unused = std::move(read.unused);
}

}  // namespace orrery::format
