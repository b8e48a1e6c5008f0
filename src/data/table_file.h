// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "data/data_file.h"

namespace orrery::data {

/// Returns a table in memory as a data file of one frame, equivalent to the PLY file that write_table() would write, or
/// to the NPY file if it has columns of strings. Columns that are views stay views.
///
/// `name`     for messages
/// `box`      simulation box, which files of these formats do not have
/// Domain     columns with table.rows rows and distinct names
/// Errors     base::Error(kBadData): there are no columns x, y and z
std::unique_ptr<DataFile> open_table(const std::filesystem::path& name, std::shared_ptr<const Table> table,
                                     const std::optional<Box>& box = {});

}  // namespace orrery::data
