// SPDX-License-Identifier: Apache-2.0
#include "submit/submit.h"

#include <cctype>
#include <string_view>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "load/load_scene.h"
#include "load/read_scene.h"

namespace orrery::submit {
namespace {

/// A job name that every engine accepts. Open Job Description allows 128 characters.
std::string job_name_of(const std::filesystem::path& scene) {
  constexpr std::size_t kLongest = 100;
  std::string name = scene.stem().string().substr(0, kLongest);
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return name.empty() ? "orrery" : name;
}

/// The path in a form that no program takes for an option; GNU parallel appends to a log whose name begins with +.
std::string path_word(const std::filesystem::path& path) {
  const std::string word = path.string();
  return word.starts_with('-') || word.starts_with('+') ? "./" + word : word;
}

/// True if OpenCue would replace a part of the word, such as #IFRAME#.
bool has_opencue_token(const std::string& word) {
  for (std::size_t at = word.find('#'); at != std::string::npos; at = word.find('#', at + 1)) {
    const std::size_t end = word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_", at + 1);
    if (end != std::string::npos && end > at + 1 && word[end] == '#') return true;
  }
  return false;
}

/// Refuses a word that the engine would not pass on unchanged, or that would add lines to a script.
void check_word(const std::string& word, Engine engine) {
  const auto refuse = [&](const char* why) {
    base::refuse(fmt::format("{}: {}; choose another name", base::printable(word), why));
  };
  if (!base::is_printable(word)) refuse("jobs cannot hold control characters, or text that is not UTF-8");
  // Neither engine has a way to escape these.
  if (engine == Engine::kOpenJd && word.find("{{") != std::string::npos)
    refuse("Open Job Description cannot pass on {{");
  if (engine == Engine::kOpenCue && has_opencue_token(word)) refuse("OpenCue replaces capitals between two #");
}

/// The arguments by which a task reports to its engine; those of the user follow, and have precedence.
std::vector<std::string> engine_arguments(Engine engine) {
  switch (engine) {
    case Engine::kSlurm: return {"--progress", "alf"};
    case Engine::kParallel: return {"--progress", "none", "-q", "-t", std::string(1, Commands::kThreads)};
    case Engine::kOpenJd: return {"--progress", "openjd"};
    case Engine::kOpenCue: return {"--progress", "arnold"};
  }
  return {};
}

}  // namespace

Commands commands_of(const Submission& submission) {
  const job::Batch& batch = submission.batch;
  const job::Job& job = batch.job;
  const std::vector<job::Job> jobs = job::jobs_of(batch);
  const std::filesystem::path& scene_file = batch.scenes.front();
  Commands out;
  out.frames = batch.frames.empty() ? std::vector<int>{load::kFirstFrame} : batch.frames;
  out.name = job_name_of(scene_file);
  // Named after the image: jobs that render one scene with different settings must not share shards.
  const std::filesystem::path& image = job.outputs.images.front().path;
  std::string folder = image.filename().string() + ".shards";
  for (char& c : folder)
    if (std::string_view("#%{}").find(c) != std::string_view::npos) c = '_';  // patterns of Slurm, parallel and orrery
  out.folder = path_word(image.parent_path() / folder);
  for (const std::string& word : {submission.program, scene_file.string(), out.folder.string()})
    check_word(word, submission.engine);
  for (const std::vector<std::string>* words : {&submission.render_arguments, &submission.merge_arguments})
    for (const std::string& word : *words) check_word(word, submission.engine);
  const bool is_split = submission.shards > 1;
  if (is_split && (job.sampling.is_adaptive() || !job.outputs.deep.empty()))
    base::refuse("--noise, --time and --deep need whole frames; omit --shards to make each frame one task");
  const load::SceneRequest scene{{scene_file, job.scene.overrides, out.frames.front()}, job.outputs.display};
  load::add_scene_files(scene.source.file, load::load_scene(scene).read.scene, *jobs.front().files);

  const auto append = [](std::vector<std::string>& words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  // Scripts create a folder for the shards. The other engines cannot, so shards are files next to the images.
  const bool is_script = submission.engine == Engine::kSlurm || submission.engine == Engine::kParallel;
  const std::string prefix = out.folder.string() + (is_script ? "/" : ".");
  out.render = {submission.program, "render", path_word(scene_file)};
  append(out.render, engine_arguments(submission.engine));
  append(out.render, submission.render_arguments);
  if (is_split) {
    append(out.render, {"-o", fmt::format("{}%d.{}.shard.exr", prefix, Commands::kShard), "--shard",
                        fmt::format("{}/{}", Commands::kShard, submission.shards)});
    out.merge = {submission.program, "merge"};
    for (int i = 1; i <= submission.shards; ++i)
      out.merge.push_back(fmt::format("{}{}.{}.shard.exr", prefix, Commands::kFrame, i));
    append(out.merge, submission.merge_arguments);
  }
  if (is_split || !batch.frames.empty()) append(out.render, {"--frames", std::string(1, Commands::kFrame)});
  append(out.render, {"--resume", "--skip-existing"});
  return out;
}

}  // namespace orrery::submit
