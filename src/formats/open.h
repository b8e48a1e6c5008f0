// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "data/data_file.h"

namespace orrery::formats {

/// Opens a data file. Its format is recognised by its content; CSV, TSV and plain XYZ, which have no signature, also by
/// the extension.
///
/// Errors     base::Error: kMissingInput, kIo; kBadData with a remedy for unknown formats, LAZ and ADIOS2; kNoMemory
std::unique_ptr<data::DataFile> open(const std::filesystem::path& file, const data::OpenOptions& options = {});

/// Returns whether open() recognises a file as a data file.
///
/// `head`     its first bytes: 64 KiB suffice
bool is_data_file(const std::filesystem::path& file, std::string_view head);

}  // namespace orrery::formats
