// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/job.h"

namespace orrery::cli {

/// What somebody should know before trusting the picture, and what was done; whole lines.
std::string report_text(const app::Job& job, const app::JobReport& report, bool verbose);

}  // namespace orrery::cli
