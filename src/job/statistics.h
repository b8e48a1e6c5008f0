// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "job/job_report.h"

namespace orrery::job {

/// How a job ended.
struct Outcome {
  std::string reason = "completed";  ///< "completed", "stopped", "failed"
  int exit_status = 0;               ///< of the program
  std::string error;                 ///< what it says then; empty where all went well
};

/// What a render did, as JSON; docs/statistics.md is the schema, "orrery.stats/1".
std::string statistics_json(const JobReport& report, const Outcome& outcome);

/// The same into a file.
///
/// Errors     base::Error: kCannotCreate, kIo
void write_statistics(const std::filesystem::path& file, const JobReport& report, const Outcome& outcome);

/// The largest resident memory of this process so far, bytes.
std::size_t peak_memory();

}  // namespace orrery::job
