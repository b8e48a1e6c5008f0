// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "data/forward.h"
#include "rows/ply_cursor.h"

namespace orrery::rows {

/// Returns the minimum size of an element's row, in bytes; exact in a binary file if the element has no lists. Used to
/// check counts before memory is allocated.
std::uint64_t min_bytes(const PlyElement& element, PlyEncoding encoding);

/// Throws an error at the line of an element if fewer bytes follow than its rows need.
void check_count(data::Faults& faults, const PlyElement& element, const PlyHeader& header, std::uint64_t bytes_left);

/// Throws an error at the line of the cursor; in a binary file, at that of the element.
[[noreturn]] void fail_in_row(data::Faults& faults, const PlyElement& element, const PlyCursor& cursor,
                              const std::string& text);

/// Reads one row. Errors refer to its line; in a binary file, to that of the element. Calls `take(property, index)` for
/// each property, which returns false if the value is invalid.
///
/// `name()`   name of the row, for messages
template <class Name, class Take>
void read_row(data::Faults& faults, const PlyElement& element, PlyCursor& cursor, Name name, Take take) {
  cursor.begin_row();
  for (std::size_t k = 0; k < element.properties.size(); ++k)
    if (!take(element.properties[k], k))
      fail_in_row(faults, element, cursor, name() + ", `" + element.properties[k].name + "`: " + cursor.fault());
  if (!cursor.end_row())
    fail_in_row(faults, element, cursor,
                name() + ": unexpected `" + cursor.word() + "` after the last value that the header declares");
}

/// Skips an element other than `vertex`.
void skip_element(data::Faults& faults, const PlyElement& element, const PlyHeader& header, PlyCursor& cursor);

/// Throws an error, at the line of the last element with rows, if data follow the last row that the header declares.
void check_end(data::Faults& faults, const PlyHeader& header, PlyCursor& cursor);

}  // namespace orrery::rows
