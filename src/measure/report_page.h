// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::measure {

/// The HTML template of the report, page/report.html. {{DATA}} marks the place of the study's JSON.
extern const char* const kReportPage;

}  // namespace orrery::measure
