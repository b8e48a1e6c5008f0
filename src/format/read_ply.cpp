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
#include "format/ply_cursor.h"
#include "format/ply_header.h"
#include "format/source_text.h"
#include "scene/validate.h"
#include "scene/value_text.h"

namespace orrery::format {
namespace {

/// Maximum size of a points file, bytes: room for a hundred million spheres in double precision.
constexpr std::uint64_t kLargestFile = std::uint64_t{8} << 30;

/// Collects the diagnostics of one file.
class PlyFaults {
 public:
  explicit PlyFaults(const std::filesystem::path& file) : file_(file.string()) {}

  void add(int line, const std::string& text) {
    base::Diagnostic diagnostic;
    diagnostic.file = file_;
    diagnostic.line = line;
    diagnostic.text = text;
    diagnostics_.push_back(std::move(diagnostic));
  }
  void add_of_many(int line, const std::string& text) {
    if (++many_ <= scene::kMaxReported) add(line, text);
  }
  [[noreturn]] void fail(int line, const std::string& text) {
    add(line, text);
    raise();
  }
  void raise_if_any() {
    if (many_ > scene::kMaxReported)
      add(0, "and " + std::to_string(many_ - scene::kMaxReported) + " more (" + std::to_string(many_) + " in all)");
    if (!diagnostics_.empty()) raise();
  }

 private:
  [[noreturn]] void raise() {
    throw base::Error(base::ErrorKind::kBadData, "cannot use " + file_, std::move(diagnostics_));
  }
  std::string file_;
  std::vector<base::Diagnostic> diagnostics_;
  std::uint64_t many_ = 0;
};

/// Indices of the properties that are used in a vertex; -1: absent.
struct VertexLayout {
  int x = -1, y = -1, z = -1, radius = -1, material = -1;
  bool r_is_color = false;

  bool uses(int property) const {
    return property == x || property == y || property == z || property == radius || property == material;
  }
};

constexpr std::array<std::string_view, 3> kRadiusNames = {"radius", "scalar_radius", "r"};

VertexLayout layout_of(const PlyElement& vertex) {
  VertexLayout layout;
  const auto has = [&](const char* name) {
    return std::any_of(vertex.properties.begin(), vertex.properties.end(),
                       [&](const PlyProperty& p) { return p.name == name; });
  };
  layout.r_is_color = has("r") && has("g") && has("b");
  std::size_t radius_rank = kRadiusNames.size();
  for (int i = 0; i < static_cast<int>(vertex.properties.size()); ++i) {
    const PlyProperty& p = vertex.properties[static_cast<std::size_t>(i)];
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

/// Returns the minimum size of a row of an element, bytes, to check counts before memory is allocated.
std::uint64_t fewest_bytes(const PlyElement& element, PlyEncoding encoding) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties)
    bytes += encoding == PlyEncoding::kAscii ? 2 : p.is_list ? ply_size(p.count_type) : ply_size(p.type);
  return bytes;
}

void check_count(PlyFaults& faults, const PlyElement& element, const PlyHeader& header, std::uint64_t bytes_left) {
  const std::uint64_t each = std::max<std::uint64_t>(1, fewest_bytes(element, header.encoding));
  // The last ascii word needs no space after it.
  const std::uint64_t bytes = bytes_left + (header.encoding == PlyEncoding::kAscii ? 1 : 0);
  if (element.count > bytes / each)
    faults.fail(0, "the header declares " + std::to_string(element.count) + " rows of `" + element.name +
                       "`, but only " + std::to_string(bytes_left) +
                       " bytes follow; the file is truncated, or the count is wrong");
}

/// Reads one row: calls `take(property, index)` for each property, which returns false if the value is invalid.
///
/// `name()`   name of the row, for messages
template <class Name, class Take>
void read_row(PlyFaults& faults, const PlyElement& element, PlyCursor& cursor, Name name, Take take) {
  cursor.begin_row();
  for (std::size_t k = 0; k < element.properties.size(); ++k)
    if (!take(element.properties[k], k))
      faults.fail(cursor.line(), name() + ", `" + element.properties[k].name + "`: " + cursor.fault());
  if (!cursor.end_row())
    faults.fail(cursor.line(),
                name() + ": unexpected `" + cursor.word() + "` after the last value that the header declares");
}

/// Skips an element other than `vertex`.
void skip_element(PlyFaults& faults, const PlyElement& element, const PlyHeader& header, PlyCursor& cursor) {
  if (element.properties.empty()) return;
  if (header.encoding != PlyEncoding::kAscii && !element.has_list())
    return cursor.skip_bytes(element.count * fewest_bytes(element, header.encoding));
  for (std::uint64_t i = 0; i < element.count; ++i)
    read_row(
        faults, element, cursor, [&] { return "row " + std::to_string(i) + " of `" + element.name + "`"; },
        [&](const PlyProperty& property, std::size_t) { return cursor.skip(property); });
}

/// Reports data after the last row that the header declares.
void check_end(PlyFaults& faults, PlyCursor& cursor) {
  cursor.begin_row();
  if (cursor.bytes_left() == 0) return;
  faults.fail(cursor.line(), std::to_string(cursor.bytes_left()) +
                                 " bytes follow the last row that the header declares; the counts are wrong, or the "
                                 "file is damaged");
}

void read_vertices(PlyFaults& faults, const PlyElement& vertex, PlyCursor& cursor, std::size_t material_count,
                   scene::Points& points) {
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
    read_row(
        faults, vertex, cursor, [&] { return "vertex " + std::to_string(i) + " of " + std::to_string(count); },
        [&](const PlyProperty& property, std::size_t k) {
          return property.is_list ? cursor.skip(property) : cursor.take(property.type, row[k]);
        });
    const auto value = [&](int property) { return row[static_cast<std::size_t>(property)]; };
    points.centers[i] = {value(at.x), value(at.y), value(at.z)};
    points.radii[i] = points.radius ? *points.radius : value(at.radius);
    if (!math::is_finite(points.centers[i]) || !std::isfinite(points.radii[i]))
      faults.add_of_many(cursor.line(), "vertex " + std::to_string(i) + " has a non-finite value");
    if (at.material < 0) continue;
    const double material = value(at.material);
    if (!(material >= 0 && material < static_cast<double>(material_count)) || material != std::floor(material)) {
      faults.add_of_many(cursor.line(), "vertex " + std::to_string(i) + " has material " +
                                            scene::number_text(material) + "; the scene has " +
                                            std::to_string(material_count) + ", counted from 0");
    } else {
      points.materials[i] = static_cast<std::uint32_t>(material);
    }
  }
}

}  // namespace

void read_ply(const std::filesystem::path& file, std::size_t material_count, scene::Points& points) {
  const std::string bytes = read_file(file, kLargestFile);
  PlyFaults faults(file);
  PlyHeader header;
  int line = 0;
  if (const std::string fault = parse_ply_header(bytes, header, line); !fault.empty()) faults.fail(line, fault);
  PlyCursor cursor(std::string_view(bytes).substr(header.bytes), header.encoding, header.lines + 1);
  scene::Points read;
  read.radius = points.radius;
  bool has_vertices = false;
  for (const PlyElement& element : header.elements) {
    check_count(faults, element, header, cursor.bytes_left());
    if (element.name != "vertex") {
      skip_element(faults, element, header, cursor);
      continue;
    }
    has_vertices = true;
    read_vertices(faults, element, cursor, material_count, read);
  }
  if (!has_vertices) faults.fail(0, "there is no element `vertex`");
  faults.raise_if_any();
  check_end(faults, cursor);
  points.centers = std::move(read.centers);
  points.radii = std::move(read.radii);
  points.materials = std::move(read.materials);
  points.unused = std::move(read.unused);
}

}  // namespace orrery::format
