// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "data/byte_source.h"
#include "data/number_type.h"

namespace orrery::arrays {

/// How the binary arrays of a VTK file are stored.
struct VtkStorage {
  bool is_big_endian = false;
  bool has_long_headers = false;  ///< header_type is UInt64
  bool is_compressed = false;     ///< with zlib, in blocks
  std::uint64_t limit = 0;        ///< maximum size of the decompressed data of an array, bytes
};

/// The numbers of an array: a range of a file or of memory.
struct VtkBytes {
  std::shared_ptr<const data::ByteSource> source;
  std::uint64_t begin = 0;
  std::uint64_t size = 0;
  bool is_big_endian = false;
};

/// Finds the raw array at an offset of a file, and decompresses it.
///
/// Result     an empty string, or what is wrong
/// Cost       memory for the bytes that exist, regardless of the size that the array's header declares; none if it is
///            not compressed
std::string find_vtk_raw(const std::shared_ptr<const data::ByteSource>& file, std::uint64_t offset,
                         const VtkStorage& storage, VtkBytes& out);

/// Decodes an array in base64, and decompresses it. `file` is for messages.
///
/// Result     as for find_vtk_raw()
std::string decode_vtk_base64(const std::filesystem::path& file, std::string_view text, const VtkStorage& storage,
                              VtkBytes& out);

/// Parses numbers of a type, separated by white space.
///
/// Result     as for find_vtk_raw()
std::string parse_vtk_ascii(const std::filesystem::path& file, std::string_view text, data::NumberType type,
                            VtkBytes& out);

}  // namespace orrery::arrays
