// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orrery::format {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Returns the size of a value in a binary file, bytes.
constexpr std::size_t ply_size(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8: return 1;
    case PlyType::kInt16:
    case PlyType::kUint16: return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32: return 4;
    case PlyType::kFloat64: return 8;
  }
  return 0;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< type of the list length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_list() const {
    for (const PlyProperty& p : properties)
      if (p.is_list) return true;
    return false;
  }
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  ///< length of the header, which the data follow
  int lines = 0;
};

/// Maximum length of a header, bytes: room for ten thousand properties. A file without end_header must not be searched
/// to its end.
inline constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

/// Parses a PLY header.
///
/// Result     an empty string; on failure the fault, with its line number in `line`
std::string parse_ply_header(std::string_view file, PlyHeader& header, int& line);

}  // namespace orrery::format
