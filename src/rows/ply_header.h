// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/number_type.h"

namespace orrery::rows {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  data::NumberType type = data::NumberType::kFloat32;
  bool is_list = false;
  data::NumberType count_type = data::NumberType::kUint8;  ///< type of the list length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  int line = 0;  ///< line of its declaration
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
  std::size_t bytes = 0;  ///< length of the header; the data follow
  int lines = 0;
};

/// Maximum length of a header, bytes: room for ten thousand properties. Avoids scanning a whole file that has no
/// end_header.
inline constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

/// Parses a PLY header.
///
/// Result     an empty string; on failure the fault, with its line number in `line`
std::string parse_ply_header(std::string_view file, PlyHeader& header, int& line);

}  // namespace orrery::rows
