// SPDX-License-Identifier: Apache-2.0
#include "job/job_files.h"

#include "job/checkpoint.h"
#include "job/working_space.h"
#include "base/frames.h"
#include "display/config_files.h"
#include "format/named_files.h"

namespace orrery::job {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPointsRole = "points file";

}  // namespace

std::vector<OutputFile> outputs_of(const Job& job) {
  std::vector<OutputFile> out;
  for (const fs::path& output : job.outputs) out.push_back({output, "-o"});
  if (!job.deep.empty()) out.push_back({job.deep, "--deep"});
  if (!job.statistics.empty()) out.push_back({job.statistics, "--stats"});
  if (job.parts.empty()) out.push_back({checkpoint_file(job.outputs.front()), "checkpoint"});
  return out;
}

void add_job_files(const Job& job, base::FileSet& files, const std::string& owner) {
  files.add_input(job.scene, "scene");
  for (const ShardFile& part : job.parts) files.add_input(part.file, "part");
  add_ocio_configs(job.display.config, files);
  for (const OutputFile& output : outputs_of(job)) files.add_output(output.path, output.role + owner);
}

void add_named_files(const fs::path& scene_file, const std::vector<format::Override>& overrides,
                     const std::vector<int>& frames, base::FileSet& files) {
  const format::NamedFiles named = format::named_files(scene_file, overrides);
  scene::Color color;
  color.config = named.ocio_config;
  add_ocio_configs(config_of(scene_file, color), files);
  for (const std::string& name : named.points) {
    if (!base::has_frame_pattern(name)) {
      files.add_input(scene_file.parent_path() / name, kPointsRole);
      continue;
    }
    for (const int frame : frames)
      files.add_input(scene_file.parent_path() / base::with_frame(name, frame), kPointsRole);
  }
}

void add_scene_files(const fs::path& scene_file, const scene::Scene& scene, base::FileSet& files) {
  add_ocio_configs(config_of(scene_file, scene.color), files);
  for (const scene::Points& points : scene.points) files.add_input(scene_file.parent_path() / points.file, kPointsRole);
}

void add_ocio_configs(const std::string& config, base::FileSet& files) {
  for (const fs::path& file : display::config_files(config)) files.add_input(file, "OCIO config");
}

}  // namespace orrery::job
