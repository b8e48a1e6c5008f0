// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "base/text.h"

namespace orrery::molecules {

/// Checks whether there is enough memory to parse all atoms of a text file at once.
///
/// `bytes`    size of the text
/// `factor`   bytes of memory per byte of text, as measured
/// `held`     bytes that the file takes in memory already
/// `limit`    bytes; 0: none
/// Errors     base::Error(kNoMemory) with the needed size
inline void require_parse_memory(const std::filesystem::path& file, std::uint64_t bytes, double factor,
                                 std::uint64_t held, std::uint64_t limit) {
  const double need = static_cast<double>(bytes) * factor + static_cast<double>(held);
  if (limit == 0 || need <= static_cast<double>(limit)) return;
  throw base::Error(base::ErrorKind::kNoMemory,
                    file.string() + ": " + base::bytes_text(bytes) + " of atoms need about " +
                        base::bytes_text(static_cast<std::uint64_t>(need)) + " while they are read; " +
                        base::bytes_text(limit) + " are available; read the file on a machine with more memory");
}

}  // namespace orrery::molecules
