// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "job/forward.h"

namespace orrery::cli {

/// What the summary of a render has beside the files, the samples and the seconds of rendering.
struct ReportDetail {
  bool is_verbose = false;  ///< seconds of each phase, accelerator, display
  bool has_total = false;   ///< seconds of the whole job
};

/// Warnings about an image and a summary of its render, as whole lines.
std::string report_text(const job::Job& job, const job::JobReport& report, ReportDetail detail);

}  // namespace orrery::cli
