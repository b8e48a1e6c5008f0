// SPDX-License-Identifier: Apache-2.0
#include "format/write_ply.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/atomic_file.h"

namespace orrery::format {
namespace {

template <class T>
void append_bytes(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big)
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  out.append(bytes, sizeof(T));
}

/// The header up to the comment that names the writer, as in formats::write_table.
std::string header_begin(std::string_view writer) {
  return fmt::format("ply\nformat binary_little_endian 1.0\ncomment made by {}\n", writer);
}

std::string header(const scene::Points& points) {
  std::string out = fmt::format("{}element vertex {}\n", header_begin(kPlyWriter), points.centers.size());
  for (const char* name : {"x", "y", "z", "radius"}) out += fmt::format("property double {}\n", name);
  if (!points.materials.empty()) out += "property uint material\n";
  return out + "end_header\n";
}

}  // namespace

void write_ply(const scene::Points& points, const std::filesystem::path& file) {
  base::OutputFile output(file);
  std::string& out = output.buffer();
  out = header(points);
  for (std::size_t i = 0; i < points.centers.size(); ++i) {
    const math::Vec3d c = points.centers[i];
    for (const double x : {c.x, c.y, c.z, points.radii[i]}) append_bytes(out, x);
    if (!points.materials.empty()) append_bytes(out, points.materials[i]);
    output.flush();
  }
  output.finish();
}

bool is_ply_of(std::string_view writer, const std::filesystem::path& file) {
  const std::string begin = header_begin(writer);
  std::string found(begin.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(found.data(), static_cast<std::streamsize>(found.size())) && found == begin;
}

}  // namespace orrery::format
