// SPDX-License-Identifier: Apache-2.0
#include "farm/submit.h"

#include <cctype>
#include <string_view>

#include <fmt/core.h>

#include "format/read_scene.h"
#include "load/load_scene.h"
#include "load/loaded_scene.h"
#include "load/scene_files.h"

namespace orrery::farm {
namespace {

/// A job name that every engine accepts.
std::string job_name_of(const std::filesystem::path& scene) {
  std::string name = scene.stem().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return name.empty() ? "orrery" : name;
}

}  // namespace

Commands commands_of(const Submission& submission) {
  const Batch& batch = submission.batch;
  const job::Job& job = batch.job;
  const std::vector<job::Job> jobs = jobs_of(batch);
  Commands out;
  out.frames = batch.frames.empty() ? std::vector<int>{format::kFirstFrame} : batch.frames;
  const load::SceneRequest scene{{batch.scenes.front(), job.scene.overrides, out.frames.front()}, job.outputs.display};
  load::add_scene_files(scene.source.file, load::load_scene(scene).read.scene, *jobs.front().files);
  out.name = job_name_of(batch.scenes.front());
  // Named after the image: jobs that render one scene with different settings must not share shards.
  const std::filesystem::path& image = job.outputs.images.front().path;
  std::string folder = image.filename().string() + ".shards";
  for (char& c : folder)
    if (std::string_view("#%{}").find(c) != std::string_view::npos) c = '_';  // patterns of Slurm, parallel and orrery
  out.folder = image.parent_path() / folder;
  // Scripts create a folder for the shards. The other engines cannot, so shards are files next to the images.
  const bool is_script = submission.engine == Engine::kSlurm || submission.engine == Engine::kParallel;
  const std::string prefix = out.folder.string() + (is_script ? "/" : ".");
  const bool is_split = submission.shards > 1;
  if (is_split && (job.sampling.is_adaptive() || !job.outputs.deep.empty()))
    throw base::Error(base::ErrorKind::kUsage,
                      "--noise, --time and --deep need whole frames; omit --shards to make each frame one task");

  out.render = {submission.program, "render", batch.scenes.front().string()};
  for (const format::Override& setting : job.scene.overrides)
    out.render.insert(out.render.end(), {setting.option, setting.typed});
  if (is_split) {
    out.render.insert(out.render.end(), {"-o", fmt::format("{}%d.{}.shard.exr", prefix, Commands::kShard), "--shard",
                                         fmt::format("{}/{}", Commands::kShard, submission.shards)});
    if (job.denoise) out.render.push_back("--denoise");
    out.merge = {submission.program, "merge"};
    for (int i = 1; i <= submission.shards; ++i)
      out.merge.push_back(fmt::format("{}{}.{}.shard.exr", prefix, Commands::kFrame, i));
  }
  std::vector<std::string>& last = is_split ? out.merge : out.render;
  last.insert(last.end(), submission.arguments.begin(), submission.arguments.end());
  if (is_split || !batch.frames.empty()) out.render.insert(out.render.end(), {"--frames", Commands::kFrame});
  out.render.insert(out.render.end(), {"--resume", "--skip-existing"});
  return out;
}

}  // namespace orrery::farm
