// SPDX-License-Identifier: Apache-2.0
#include "submit/submit.h"

#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "job/prepared_scene.h"
#include "load/load_scene.h"
#include "load/read_scene.h"

namespace orrery::submit {
namespace {

using base::replaced;

using Words = std::vector<std::string>;

// Placeholders in words: control characters, which no other part of a word contains.
constexpr char kFrame = '\1';    ///< number of the frame
constexpr char kShard = '\2';    ///< number of the shard, from 1
constexpr char kThreads = '\3';  ///< threads of a task; Engine::kParallel only

/// The commands of a submission, the same for every engine.
struct Commands {
  std::string name;    ///< job name: the scene's name in letters, digits, - and _
  std::string folder;  ///< of shards and logs
  std::vector<int> frames;
  Words render;  ///< renders a shard
  Words merge;   ///< merges the shards of a frame; empty without shards
};

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

/// The folder of an image's shards. Named after the image: jobs that render one scene with different settings must not
/// share shards.
std::filesystem::path shard_folder(const std::filesystem::path& image) {
  std::string name = image.filename().string() + ".shards";
  for (char& c : name)
    if (std::string_view("#%{}").find(c) != std::string_view::npos) c = '_';  // patterns of Slurm, parallel and orrery
  return image.parent_path() / name;
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
Words engine_arguments(Engine engine) {
  switch (engine) {
    case Engine::kSlurm: return {"--progress", "alf"};
    case Engine::kParallel: return {"--progress", "none", "-q", "-t", std::string(1, kThreads)};
    case Engine::kOpenJd: return {"--progress", "openjd"};
    case Engine::kOpenCue: return {"--progress", "arnold"};
  }
  return {};
}

/// Reads and checks the scene, and composes the commands.
Commands commands_of(const Submission& submission) {
  const job::Batch& batch = submission.batch;
  const job::Job& job = batch.job;
  const std::vector<job::Job> jobs = job::jobs_of(batch);
  const std::filesystem::path& scene_file = batch.scenes.front();
  Commands out;
  out.frames = batch.frames.empty() ? std::vector<int>{load::kFirstFrame} : batch.frames;
  out.name = job_name_of(scene_file);
  out.folder = path_word(shard_folder(job::output_name(job.outputs.images.front().path, scene_file, {})));
  for (const std::string& word : {submission.program, scene_file.string(), out.folder})
    check_word(word, submission.engine);
  for (const Words* words : {&submission.render_arguments, &submission.merge_arguments})
    for (const std::string& word : *words) check_word(word, submission.engine);
  const bool is_split = submission.shards > 1;
  if (is_split && (job.settings.is_adaptive() || !job.outputs.deep.empty()))
    base::refuse("--noise, --time and --deep need whole frames; omit --shards to make each frame one task");
  const load::SceneRequest scene{{scene_file, job.scene.overrides, out.frames.front()}};
  load::add_scene_files(scene.source.file, job::PreparedScene().load(scene).read.scene, *jobs.front().files);

  const auto append = [](Words& words, const Words& more) { words.insert(words.end(), more.begin(), more.end()); };
  // Scripts create a folder for the shards. The other engines cannot, so shards are files next to the images.
  const bool is_script = submission.engine == Engine::kSlurm || submission.engine == Engine::kParallel;
  const std::string prefix = out.folder + (is_script ? "/" : ".");
  out.render = {submission.program, "render", path_word(scene_file)};
  append(out.render, engine_arguments(submission.engine));
  append(out.render, submission.render_arguments);
  if (is_split) {
    append(out.render, {"-o", fmt::format("{}%d.{}.shard.exr", prefix, kShard), "--shard",
                        fmt::format("{}/{}", kShard, submission.shards)});
    out.merge = {submission.program, "merge"};
    for (int i = 1; i <= submission.shards; ++i)
      out.merge.push_back(fmt::format("{}{}.{}.shard.exr", prefix, kFrame, i));
    append(out.merge, submission.merge_arguments);
  }
  if (is_split || !batch.frames.empty()) append(out.render, {"--frames", std::string(1, kFrame)});
  append(out.render, {"--resume", "--skip-existing"});
  return out;
}

/// One shell command line. `frame` and `shard` replace their placeholders, outside quotes so that the shell expands
/// them.
std::string shell_line(const Words& words, const std::string& frame, const std::string& shard) {
  std::string out, piece;
  const auto end_piece = [&] {
    if (!piece.empty()) out += base::shell_quoted(piece);
    piece.clear();
  };
  for (const std::string& word : words) {
    if (!out.empty()) out += ' ';
    if (word.empty()) out += "''";
    for (const char c : word) {
      if (c != kFrame && c != kShard && c != kThreads) {
        piece += c;
        continue;
      }
      end_piece();
      out += c == kFrame ? frame : c == kShard ? shard : "\"$threads\"";
    }
    end_piece();
  }
  return out;
}

std::string frame_list(const Commands& c, const char* separator) {
  return fmt::format("{}", fmt::join(c.frames, separator));
}

std::size_t render_tasks(const Submission& s, const Commands& c) {
  return c.frames.size() * static_cast<std::size_t>(s.shards);
}

std::string heading(const Submission& s, const Commands& c, const char* engine) {
  return fmt::format("# Renders {}{}{} with {}: {} tasks{}.\n", base::printable(s.batch.scenes.front().string()),
                     s.frames_text.empty() ? "" : ", frames ", s.frames_text, engine, render_tasks(s, c),
                     s.shards > 1 ? fmt::format(", {} per frame, and one merge per frame", s.shards) : "");
}

// ---------------------------------------------------------------------------------------------------- Slurm

constexpr std::size_t kSlurmArray = 1001;  ///< tasks that Slurm's default MaxArraySize allows

std::string slurm_array(const Commands& c, const std::string& kind, std::size_t count) {
  return fmt::format(
      "#SBATCH --job-name={0}.{1}\n#SBATCH --array=0-{2}\n#SBATCH --output=\"{3}/{1}.%a.log\"\n"
      "#SBATCH --open-mode=append\n",
      c.name, kind, count - 1, c.folder);
}

std::string slurm_text(const Submission& s, const Commands& c) {
  // An #SBATCH line has no way to escape the first two, and Slurm replaces what follows a percent sign.
  if (c.folder.find_first_of("\"\\%") != std::string::npos)
    base::refuse(c.folder +
                 ": Slurm's log files cannot be in folders with quotes, backslashes or percent signs in their names; "
                 "write the image elsewhere");
  std::string out = "#!/bin/sh\n" + heading(s, c, "Slurm");
  out += fmt::format(
      "# Run it with sh in a directory that all nodes mount at the same path. Edit it as needed.\n"
      "set -eu\nmkdir -p {}\n\nrender=$(sbatch --parsable <<'END'\n#!/bin/sh\n",
      base::shell_quoted(c.folder));
  out += slurm_array(c, "render", render_tasks(s, c));
  if (render_tasks(s, c) > kSlurmArray)
    out +=
        fmt::format("# More than {} tasks need a larger MaxArraySize than Slurm's default; or a submission in parts.\n",
                    kSlurmArray);
  out +=
      "#SBATCH --requeue\n"
      "# One minute before the time limit, a signal stops the render, which writes its checkpoint.\n"
      "#SBATCH --signal=B:TERM@60\n";
  out += fmt::format("shards={}\nset -- {}\n", s.shards, frame_list(c, " "));
  out += "shift $((SLURM_ARRAY_TASK_ID / shards))\nframe=$1\nshard=$((SLURM_ARRAY_TASK_ID % shards + 1))\n";
  out += shell_line(c.render, "\"$frame\"", "\"$shard\"") + " &\n";
  out +=
      "child=$!\ntrap 'kill -TERM $child' TERM\nstatus=0\nwait $child || status=$?\n"
      "if kill -0 $child 2>/dev/null; then status=0; wait $child || status=$?; fi  # a signal interrupts the first "
      "wait\n"
      "case $status in\n"
      "  0 | 2 | 65 | 66 | 76) exit $status ;;  # success, or what a retry cannot fix\n"
      "esac\n"
      "if [ \"${SLURM_RESTART_COUNT:-0}\" -lt 3 ]; then scontrol requeue \"$SLURM_JOB_ID\"; fi\nexit $status\nEND\n)\n";
  if (!c.merge.empty()) {
    out +=
        "\n# afterany: afterok counts a task that succeeds after a requeue as failed. The merge itself checks that no\n"
        "# shard is missing.\n"
        "merge=$(sbatch --parsable --dependency=afterany:\"$render\" <<'END'\n#!/bin/sh\n";
    out += slurm_array(c, "merge", c.frames.size());
    out += fmt::format("set -- {}\n", frame_list(c, " "));
    out += fmt::format("shift \"$SLURM_ARRAY_TASK_ID\"\nframe=$1\n{}\nEND\n)\n", shell_line(c.merge, "\"$frame\"", ""));
  }
  return fmt::format("{}\necho \"render $render{}\"\n", out, c.merge.empty() ? "" : ", merge $merge");
}

// --------------------------------------------------------------------------------------------- GNU parallel

/// Repeats a command that fails, but not where that would not help, nor after a signal. `parallel --retries` repeats
/// all.
constexpr const char* kThreeTries =
    "for try in 1 2 3; do {}; status=$?; case $status in 0 | 2 | 65 | 66 | 75 | 76) break ;; esac; done; exit $status";

std::string parallel_text(const Submission& s, const Commands& c) {
  const std::string folder = base::shell_quoted(c.folder);
  std::string out = "#!/bin/sh\n" + heading(s, c, "GNU parallel on this machine");
  out += fmt::format(
      "# Run it with sh. After a failure, run it again: finished images are skipped, merges are repeated.\n"
      "set -eu\nmkdir -p {}\nthreads=$((($(nproc) + {}) / {}))\nexport threads\n",
      folder, s.jobs_at_a_time - 1, s.jobs_at_a_time);
  // parallel would replace {1} in the names of files, so that it does not get to see the command.
  const auto run = [&](const std::string& command, const char* kind, const std::string& shards) {
    out += fmt::format(
        "\nORRERY_{0}={1}\nexport ORRERY_{0}\n"
        "parallel --jobs {2} --joblog {3}/{0}.log \\\n"
        "  'sh -c \"$ORRERY_{0}\" sh {{1}}{4}' \\\n  ::: {5}{6}\n",
        kind, base::shell_quoted(fmt::format(kThreeTries, command)), s.jobs_at_a_time, folder,
        shards.empty() ? "" : " {2}", frame_list(c, " "), shards);
  };
  std::string shards;
  for (int i = 1; s.shards > 1 && i <= s.shards; ++i) shards += (i == 1 ? " ::: " : " ") + std::to_string(i);
  run(shell_line(c.render, "\"$1\"", "\"$2\""), "render", shards);
  if (!c.merge.empty()) run(shell_line(c.merge, "\"$1\"", ""), "merge", "");
  return out;
}

// --------------------------------------------------------------------------------------------------- OpenJD

/// Reference  openjd-2023-09
std::string openjd_text(const Submission& s, const Commands& c) {
  using nlohmann::ordered_json;
  const std::string frame = "{{Task.Param.Frame}}", shard = "{{Task.Param.Shard}}";
  const std::string range = frame_list(c, ",");
  const auto parameter = [](const char* name, const std::string& values) {
    return ordered_json{{"name", name}, {"type", "INT"}, {"range", values}};
  };
  const auto step = [&](const char* name, const Words& words, ordered_json parameters) {
    Words arguments = words;
    for (std::string& word : arguments) word = replaced(replaced(word, {&kFrame, 1}, frame), {&kShard, 1}, shard);
    const std::string command = arguments.front();
    arguments.erase(arguments.begin());
    return ordered_json{
        {"name", name},
        {"parameterSpace", {{"taskParameterDefinitions", std::move(parameters)}}},
        {"script",
         {{"actions",
           {{"onRun",
             {{"command", command},
              {"args", arguments},
              {"cancelation", {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", 60}}}}}}}}}};
  };
  ordered_json parameters = ordered_json::array({parameter("Frame", range)});
  if (s.shards > 1) parameters.push_back(parameter("Shard", fmt::format("1-{}", s.shards)));
  ordered_json job = {{"specificationVersion", "jobtemplate-2023-09"}, {"name", c.name}};
  job["steps"] = ordered_json::array({step("Render", c.render, parameters)});
  if (!c.merge.empty()) {
    ordered_json merge = step("Merge", c.merge, ordered_json::array({parameter("Frame", range)}));
    merge["dependencies"] = ordered_json::array({{{"dependsOn", "Render"}}});
    job["steps"].push_back(merge);
  }
  return job.dump(2) + "\n";
}

// -------------------------------------------------------------------------------------------------- OpenCue

std::string xml_escaped(const std::string& text) {
  return replaced(replaced(replaced(text, "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
}

/// Reference  opencue-cjsl-1.12
std::string opencue_text(const Submission& s, const Commands& c) {
  const std::string range = frame_list(c, ",");
  std::string out = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<!DOCTYPE spec PUBLIC \"SPI Cue Specification Language\" \"http://localhost:8080/spcue/dtd/cjsl-1.12.dtd\">\n"
      "<!-- Set show, shot and user as needed. -->\n<spec>\n  <facility>local</facility>\n  <show>testing</show>\n"
      "  <shot>{0}</shot>\n  <user>render</user>\n  <job name=\"{0}\">\n    <paused>False</paused>\n"
      "    <maxretries>{1}</maxretries>\n    <autoeat>False</autoeat>\n    <layers>\n",
      c.name,
      // OpenCue repeats a frame whatever its exit status is.
      s.batch.job.is_strict ? 0 : 3);
  const auto layer = [&](const std::string& name, const char* type, const std::string& command) {
    out += fmt::format(
        "      <layer name=\"{}\" type=\"{}\">\n        <cmd>{}</cmd>\n        <range>{}</range>\n"
        "        <chunk>1</chunk>\n        <threadable>True</threadable>\n"
        "        <services>\n          <service>shell</service>\n        </services>\n      </layer>\n",
        name, type, xml_escaped(command), range);
  };
  for (int i = 1; i <= s.shards; ++i)
    layer(fmt::format("render_{}", i), "Render", shell_line(c.render, "#IFRAME#", std::to_string(i)));
  if (!c.merge.empty()) layer("merge", "Post", shell_line(c.merge, "#IFRAME#", ""));
  out += "    </layers>\n  </job>\n";
  if (!c.merge.empty()) {
    out += "  <depends>\n";
    for (int i = 1; i <= s.shards; ++i)
      out += fmt::format(
          "    <depend type=\"FRAME_BY_FRAME\" anyframe=\"False\">\n      <depjob>{0}</depjob>\n"
          "      <deplayer>merge</deplayer>\n      <onjob>{0}</onjob>\n      <onlayer>render_{1}</onlayer>\n"
          "    </depend>\n",
          c.name, i);
    out += "  </depends>\n";
  }
  return out + "</spec>\n";
}

}  // namespace

std::string submission_text(const Submission& submission) {
  const Commands commands = commands_of(submission);
  switch (submission.engine) {
    case Engine::kSlurm: return slurm_text(submission, commands);
    case Engine::kParallel: return parallel_text(submission, commands);
    case Engine::kOpenJd: return openjd_text(submission, commands);
    case Engine::kOpenCue: return opencue_text(submission, commands);
  }
  return {};
}

}  // namespace orrery::submit
