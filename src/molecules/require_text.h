// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include <fmt/core.h>

#include "data/byte_source.h"
#include "data/faults.h"

namespace orrery::molecules {

/// Throws an error at the first control character: a file with binary data would lose atoms.
inline void require_text(const data::ByteSource& bytes, data::Faults& faults) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  const auto is_control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && (c < '\t' || c > '\r')) || c == 0x7f;
  };
  std::uint64_t line = 1;
  for (std::uint64_t at = 0; at < bytes.size(); at += kBlock) {
    const std::string block = bytes.text(at, kBlock);
    const auto bad = std::find_if(block.begin(), block.end(), is_control);
    line += static_cast<std::uint64_t>(std::count(block.begin(), bad, '\n'));
    if (bad != block.end())
      faults.fail(line, fmt::format("binary data: a byte of value {}", static_cast<unsigned char>(*bad)),
                  "the file is damaged; download or write it again");
  }
}

}  // namespace orrery::molecules
