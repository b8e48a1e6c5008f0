// SPDX-License-Identifier: Apache-2.0
#include "rows/ply_rows.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "data/byte_source.h"
#include "data/faults.h"

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

std::uint64_t min_bytes(const PlyElement& element, PlyEncoding encoding) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties)
    bytes += encoding == PlyEncoding::kAscii ? 2 : p.is_list ? size_of(p.count_type) : size_of(p.type);
  return bytes;
}

void check_count(Faults& faults, const PlyElement& element, const PlyHeader& header, std::uint64_t bytes_left) {
  const std::uint64_t each = std::max<std::uint64_t>(1, min_bytes(element, header.encoding));
  // The last ASCII word need not be followed by a space.
  const std::uint64_t bytes = bytes_left + (header.encoding == PlyEncoding::kAscii ? 1 : 0);
  if (element.count > bytes / each)
    faults.fail(static_cast<std::uint64_t>(element.line),
                fmt::format("the header declares {} rows of `{}`, but only {} bytes follow; the file is truncated, or "
                            "the count is wrong",
                            element.count, element.name, bytes_left));
}

void fail_in_row(Faults& faults, const PlyElement& element, const PlyCursor& cursor, const std::string& text) {
  faults.fail(static_cast<std::uint64_t>(cursor.line() > 0 ? cursor.line() : element.line), text);
}

void skip_element(Faults& faults, const PlyElement& element, const PlyHeader& header, PlyCursor& cursor) {
  if (element.properties.empty()) return;
  if (header.encoding != PlyEncoding::kAscii && !element.has_list())
    return cursor.skip_bytes(element.count * min_bytes(element, header.encoding));
  for (std::uint64_t i = 0; i < element.count; ++i)
    read_row(
        faults, element, cursor, [&] { return fmt::format("row {} of `{}`", i + 1, element.name); },
        [&](const PlyProperty& property, std::size_t) { return cursor.skip(property); });
}

void check_end(Faults& faults, const PlyHeader& header, PlyCursor& cursor) {
  cursor.begin_row();
  if (cursor.bytes_left() == 0) return;
  const auto last = std::find_if(header.elements.rbegin(), header.elements.rend(),
                                 [](const PlyElement& element) { return element.count > 0; });
  const PlyElement& element = last != header.elements.rend() ? *last : header.elements.back();
  faults.fail(static_cast<std::uint64_t>(element.line),
              fmt::format("{} bytes follow the last row that the header declares; the counts are wrong, or the "
                          "file is damaged",
                          cursor.bytes_left()));
}

}  // namespace orrery::rows
