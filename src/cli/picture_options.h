// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "job/job.h"
#include "cli/arguments.h"

namespace orrery::cli {

/// Flags that say what files a job writes, and how.
class PictureOptions {
 public:
  /// Domain     called once; neither this nor `job` moves until the command line is read
  void add_to(Command& command, job::Job& job);

  /// What flags say that are no members of a job as they are.
  void finish(job::Job& job) const { job.exr.as_float = type_ == "float"; }

 private:
  std::string type_ = "half";
};

}  // namespace orrery::cli
