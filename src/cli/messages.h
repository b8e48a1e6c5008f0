// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::cli {

/// Says something on stderr, and in the log where there is one.
///
/// Domain     whole lines
void tell(const std::string& text);

/// What is only for the log, as what a job begins with.
void tell_log(const std::string& text);

/// From now on every line that is told stands in this file, too, behind its time, in UTC, and the number of the
/// process. Lines are appended whole: several processes may share a log.
///
/// Errors     base::Error(kCannotCreate)
void open_log(const std::filesystem::path& file);

}  // namespace orrery::cli
