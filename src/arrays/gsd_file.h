// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "data/faults.h"
#include "data/forward.h"
#include "data/number_type.h"

namespace orrery::arrays {

/// A named array of a frame: `rows` times `components` values of one type, row by row.
struct GsdChunk {
  std::uint64_t frame = 0;
  std::uint64_t rows = 0;
  std::uint64_t offset = 0;
  std::uint32_t components = 0;
  std::uint16_t name = 0;  ///< index into the file's list of names
  data::NumberType type = data::NumberType::kUint8;

  std::uint64_t row_bytes() const;
};

/// The file layer of GSD, versions 1 and 2: finds chunks by frame and name.
///
/// Reference  gsd-format
class GsdFile {
 public:
  /// Reads header, index and list of names.
  ///
  /// Errors     base::Error(kBadData): damaged header, index or list of names; chunks beyond the end of the file
  explicit GsdFile(std::shared_ptr<const data::ByteSource> bytes);

  const std::filesystem::path& path() const;
  std::uint64_t memory() const;
  const std::string& schema() const { return schema_; }
  std::uint64_t frame_count() const { return chunks_.empty() ? 0 : chunks_.back().frame + 1; }

  /// Returns the chunk of this name; null if the frame has none.
  const GsdChunk* find(std::uint64_t frame, const std::string& name) const;

  /// Reads one component of all rows.
  data::Values component(const GsdChunk& chunk, std::uint32_t component) const;

  /// Reads all bytes of a chunk.
  std::string raw(const GsdChunk& chunk) const;

 private:
  void read_names(std::uint64_t offset, std::uint64_t size, bool has_fixed_length);
  void read_index(std::uint64_t offset, std::uint64_t count);

  std::shared_ptr<const data::ByteSource> bytes_;
  data::Faults faults_;
  std::string schema_;
  std::unordered_map<std::string, std::uint16_t> ids_;
  std::vector<GsdChunk> chunks_;  ///< ordered by frame
};

}  // namespace orrery::arrays
