// SPDX-License-Identifier: Apache-2.0
// The job of `orrery submit` in the words of each engine.
#include <nlohmann/json.hpp>

#include "farm/submit.h"

#include "base/text.h"
#include "job/text.h"

namespace orrery::farm {
namespace {

using Words = std::vector<std::string>;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

Words with_numbers(Words words, const std::string& frame, const std::string& shard) {
  for (std::string& word : words) word = replaced(replaced(word, Commands::kFrame, frame), Commands::kShard, shard);
  return words;
}

/// One line of a shell; `frame` and `shard` are shell words of their own, as "$frame".
std::string shell_line(const Words& words, const std::string& frame, const std::string& shard) {
  std::string out;
  for (const std::string& word : words) {
    // Quotes end around what the shell shall fill in.
    const bool is_plain = base::shell_quoted(word) == word;
    const std::string quote = is_plain ? "" : "'";
    std::string text = base::shell_quoted(word);
    text = replaced(text, Commands::kFrame, quote + frame + quote);
    text = replaced(text, Commands::kShard, quote + shard + quote);
    out += (out.empty() ? "" : " ") + text;
  }
  return out;
}

std::string frame_list(const Commands& c) {
  std::string out;
  for (const int frame : c.frames) out += (out.empty() ? "" : " ") + std::to_string(frame);
  return out;
}

std::string heading(const Submission& s, const Commands& c, const char* where) {
  std::string out;
  base::append(out, "# Renders %s%s%s %s: %zu tasks", s.batch.scenes.front().c_str(),
               s.frames_text.empty() ? "" : ", frames ", s.frames_text.c_str(), where,
               c.frames.size() * static_cast<std::size_t>(s.shards));
  if (s.shards > 1) base::append(out, ", %d for each frame, and a merge for each frame", s.shards);
  return out + ".\n";
}

// ---------------------------------------------------------------------------------------------------- Slurm

std::string slurm_array(const Commands& c, const std::string& kind, std::size_t count) {
  std::string out;
  base::append(out, "#SBATCH --job-name=%s.%s\n#SBATCH --array=0-%zu\n", c.name.c_str(), kind.c_str(), count - 1);
  base::append(out, "#SBATCH --output=\"%s/%s.%%a.log\"\n#SBATCH --open-mode=append\n", c.parts.c_str(), kind.c_str());
  return out;
}

std::string slurm_text(const Submission& s, const Commands& c) {
  std::string out = "#!/bin/sh\n" + heading(s, c, "with Slurm");
  out +=
      "# Run it with sh, in a folder that all nodes see under the same name. Edit it as you like.\n"
      "set -eu\nmkdir -p " +
      base::shell_quoted(c.parts.string()) +
      "\n\n"
      "render=$(sbatch --parsable <<'END'\n#!/bin/sh\n";
  out += slurm_array(c, "render", c.frames.size() * static_cast<std::size_t>(s.shards));
  out +=
      "#SBATCH --requeue\n"
      "# A minute before the time limit the render is asked to write its checkpoint.\n"
      "#SBATCH --signal=B:TERM@60\n";
  base::append(out, "shards=%d\nset -- %s\n", s.shards, frame_list(c).c_str());
  out += "shift $((SLURM_ARRAY_TASK_ID / shards))\nframe=$1\nshard=$((SLURM_ARRAY_TASK_ID % shards + 1))\n";
  out += shell_line(c.render, "\"$frame\"", "\"$shard\"") + " --progress alf &\n";
  out +=
      "child=$!\ntrap 'kill -TERM $child' TERM\nstatus=0\nwait $child || status=$?\n"
      "if kill -0 $child 2>/dev/null; then status=0; wait $child || status=$?; fi  # a signal ends the first wait\n"
      "case $status in\n"
      "  0 | 2 | 65 | 66) exit $status ;;  # done, or wrong in a way that no other try would mend\n"
      "esac\n"
      "if [ \"${SLURM_RESTART_COUNT:-0}\" -lt 3 ]; then scontrol requeue \"$SLURM_JOB_ID\"; fi\nexit $status\nEND\n)\n";
  if (!c.merge.empty()) {
    out +=
        "\n# After any end of the renders, for one that succeeds only when it is requeued counts as failed for "
        "afterok:\n"
        "# the merge itself sees to it that no part is missing.\n"
        "merge=$(sbatch --parsable --dependency=afterany:\"$render\" <<'END'\n#!/bin/sh\n";
    out += slurm_array(c, "merge", c.frames.size());
    base::append(out, "set -- %s\n", frame_list(c).c_str());
    out += "shift \"$SLURM_ARRAY_TASK_ID\"\nframe=$1\n" + shell_line(c.merge, "\"$frame\"", "") + "\nEND\n)\n";
  }
  return out + "\necho \"render $render" + (c.merge.empty() ? "" : ", merge $merge") + "\"\n";
}

// --------------------------------------------------------------------------------------------- GNU parallel

std::string parallel_text(const Submission& s, const Commands& c) {
  const std::string parts = base::shell_quoted(c.parts.string());
  std::string out = "#!/bin/sh\n" + heading(s, c, "with GNU parallel on this machine");
  base::append(out,
               "# Run it with sh, again as often as needed: only what has failed or is not done is done.\n"
               "set -eu\nmkdir -p %s\nthreads=$((($(nproc) + %d) / %d))\n",
               parts.c_str(), s.jobs_at_a_time - 1, s.jobs_at_a_time);
  const auto run = [&](const Words& words, const char* kind, const std::string& more, const std::string& tail) {
    base::append(out, "parallel --jobs %d --joblog %s/%s.log --resume-failed --retries 3 \\\n  %s%s \\\n  ::: %s%s\n",
                 s.jobs_at_a_time, parts.c_str(), kind,
                 base::shell_quoted(shell_line(words, "{1}", "{2}") + more).c_str(),
                 more.empty() ? "" : "\" -t $threads\"", frame_list(c).c_str(), tail.c_str());
  };
  std::string shards = " :::";
  for (int i = 1; i <= s.shards; ++i) shards += " " + std::to_string(i);
  run(c.render, "render", " --progress none -q", s.shards > 1 ? shards : "");
  if (!c.merge.empty()) run(c.merge, "merge", "", "");
  return out;
}

// --------------------------------------------------------------------------------------------------- OpenJD

/// Source     openjd-2023-09
std::string openjd_text(const Submission& s, const Commands& c) {
  using nlohmann::ordered_json;
  const std::string frame = "{{Task.Param.Frame}}", shard = "{{Task.Param.Shard}}";
  std::string range;
  for (const int f : c.frames) range += (range.empty() ? "" : ",") + std::to_string(f);
  const auto parameter = [](const char* name, const std::string& values) {
    return ordered_json{{"name", name}, {"type", "INT"}, {"range", values}};
  };
  const auto step = [&](const char* name, const Words& words, ordered_json parameters) {
    Words arguments = with_numbers(words, frame, shard);
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
  Words render = c.render;
  render.insert(render.end(), {"--progress", "openjd"});
  ordered_json parameters = ordered_json::array({parameter("Frame", range)});
  if (s.shards > 1) parameters.push_back(parameter("Shard", "1-" + std::to_string(s.shards)));
  ordered_json job = {{"specificationVersion", "jobtemplate-2023-09"}, {"name", c.name}};
  job["steps"] = ordered_json::array({step("Render", render, parameters)});
  if (!c.merge.empty()) {
    ordered_json merge = step("Merge", c.merge, ordered_json::array({parameter("Frame", range)}));
    merge["dependencies"] = ordered_json::array({{{"dependsOn", "Render"}}});
    job["steps"].push_back(merge);
  }
  return job.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

// -------------------------------------------------------------------------------------------------- OpenCue

std::string xml_escaped(const std::string& text) {
  return replaced(replaced(replaced(text, "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
}

/// Source     opencue-cjsl-1.12
std::string opencue_text(const Submission& s, const Commands& c) {
  std::string range;
  for (const int f : c.frames) range += (range.empty() ? "" : ",") + std::to_string(f);
  std::string out =
      "<?xml version=\"1.0\"?>\n"
      "<!DOCTYPE spec PUBLIC \"SPI Cue Specification Language\" \"http://localhost:8080/spcue/dtd/cjsl-1.12.dtd\">\n"
      "<!-- show, shot and user are yours to fill in -->\n<spec>\n  <facility>local</facility>\n  "
      "<show>testing</show>\n"
      "  <shot>" +
      c.name + "</shot>\n  <user>render</user>\n";
  base::append(out,
               "  <job name=\"%s\">\n    <paused>False</paused>\n    <maxretries>3</maxretries>\n"
               "    <autoeat>False</autoeat>\n    <layers>\n",
               c.name.c_str());
  const auto layer = [&](const std::string& name, const char* type, const std::string& command) {
    base::append(out,
                 "      <layer name=\"%s\" type=\"%s\">\n        <cmd>%s</cmd>\n        <range>%s</range>\n"
                 "        <chunk>1</chunk>\n        <threadable>True</threadable>\n"
                 "        <services>\n          <service>shell</service>\n        </services>\n      </layer>\n",
                 name.c_str(), type, xml_escaped(command).c_str(), range.c_str());
  };
  for (int i = 1; i <= s.shards; ++i)
    layer("render_" + std::to_string(i), "Render",
          shell_line(c.render, "#IFRAME#", std::to_string(i)) + " --progress arnold");
  if (!c.merge.empty()) layer("merge", "Post", shell_line(c.merge, "#IFRAME#", ""));
  out += "    </layers>\n  </job>\n";
  if (!c.merge.empty()) {
    out += "  <depends>\n";
    for (int i = 1; i <= s.shards; ++i)
      base::append(out,
                   "    <depend type=\"FRAME_BY_FRAME\" anyframe=\"False\">\n      <depjob>%s</depjob>\n"
                   "      <deplayer>merge</deplayer>\n      <onjob>%s</onjob>\n      <onlayer>render_%d</onlayer>\n"
                   "    </depend>\n",
                   c.name.c_str(), c.name.c_str(), i);
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

}  // namespace orrery::farm
