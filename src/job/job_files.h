// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/file_set.h"

namespace orrery::job {

struct Job;

/// A file that a job writes, and its role.
struct OutputFile {
  std::filesystem::path path;
  std::string role;  ///< "-o", "--stats", "checkpoint"
};

/// All files that a job writes, except Cryptomatte manifests, which only some scenes have.
std::vector<OutputFile> outputs_of(const Job& job);

/// Adds the files that a job reads and writes according to its command line. The names of Cryptomatte manifests are
/// reserved for every EXR image, because the scene has not been read yet.
///
/// `owner`    appended to roles in messages about several scenes: " of shot.toml"
/// Errors     base::Error(kUsage) for an output that is an input or another output
void add_job_files(const Job& job, base::FileSet& files, const std::string& owner = {});

}  // namespace orrery::job
