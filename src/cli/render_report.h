// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/job.h"

namespace orrery::cli {

/// Tells on stderr what somebody should know before trusting the picture, and what was done.
void print_report(const app::Job& job, const app::JobReport& report, bool verbose);

}  // namespace orrery::cli
