// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::measure {

/// The page of a report, from page/report.html; {{DATA}} stands where a study goes.
extern const char* const kReportPage;

}  // namespace orrery::measure
