// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "data/byte_source.h"

namespace orrery::data {

/// Reads the members of a ZIP archive one after another.
class ZipReader {
 public:
  /// Starts before the first member.
  ///
  /// Domain     `bytes` outlives this object
  explicit ZipReader(const ByteSource& bytes);
  ~ZipReader();
  ZipReader(const ZipReader&) = delete;
  ZipReader& operator=(const ZipReader&) = delete;

  /// Advances to the next member; false at the end.
  ///
  /// Errors     base::Error(kBadData) if the archive is damaged
  bool next();
  /// Returns the name of the member.
  const std::string& name() const { return name_; }
  /// Reads the next bytes of the member, fewer than `count` only at its end.
  ///
  /// Errors     as for next()
  /// Cost       memory for the bytes that exist, not for `count`
  ByteBlocks read(std::uint64_t count);
  /// The same as text, for the header of a member.
  std::string read_text(std::size_t count);

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::string name_;
};

}  // namespace orrery::data
