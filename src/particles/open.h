// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "data/data_file.h"

namespace orrery::particles {

/// Opens a data file. Its format is recognised by its content; CSV, TSV and plain XYZ, which have no signature, also by
/// the extension.
///
/// Errors     base::Error: kMissingInput, kIo; kBadData with a remedy for unknown formats, LAZ and ADIOS2; kNoMemory
std::unique_ptr<data::DataFile> open(const std::filesystem::path& file, const data::OpenOptions& options = {});

}  // namespace orrery::particles
