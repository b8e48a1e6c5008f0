// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/file_set.h"
#include "scene/forward.h"

namespace orrery::job {

struct Job;
struct SceneSource;

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

/// Adds the files that a scene references at these frames. Parses the scene file without reading points files.
///
/// Errors     those of add_job_files and format::named_files
void add_named_files(const SceneSource& scene, const std::vector<int>& frames, base::FileSet& files);

/// Adds the files that a loaded scene references.
///
/// Errors     those of add_job_files
void add_scene_files(const std::filesystem::path& scene_file, const scene::Scene& scene, base::FileSet& files);

/// Adds an OCIO config, from --ocio or a scene, and the config in $OCIO, if they are files, and their LUT files.
///
/// Errors     those of add_job_files
/// Cost       loads a config that is not in the set
void add_ocio_configs(const std::string& config, base::FileSet& files);

}  // namespace orrery::job
