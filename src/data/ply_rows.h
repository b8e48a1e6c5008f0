// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "data/faults.h"
#include "data/ply_cursor.h"
#include "data/ply_header.h"

namespace orrery::data {

/// Returns the minimum size of an element's row, in bytes; exact in a binary file if the element has no lists. Used to
/// check counts before memory is allocated.
std::uint64_t min_bytes(const PlyElement& element, PlyEncoding encoding);

/// Raises an error at the line of an element if fewer bytes follow than its rows need.
void check_count(Faults& faults, const PlyElement& element, const PlyHeader& header, std::uint64_t bytes_left);

/// Reads one row. Errors have its line, in a binary file that of the element. Calls `take(property, index)` for each
/// property, which returns false if the value is invalid.
///
/// `name()`   name of the row, for messages
template <class Name, class Take>
void read_row(Faults& faults, const PlyElement& element, PlyCursor& cursor, Name name, Take take) {
  const auto line = [&] { return static_cast<std::uint64_t>(cursor.line() > 0 ? cursor.line() : element.line); };
  cursor.begin_row();
  for (std::size_t k = 0; k < element.properties.size(); ++k)
    if (!take(element.properties[k], k))
      faults.fail(line(), name() + ", `" + element.properties[k].name + "`: " + cursor.fault());
  if (!cursor.end_row())
    faults.fail(line(), name() + ": unexpected `" + cursor.word() + "` after the last value that the header declares");
}

/// Skips an element other than `vertex`.
void skip_element(Faults& faults, const PlyElement& element, const PlyHeader& header, PlyCursor& cursor);

/// Raises an error if data follow the last row that the header declares, at the line of the last element with rows.
void check_end(Faults& faults, const PlyHeader& header, PlyCursor& cursor);

}  // namespace orrery::data
