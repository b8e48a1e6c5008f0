// SPDX-License-Identifier: Apache-2.0
#include "farm/submit.h"

#include <algorithm>
#include <cctype>

#include "job/job_files.h"
#include "job/load_scene.h"
#include "job/text.h"
#include "base/frames.h"
#include "image/format.h"

namespace orrery::farm {
namespace {

/// A name that every engine takes.
std::string job_name_of(const std::filesystem::path& scene) {
  std::string name = scene.stem().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return name.empty() ? "orrery" : name;
}

/// Flags about files, of the command that writes the final ones.
void add_picture_flags(std::vector<std::string>& words, const job::Job& job) {
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {flag, value});
  };
  for (const job::ImageFile& output : job.outputs.images) add("-o", output.path.string());
  add("--deep", job.outputs.deep.string());
  add("--stats", job.outputs.statistics.string());
  if (job.outputs.exr.as_float) add("--type", "float");
  if (job.outputs.exr.compression != image::ExrOptions().compression) add("--compression", job.outputs.exr.compression);
  if (job.outputs.exr.multipart) words.push_back("--multipart");
  if (job.outputs.reproducible) words.push_back("--reproducible");
  if (job.resources.disk_limit > 0) {
    std::string size;
    base::append(size, "%.17gK", static_cast<double>(job.resources.disk_limit) / 1024);
    add("--disk-limit", size);
  }
  if (job.outputs.bits > 0) add("--bits", std::to_string(job.outputs.bits));
  add("--ocio", job.outputs.display.config);
  add("--display", job.outputs.display.display);
  add("--view", job.outputs.display.view);
  add("--look", job.outputs.display.look);
  if (job.outputs.display.exposure) {
    std::string stops;
    base::append(stops, "%.17g", *job.outputs.display.exposure);
    add("--exposure", stops);
  }
}

}  // namespace

Commands commands_of(const Submission& submission) {
  const Batch& batch = submission.batch;
  const job::Job& job = batch.job;
  const std::vector<job::Job> jobs = jobs_of(batch);
  Commands out;
  out.frames = batch.frames.empty() ? std::vector<int>{format::kFirstFrame} : batch.frames;
  const job::SceneRequest scene{{batch.scenes.front(), job.scene.overrides, out.frames.front()}, job.outputs.display};
  job::add_scene_files(scene.source.file, job::load_scene(scene).read.scene, *jobs.front().files);
  out.name = job_name_of(batch.scenes.front());
  out.parts = job.outputs.images.front().path.parent_path() / (out.name + ".parts");
  // Scripts make a folder for parts; the others have nobody to do it, and parts lie beside the pictures.
  const bool is_script = submission.engine == Engine::kSlurm || submission.engine == Engine::kParallel;
  const std::string prefix = out.parts.string() + (is_script ? "/" : ".");
  const bool is_split = submission.shards > 1;
  if (is_split && (job.sampling.is_adaptive() || !job.outputs.deep.empty()))
    throw base::Error(
        base::ErrorKind::kUsage,
        "--noise, --time and --deep need the whole picture; leave --shards out, and each frame is a task");

  out.render = {submission.program, "render", batch.scenes.front().string()};
  for (const format::Override& setting : job.scene.overrides)
    out.render.insert(out.render.end(), {"--set", setting.text});
  if (is_split) {
    const std::string part = prefix + "%d." + Commands::kShard + ".part.exr";
    out.render.insert(out.render.end(),
                      {"-o", part, "--shard", Commands::kShard + ("/" + std::to_string(submission.shards))});
    out.merge = {submission.program, "merge"};
    for (int i = 1; i <= submission.shards; ++i)
      out.merge.push_back(prefix + Commands::kFrame + "." + std::to_string(i) + ".part.exr");
    add_picture_flags(out.merge, job);
  } else {
    add_picture_flags(out.render, job);
    for (const auto& [flag, value] :
         {std::pair<const char*, double>{"--noise", job.sampling.noise}, {"--time", job.sampling.seconds}}) {
      std::string text;
      base::append(text, "%.17g%s", value, flag == std::string("--time") ? "s" : "");
      if (value > 0) out.render.insert(out.render.end(), {flag, text});
    }
  }
  if (is_split || !batch.frames.empty()) out.render.insert(out.render.end(), {"--frames", Commands::kFrame});
  out.render.insert(out.render.end(), {"--resume", "--skip-existing"});
  return out;
}

}  // namespace orrery::farm
