// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "data/table.h"

namespace orrery::particles {

/// Raises base::Error(kUsage): "cannot write FILE: TEXT".
[[noreturn]] void refuse_to_write(const std::filesystem::path& file, const std::string& text);

/// The writers of the formats. They return the names of columns that they omit.
std::vector<std::string> write_ply_table(base::OutputFile& out, const data::Table& table, const std::string& writer);
void write_npy_table(base::OutputFile& out, const data::Table& table);
void write_csv_table(base::OutputFile& out, const data::Table& table);
std::vector<std::string> write_xyz_table(base::OutputFile& out, const data::Table& table);

}  // namespace orrery::particles
