// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "job/job.h"

namespace orrery::job {

/// Statistics of a job as JSON, schema "orrery.stats/1": docs/statistics.md.
///
/// `error`    that ended the job; null: it is complete
std::string statistics_json(const JobReport& report, const base::Error* error = nullptr);

/// Writes statistics_json to a file.
///
/// Errors     base::Error: kCannotCreate, kIo
void write_statistics(const std::filesystem::path& file, const JobReport& report, const base::Error* error = nullptr);

/// Writes the statistics of a job that ended with an error, if it has a file for them. Errors of writing are dropped.
void write_failure(const std::filesystem::path& file, const JobReport& report, const base::Error& error);

}  // namespace orrery::job
