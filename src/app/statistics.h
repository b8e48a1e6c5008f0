// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "app/job.h"

namespace orrery::app {

/// Writes what a render did as JSON; docs/statistics.md is the schema, "orrery.stats/1".
///
/// Errors     base::Error: kCannotCreate, kIo
void write_statistics(const std::filesystem::path& file, const JobReport& report, const std::string& exit_reason);

/// The largest resident memory of this process so far, bytes.
std::size_t peak_memory();

}  // namespace orrery::app
