// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "data/table.h"

namespace orrery::particles {

/// Throws base::Error(kUsage): "cannot write FILE: TEXT".
[[noreturn]] void refuse_to_write(const std::filesystem::path& file, const std::string& text);

/// One writer per format. Returns the names of the columns that it omits.
std::vector<std::string> write_ply_table(base::OutputFile& out, const data::Table& table, const std::string& writer);
void write_npy_table(base::OutputFile& out, const data::Table& table);
void write_csv_table(base::OutputFile& out, const data::Table& table);
std::vector<std::string> write_xyz_table(base::OutputFile& out, const data::Table& table);

}  // namespace orrery::particles
