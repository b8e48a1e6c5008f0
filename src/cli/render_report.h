// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "job/job.h"

namespace orrery::cli {

/// What somebody should know before trusting the picture, and what was done; whole lines.
std::string report_text(const job::Job& job, const job::JobReport& report, bool verbose);

}  // namespace orrery::cli
