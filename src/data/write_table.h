// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "data/table.h"

namespace orrery::data {

/// Checks that the extension of a file selects a format of write_table(): .ply, .xyz, .npy, .csv.
///
/// Errors     base::Error(kUsage) for another extension
void require_table_format(const std::filesystem::path& file);

/// Whether PLY can store a column: numbers, but not integers beyond 2^53, with a name without spaces.
bool is_storable_in_ply(const Column& column);

/// What a frame has beside its rows. Only .xyz stores it.
struct FrameHeader {
  std::optional<Box> box;
  std::optional<double> step;
};

/// Writes a table. Reading the file with open() gives the same values.
///
/// - .ply: binary, little-endian. It cannot store strings, nor integers beyond 2^53.
/// - .xyz: extended XYZ, with the box and the time step. Columns x, y, z are `pos`; name[1], name[2] .. are one
/// property
///   `name`. It cannot store empty strings, spaces or quotes.
/// - .npy: a structured array.
/// - .csv: a header row; strings are quoted, and numbers have as many digits as needed.
///
/// Text formats do not preserve number types: reading returns float64 or int64. An integer column of a CSV file is read
/// as int64 only if float64 cannot represent all of its values.
///
/// `writer`   program name for the header comment of .ply
/// Domain     columns x, y, z of numbers; all columns have table.rows rows and distinct names
/// Result     names of the columns that were omitted because the format cannot store their values
/// Errors     base::Error: kUsage for another extension, and for values that the format cannot store, with a remedy;
///            kCannotCreate; kIo
[[nodiscard]] std::vector<std::string> write_table(const std::filesystem::path& file, const Table& table,
                                                   const FrameHeader& header = {},
                                                   const std::string& writer = "orrery");

}  // namespace orrery::data
