// SPDX-License-Identifier: Apache-2.0
#include "job/batch.h"

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "base/text.h"
#include "job/check_job.h"
#include "job/prepared_scene.h"
#include "load/read_scene.h"

namespace orrery::job {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScenePattern = "{scene}";

bool has_scene_pattern(const std::string& name) { return name.find(kScenePattern) != std::string::npos; }

void check_name(const Batch& batch, const std::string& name) {
  const bool has_pattern = base::has_frame_pattern(name);
  if (batch.frames.size() > 1 && !has_pattern)
    base::refuse_one_name(name, batch.frames.size(),
                          fs::path(name).replace_extension(".####" + fs::path(name).extension().string()).string());
  if (batch.frames.empty() && has_pattern)
    base::refuse(name + " has a frame pattern; select frames with --frames, e.g. --frames 1-48");
  if (batch.scenes.size() > 1 && !has_scene_pattern(name))
    base::refuse(fmt::format("{} is one name for {} scenes; add a scene pattern, e.g. {{scene}}.png", name,
                             batch.scenes.size()));
}

/// Adds the files that a scene names, if it can be parsed. Otherwise its job reports the errors.
void add_readable_files(const load::SceneSource& scene, const std::vector<int>& frames, base::FileSet& files) {
  try {
    load::add_named_files(scene, frames, files);
  } catch (const base::Error& error) {
    if (error.kind() == base::ErrorKind::kUsage) throw;
  }
}

}  // namespace

fs::path output_name(const fs::path& name, const fs::path& scene, std::optional<int> frame) {
  const std::string text = base::replaced(name.string(), kScenePattern, scene.stem().string());
  return frame ? base::with_frame(text, *frame) : text;
}

std::vector<Job> jobs_of(const Batch& batch) {
  Job common = batch.job;
  each_named(common.outputs, [&](const fs::path& name, const char*) { check_name(batch, name.string()); });
  const std::vector<int> frames = batch.frames.empty() ? std::vector<int>{load::kFirstFrame} : batch.frames;
  std::vector<Job> jobs;
  if (!common.files) common.files = std::make_shared<base::FileSet>();
  if (frames.size() > 1) common.prepared = std::make_shared<PreparedScene>(true);
  base::FileSet& files = *common.files;
  for (const NamedOutput& other : batch.others) files.add_output(other.path, other.role);
  for (const fs::path& scene : batch.scenes)
    if (common.scene.has_file && !files.add_input(scene, "scene")) base::refuse(scene.string() + " is given twice");
  for (const fs::path& scene : batch.scenes) {
    for (const int frame : frames) {
      Job job = common;
      job.scene.file = scene;
      job.scene.frame = frame;
      each_named(job.outputs, [&](fs::path& name, const char*) {
        name = output_name(name, scene, batch.frames.empty() ? std::nullopt : std::optional(frame));
      });
      add_job_files(job, files, batch.scenes.size() > 1 ? " of " + scene.string() : "");
      jobs.push_back(std::move(job));
    }
  }
  // A single job checks its scene's files when it reads the scene. Here, another job or the caller could overwrite them
  // before that.
  if (jobs.size() > 1 || !batch.others.empty())
    for (const fs::path& scene : batch.scenes) {
      load::SceneSource source = common.scene;
      source.file = scene;
      add_readable_files(source, frames, files);
    }
  return jobs;
}

}  // namespace orrery::job
