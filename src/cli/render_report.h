// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "job/forward.h"

namespace orrery::cli {

/// Optional contents of the summary of a render, in addition to files, samples and render time.
struct ReportDetail {
  bool is_verbose = false;  ///< time of each phase, accelerator, display
  bool has_total = false;   ///< time of the whole job
};

/// Warnings about an image and a summary of its render, as whole lines.
std::string report_text(const job::Job& job, const job::JobReport& report, ReportDetail detail);

}  // namespace orrery::cli
