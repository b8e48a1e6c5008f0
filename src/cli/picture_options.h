// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "job/forward.h"

namespace orrery::cli {

class Command;

/// Heading of these options in the help.
inline constexpr const char* kImageOptions = "Image options";

/// The options that select a job's image files and their formats.
class PictureOptions {
 public:
  /// Adds the options to a command.
  ///
  /// `allows_deep`  adds --deep
  /// Domain         called once; neither this nor `job` moves until the command line is parsed
  void add_to(Command& command, job::Job& job, bool allows_deep = true);

  /// Returns a warning for each kind of option that affects none of the files, one per line.
  ///
  /// `shows_display`  a preview or a legend uses the display transform
  std::string unused_options(const job::Job& job, bool shows_display) const;

  /// Converts the options that are not members of a job.
  ///
  /// Errors     base::Error(kUsage) for a file with an unknown extension
  void finish(job::Job& job) const;

 private:
  std::vector<std::filesystem::path> files_;
  std::string type_ = "half";
};

}  // namespace orrery::cli
