// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "job/job.h"

namespace orrery::cli {

/// Warnings about an image and a summary of its render, as whole lines.
std::string report_text(const job::Job& job, const job::JobReport& report, bool verbose);

}  // namespace orrery::cli
