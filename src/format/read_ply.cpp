// SPDX-License-Identifier: Apache-2.0
#include "format/read_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "format/ply_header.h"
#include "format/source_text.h"
#include "scene/validate.h"
#include "scene/value_text.h"

namespace orrery::format {
namespace {

/// A hundred million spheres in doubles with a radius.
constexpr std::uint64_t kLargestFile = std::uint64_t{8} << 30;

template <class T>
double as_double(const char* bytes, bool swap) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (swap)
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(copy[i], copy[sizeof(T) - 1 - i]);
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
}

double binary_value(const char* at, PlyType type, bool swap) {
  switch (type) {
    case PlyType::kInt8: return as_double<std::int8_t>(at, swap);
    case PlyType::kUint8: return as_double<std::uint8_t>(at, swap);
    case PlyType::kInt16: return as_double<std::int16_t>(at, swap);
    case PlyType::kUint16: return as_double<std::uint16_t>(at, swap);
    case PlyType::kInt32: return as_double<std::int32_t>(at, swap);
    case PlyType::kUint32: return as_double<std::uint32_t>(at, swap);
    case PlyType::kFloat32: return as_double<float>(at, swap);
    case PlyType::kFloat64: return as_double<double>(at, swap);
  }
  return 0;
}

/// Takes values one after the other out of the data behind the header.
class PlyCursor {
 public:
  PlyCursor(std::string_view data, PlyEncoding encoding)
      : at_(data.data()),
        end_(data.data() + data.size()),
        ascii_(encoding == PlyEncoding::kAscii),
        swap_((encoding == PlyEncoding::kBigEndian) != (std::endian::native == std::endian::big)) {}

  /// False where the data end, or where an ascii value is no number.
  bool take(PlyType type, double& value) {
    if (ascii_) return take_word(value);
    const std::size_t size = ply_size(type);
    if (static_cast<std::size_t>(end_ - at_) < size) return false;
    value = binary_value(at_, type, swap_);
    at_ += size;
    return true;
  }
  bool skip(const PlyProperty& property) {
    double value = 0;
    if (!property.is_list) return take(property.type, value);
    if (!take(property.count_type, value)) return false;
    is_bad_length_ = !(value >= 0) || value != std::floor(value);
    if (is_bad_length_) return false;
    for (double i = 0; i < value; ++i) {
      double ignored = 0;
      if (!take(property.type, ignored)) return false;  // ends with the data, whatever the count says
    }
    return true;
  }
  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }
  /// Why the last take or skip was false.
  std::string fault() {
    if (is_bad_length_) return "a list's length is no whole number";
    skip_blanks();
    return ascii_ && at_ < end_ ? "what stands there is no number" : "the file ends";
  }

 private:
  void skip_blanks() {
    while (at_ < end_ && (*at_ == ' ' || (*at_ >= '\t' && *at_ <= '\r'))) ++at_;
  }
  bool take_word(double& value) {
    skip_blanks();
    const char* const begin = at_ < end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [end, error] = std::from_chars(begin, end_, value);
    if (error == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
    if (end == begin || error == std::errc::invalid_argument) return false;
    at_ = end;
    return true;
  }

  const char* at_;
  const char* end_;
  bool ascii_, swap_, is_bad_length_ = false;
};

/// Collects findings of one file.
class PlyFaults {
 public:
  explicit PlyFaults(const std::filesystem::path& file) : file_(file.string()) {}

  void add(int line, const std::string& text) {
    base::Finding finding;
    finding.file = file_;
    finding.line = line;
    finding.text = text;
    findings_.push_back(std::move(finding));
  }
  void add_of_many(const std::string& text) {
    if (++many_ <= scene::kMostTold) add(0, text);
  }
  [[noreturn]] void fail(int line, const std::string& text) {
    add(line, text);
    raise();
  }
  void raise_if_any() {
    if (many_ > scene::kMostTold)
      add(0, "and " + std::to_string(many_ - scene::kMostTold) + " more (" + std::to_string(many_) + " in all)");
    if (!findings_.empty()) raise();
  }

 private:
  [[noreturn]] void raise() {
    throw base::Error(base::ErrorKind::kBadData, "cannot use " + file_, std::move(findings_));
  }
  std::string file_;
  std::vector<base::Finding> findings_;
  std::uint64_t many_ = 0;
};

/// Where in a vertex the values stand that we want; -1: nowhere.
struct VertexLayout {
  int x = -1, y = -1, z = -1, radius = -1, material = -1;
};

constexpr std::array<std::string_view, 3> kRadiusNames = {"radius", "scalar_radius", "r"};

VertexLayout layout_of(const PlyElement& vertex) {
  VertexLayout layout;
  std::size_t radius_rank = kRadiusNames.size();
  for (int i = 0; i < static_cast<int>(vertex.properties.size()); ++i) {
    const PlyProperty& p = vertex.properties[static_cast<std::size_t>(i)];
    if (p.is_list) continue;
    if (p.name == "x") layout.x = i;
    if (p.name == "y") layout.y = i;
    if (p.name == "z") layout.z = i;
    if (p.name == "material") layout.material = i;
    // In this order: a file with `r` for red has its `radius` under that name.
    for (std::size_t k = 0; k < kRadiusNames.size(); ++k)
      if (p.name == kRadiusNames[k] && k < radius_rank) {
        layout.radius = i;
        radius_rank = k;
      }
  }
  return layout;
}

/// The fewest bytes that one row of an element can take: what a lying count is held against before memory is asked for.
std::uint64_t fewest_bytes(const PlyElement& element, PlyEncoding encoding) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties)
    bytes += encoding == PlyEncoding::kAscii ? 2 : p.is_list ? ply_size(p.count_type) : ply_size(p.type);
  return bytes;
}

void check_count(PlyFaults& faults, const PlyElement& element, const PlyHeader& header, std::uint64_t bytes_left) {
  const std::uint64_t each = std::max<std::uint64_t>(1, fewest_bytes(element, header.encoding));
  // The last ascii word needs no space behind it.
  const std::uint64_t bytes = bytes_left + (header.encoding == PlyEncoding::kAscii ? 1 : 0);
  if (element.count > bytes / each)
    faults.fail(0, "the header promises " + std::to_string(element.count) + " of `" + element.name + "`, but only " +
                       std::to_string(bytes_left) + " bytes follow; the file is cut off, or its count is wrong");
}

void read_vertices(PlyFaults& faults, const PlyElement& vertex, PlyCursor& cursor, std::size_t material_count,
                   scene::Points& points) {
  const VertexLayout at = layout_of(vertex);
  if (at.x < 0 || at.y < 0 || at.z < 0) faults.fail(0, "`vertex` has no x, y and z");
  if (at.radius < 0 && !points.radius)
    faults.fail(0, "`vertex` has no `radius`; add one, or set `radius` in [[points]]");
  const auto count = static_cast<std::size_t>(vertex.count);
  points.centers.resize(count);
  points.radii.resize(count);
  if (at.material >= 0) points.materials.resize(count);
  std::vector<double> row(vertex.properties.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const PlyProperty& property = vertex.properties[k];
      const bool good = property.is_list ? cursor.skip(property) : cursor.take(property.type, row[k]);
      if (!good)
        faults.fail(0, "vertex " + std::to_string(i) + " of " + std::to_string(count) + ", `" + property.name +
                           "`: " + cursor.fault());
    }
    const auto value = [&](int property) { return row[static_cast<std::size_t>(property)]; };
    points.centers[i] = {value(at.x), value(at.y), value(at.z)};
    points.radii[i] = points.radius ? *points.radius : value(at.radius);
    if (!math::is_finite(points.centers[i]) || !std::isfinite(points.radii[i]))
      faults.add_of_many("vertex " + std::to_string(i) + " has a number that is not finite");
    if (at.material < 0) continue;
    const double material = value(at.material);
    if (!(material >= 0 && material < static_cast<double>(material_count)) || material != std::floor(material)) {
      faults.add_of_many("vertex " + std::to_string(i) + " has material " + scene::number_text(material) +
                         "; the scene has " + std::to_string(material_count) + ", counted from 0");
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
  PlyCursor cursor(std::string_view(bytes).substr(header.bytes), header.encoding);
  for (const PlyElement& element : header.elements) {
    check_count(faults, element, header, cursor.bytes_left());
    if (element.name == "vertex") {
      scene::Points read;
      read.radius = points.radius;
      read_vertices(faults, element, cursor, material_count, read);
      faults.raise_if_any();
      points.centers = std::move(read.centers);
      points.radii = std::move(read.radii);
      points.materials = std::move(read.materials);
      return;  // what follows is not ours
    }
    if (element.properties.empty()) continue;
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
        if (!cursor.skip(property))
          faults.fail(0, "element `" + element.name + "`, row " + std::to_string(i) + ": " + cursor.fault());
  }
  faults.fail(0, "there is no element `vertex`");
}

}  // namespace orrery::format
