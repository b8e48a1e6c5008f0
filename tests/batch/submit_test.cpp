// SPDX-License-Identifier: Apache-2.0
// Checks generated jobs against the specifications of the schedulers. slurm.sh and parallel.sh run the scripts for
// Slurm and GNU parallel.
#include <nlohmann/json.hpp>

#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "batch/submit.h"

namespace orrery::test {
namespace {

using BatchSubmit = SubmitTest;

/// Expects an object that has all `needed` keys and no others but the `allowed` ones.
void expect_keys(const nlohmann::json& object, const std::set<std::string>& needed,
                 const std::set<std::string>& allowed = {}) {
  ASSERT_TRUE(object.is_object()) << object;
  for (const std::string& key : needed) EXPECT_TRUE(object.contains(key)) << key << " is missing in " << object;
  for (const auto& [key, value] : object.items())
    EXPECT_TRUE(needed.count(key) + allowed.count(key) > 0) << key << " is unknown in " << object;
}

/// Reference  openjd-2023-09, sections of the schema by name
void expect_openjd(const nlohmann::json& job) {
  expect_keys(job, {"specificationVersion", "name", "steps"},
              {"description", "parameterDefinitions", "jobEnvironments"});
  EXPECT_EQ(job["specificationVersion"], "jobtemplate-2023-09");
  EXPECT_LE(job["name"].get<std::string>().size(), 128u);
  std::set<std::string> names;
  for (const auto& step : job["steps"]) {  // StepTemplate
    expect_keys(step, {"name", "script"},
                {"description", "dependencies", "stepEnvironments", "hostRequirements", "parameterSpace"});
    EXPECT_TRUE(names.insert(step["name"]).second);
    expect_keys(step["script"], {"actions"}, {"embeddedFiles"});
    expect_keys(step["script"]["actions"], {"onRun"});
    const auto& action = step["script"]["actions"]["onRun"];
    expect_keys(action, {"command"}, {"args", "timeout", "cancelation"});
    expect_keys(action["cancelation"], {"mode"}, {"notifyPeriodInSeconds"});
    EXPECT_EQ(action["cancelation"]["mode"], "NOTIFY_THEN_TERMINATE");
    EXPECT_LE(action["cancelation"]["notifyPeriodInSeconds"], 600);
    expect_keys(step["parameterSpace"], {"taskParameterDefinitions"}, {"combination"});
    std::set<std::string> parameters;
    for (const auto& parameter : step["parameterSpace"]["taskParameterDefinitions"]) {
      expect_keys(parameter, {"name", "type", "range"});
      EXPECT_EQ(parameter["type"], "INT");
      parameters.insert(parameter["name"]);
      const std::regex range("-?[0-9]+(--?[0-9]+(:-?[0-9]+)?)?(,-?[0-9]+(--?[0-9]+(:-?[0-9]+)?)?)*");
      EXPECT_TRUE(std::regex_match(parameter["range"].get<std::string>(), range)) << parameter;
    }
    for (const auto& argument : action["args"]) {  // format strings refer to defined parameters
      const std::string text = argument;
      const std::regex reference("\\{\\{([^}]*)\\}\\}");
      for (auto i = std::sregex_iterator(text.begin(), text.end(), reference); i != std::sregex_iterator(); ++i)
        EXPECT_EQ(parameters.count((*i)[1].str().substr(std::string("Task.Param.").size())), 1u) << text;
    }
    if (step.contains("dependencies"))
      for (const auto& dependency : step["dependencies"]) {
        expect_keys(dependency, {"dependsOn"});
        EXPECT_EQ(names.count(dependency["dependsOn"]), 1u) << "depends on no earlier step";
      }
  }
}

TEST_F(BatchSubmit, OpenJdTemplatesFollowTheSpecification) {
  const auto split = nlohmann::json::parse(submit("-o s.####.exr --frames 1-3,9 --shards 2 --openjd --samples 9"));
  expect_openjd(split);
  EXPECT_EQ(split["steps"].size(), 2u);
  EXPECT_EQ(split["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]["range"], "1,2,3,9");
  const auto plain = nlohmann::json::parse(submit("-o s.exr --openjd"));
  expect_openjd(plain);
  EXPECT_EQ(plain["steps"].size(), 1u);
}

/// Checks the children of each element, and their order, against cjsl-1.12 as regular expressions.
///
/// Reference  opencue-cjsl-1.12
TEST_F(BatchSubmit, OpenCueJobsFollowTheSpecification) {
  const std::string text = submit("-o s.####.exr --frames 1-3 --shards 2 --opencue --set 'sphere[0].name=a & b < c'");
  const std::map<std::string, std::regex> children = {
      {"spec", std::regex("(facility )?(dept )?show shot user (email )?(uid )?(job )*(depends )*")},
      {"job", std::regex("(paused )?(priority )?(maxretries )?(autoeat )?(localbook )?(os )?(env )*(layers )?")},
      {"layers", std::regex("(layer )+")},
      {"layer", std::regex("cmd range chunk (cores )?(threadable )?(memory )?(gpus )?(gpu )?(gpu_memory )?(timeout )?"
                           "(timeout_llu )?(tags )?(limits )?(env )*(services )?")},
      {"services", std::regex("(service )+")},
      {"depends", std::regex("(depend )*")},
      {"depend", std::regex("depjob (deplayer )?(depframe )?onjob (onlayer )?(onframe )?")}};
  std::vector<std::pair<std::string, std::string>> open = {{"", ""}};  // open elements and their children so far
  const std::regex tag("<(/?)([a-z_]+)([^>]*)>");
  int layers = 0, depends = 0;
  for (auto i = std::sregex_iterator(text.begin(), text.end(), tag); i != std::sregex_iterator(); ++i) {
    const std::string name = (*i)[2];
    if ((*i)[1].length() == 0) {
      open.back().second += name + " ";
      open.push_back({name, ""});
      layers += name == "layer";
      depends += name == "depend";
      if (name == "layer" || name == "job") {
        EXPECT_TRUE(std::regex_search((*i)[3].str(), std::regex(" name=\"[\\w.-]+\"")));
      }
      continue;
    }
    ASSERT_EQ(open.back().first, name) << "mismatched closing tag";
    const auto rule = children.find(name);
    if (rule == children.end()) {
      EXPECT_EQ(open.back().second, "") << name << " may contain text only";
    } else {
      EXPECT_TRUE(std::regex_match(open.back().second, rule->second)) << name << ": " << open.back().second;
    }
    open.pop_back();
  }
  EXPECT_EQ(open.size(), 1u);
  EXPECT_EQ(layers, 3);
  EXPECT_EQ(depends, 2);
  EXPECT_NE(text.find("a &amp; b &lt; c"), std::string::npos);
}

TEST_F(BatchSubmit, ScriptsAreValidShellAndCallTheGivenProgram) {
  for (const char* engine : {"--slurm", "--parallel 3"}) {
    const std::string text =
        submit(std::string("-o s.####.exr --frames 1-3 --shards 2 --program /opt/o/orrery --type float ") + engine);
    write("job.sh", text);
    EXPECT_EQ(std::system(("sh -n '" + (folder_ / "job.sh").string() + "'").c_str()), 0) << text;
    EXPECT_NE(text.find("/opt/o/orrery render good.toml"), std::string::npos) << text;
    EXPECT_NE(text.find("/opt/o/orrery merge "), std::string::npos) << text;
    EXPECT_NE(text.find("--type float"), std::string::npos) << text;
  }
}

TEST_F(BatchSubmit, ParallelDoesNotSeeTheNamesOfFiles) {
  const std::string text = submit("-o 'o{1}.exr' --shards 2 --parallel 2");
  EXPECT_NE(text.find("'sh -c \"$ORRERY_render\" sh {1} {2}'"), std::string::npos) << text;
  EXPECT_EQ(text.find("--resume-failed"), std::string::npos) << "which skips tasks by their number, whatever they do";
}

/// Runs generated jobs with mocks of the engines, and of orrery, which writes its arguments to the file `calls`.
class BatchHostileNames : public BatchSubmit {
 protected:
  void SetUp() override {
    BatchSubmit::SetUp();
    std::filesystem::create_directory(folder_ / "mocks");
    write_script("orrery", "printf '<%s>\\n' \"$@\" >> \"$CALLS\"\n");
    write_script("sbatch", R"sh(
script=$(mktemp)
cat > "$script"
last=$(sed -n 's/^#SBATCH --array=0-//p' "$script")
for task in $(seq 0 "$last"); do SLURM_ARRAY_TASK_ID=$task sh "$script" > /dev/null; done
rm "$script"
echo 1
)sh");
    // --jobs N --joblog FILE COMMAND ::: FRAMES [::: SHARDS]
    write_script("parallel", R"sh(
[ "$1 $3" = "--jobs --joblog" ] || exit 1
: > "$4" || exit 1
command=$5
shift 6
frames= shards=none
while [ $# -gt 0 ] && [ "$1" != ::: ]; do frames="$frames $1"; shift; done
[ $# -eq 0 ] || { shift; shards=$*; }
for frame in $frames; do for shard in $shards; do
  sh -c "$(printf %s "$command" | sed "s/{1}/$frame/; s/{2}/$shard/")" || exit 1
done; done
)sh");
  }

  void write_script(const std::string& name, const std::string& text) {
    write("mocks/" + name, "#!/bin/sh\n" + text);
    std::filesystem::permissions(folder_ / "mocks" / name, std::filesystem::perms::owner_all);
  }

  int run_shell(const std::string& command) {
    write("run.sh", command);
    return std::system(
        ("cd '" + folder_.string() + "' && PATH=\"$PWD/mocks:$PATH\" CALLS=\"$PWD/calls\" sh run.sh").c_str());
  }

  static std::string quoted(const std::string& word) {
    return "'" + std::regex_replace(word, std::regex("'"), "'\\''") + "'";
  }

  static std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
      text.replace(at, what.size(), by);
    return text;
  }

  /// Runs a job for two frames in two shards.
  void run_job(char engine, const std::string& text) {
    if (engine == 'S' || engine == 'P') {
      EXPECT_EQ(run_shell(text), 0) << text;
    } else if (engine == 'J') {
      const auto job = nlohmann::json::parse(text);
      for (const auto& step : job["steps"])
        for (const std::string frame : {"1", "2"})
          for (const std::string shard : {"1", "2"}) {
            if (step["name"] == "Merge" && shard == "2") continue;
            const auto& action = step["script"]["actions"]["onRun"];
            std::string command = quoted(action["command"]);
            for (const std::string word : action["args"])
              command +=
                  " " + quoted(replaced(replaced(word, "{{Task.Param.Frame}}", frame), "{{Task.Param.Shard}}", shard));
            EXPECT_EQ(run_shell(command), 0) << command;
          }
    } else {
      const std::regex element("<cmd>([^<]*)</cmd>");
      for (auto i = std::sregex_iterator(text.begin(), text.end(), element); i != std::sregex_iterator(); ++i)
        for (const std::string frame : {"1", "2"}) {
          std::string command = replaced(replaced((*i)[1], "&lt;", "<"), "&gt;", ">");
          // As OpenCue does, also in names.
          for (const char* token : {"#FRAME#", "#IFRAME#", "#ZFRAME#", "#LAYER#"})
            command = replaced(command, token, frame);
          EXPECT_EQ(run_shell(replaced(command, "&amp;", "&")), 0) << command;
        }
    }
  }
};

/// A finished render that missed its target, or was stopped, is not repeated; other failures are, three times in all.
TEST_F(BatchHostileNames, OnlyWhatMayHelpIsRepeated) {
  for (const auto& [status, tries] : {std::pair{0, 1}, {2, 1}, {65, 1}, {66, 1}, {71, 3}, {74, 3}, {75, 1}, {76, 1}}) {
    std::filesystem::remove(folder_ / "calls");
    write_script("orrery", "echo call >> \"$CALLS\"; exit " + std::to_string(status));
    EXPECT_EQ(run_shell(submit("-o a.exr --noise 0.1 --strict --parallel 1")) != 0, status != 0);
    std::string calls;
    for (int i = 0; i < tries; ++i) calls += "call\n";
    EXPECT_EQ(text_of(folder_ / "calls"), calls) << status;
  }
  const std::string slurm = submit("-o a.exr --noise 0.1 --strict --slurm");
  EXPECT_NE(slurm.find("  0 | 2 | 65 | 66 | 76) exit $status ;;"), std::string::npos) << slurm;
  EXPECT_NE(submit("-o a.exr --noise 0.1 --strict --opencue").find("<maxretries>0<"), std::string::npos);
  EXPECT_NE(submit("-o a.exr --noise 0.1 --opencue").find("<maxretries>3<"), std::string::npos);
}

/// The program itself renders and merges: its outputs are in a folder of the scene's name.
TEST_F(BatchHostileNames, OutputsMayHaveThePatternOfTheScene) {
  write_script("orrery", "exec \"" ORRERY_PROGRAM "\" \"$@\"\n");
  for (const char* engine : {"--parallel 1", "--slurm"}) {
    const std::string job =
        submit("-o 'out/{scene}/x.####.png' -o '{scene}.##.exr' --frames 1-2 --shards 2 " + std::string(engine));
    std::filesystem::create_directories(folder_ / "out/good");
    EXPECT_EQ(run_shell(job), 0) << job;
    for (const char* file : {"out/good/x.0001.png", "out/good/x.0002.png", "good.01.exr", "good.02.exr"})
      EXPECT_TRUE(std::filesystem::remove(folder_ / file)) << file;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/{scene}"));
    std::filesystem::remove_all(folder_ / "out");
  }
}

TEST_F(BatchSubmit, ATitleThatNoFrameCanHaveIsFoundByAllCommands) {
  for (const char* command :
       {"check good.toml", "info good.toml", "submit good.toml -o a.png --slurm", "render good.toml -o a.png"}) {
    const Outcome r = run(command + std::string(" --set 'annotation.title=\"{scene}\"'"));
    EXPECT_EQ(r.status, 65) << command;
    EXPECT_TRUE(contains(r.err, "annotation.title: {scene}")) << r.err;
  }
}

TEST_F(BatchHostileNames, ArriveUnchangedOrAreRefused) {
  struct Name {
    std::string text;
    std::string refused_by;  ///< engines: Slurm, GNU Parallel, OpenJD, OpenCue
  };
  const std::vector<Name> names = {{"x\nEND\ntouch PWNED; : '", "SPJC"},
                                   {"x\ntouch PWNED\n", "SPJC"},
                                   {"x\rtouch PWNED\r", "SPJC"},
                                   {"tab\there", "SPJC"},
                                   {"\x1B[2J", "SPJC"},
                                   {"\xC2\x85", "SPJC"},
                                   {"bad\xFF", "SPJC"},
                                   {"\x01", "SPJC"},
                                   {"$(touch PWNED)", ""},
                                   {"`touch PWNED`", ""},
                                   {"'; touch PWNED; '", ""},
                                   {"a\"; touch PWNED; \"", "S"},
                                   {"back\\slash\\n", "S"},
                                   {"a & b < c > d | touch PWNED", ""},
                                   {"]]>&amp;--><x>", ""},
                                   {"{1}{2}{}", ""},
                                   {"{{Task.Param.Frame}}", "J"},
                                   {"{{Param.x", "J"},
                                   {"#IFRAME#", "C"},
                                   {"##FRAME##", "C"},
                                   {"#ZFRAME#.#LAYER#", "C"},
                                   {"@FRAME@ @SHARD@", ""},
                                   {"%a%j%%", ""},
                                   {"~", ""},
                                   {"* ? [a]", ""},
                                   {"!x $HOME ${x}", ""},
                                   {"-x", ""},
                                   {"--log=PWNED", ""},
                                   {"+x", ""},
                                   {"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80", ""}};
  const std::vector<std::pair<char, std::string>> engines = {
      {'S', "--slurm"}, {'P', "--parallel 2"}, {'J', "--openjd"}, {'C', "--opencue"}};
  for (const Name& name : names)
    for (const auto& [engine, option] : engines) {
      SCOPED_TRACE(option + " " + name.text);
      const std::string scene = name.text + ".toml", image = name.text + ".%d.png";
      write(scene, kGoodScene);
      std::filesystem::remove(folder_ / "calls");
      const Outcome r = run("submit " + option + " --frames 1-2 --shards 2 --output=" + quoted(image) +
                            " --set 'sphere[0].name=\"it'\\''s $x\"' -- " + quoted(scene));
      const bool is_refused = name.refused_by.find(engine) != std::string::npos;
      EXPECT_EQ(r.status, is_refused ? 2 : 0) << r.err;
      if (r.status != 0) {
        EXPECT_EQ(r.out, "");
        continue;
      }
      run_job(engine, r.out);
      std::map<std::string, int> calls;
      std::istringstream lines(text_of(folder_ / "calls"));
      for (std::string line; std::getline(lines, line);) ++calls[line];
      const std::string prefix = name.text[0] == '-' || name.text[0] == '+' ? "./" : "";
      EXPECT_EQ(calls["<render>"], 4);
      EXPECT_EQ(calls["<merge>"], 2);
      EXPECT_EQ(calls["<" + prefix + scene + ">"], 4);
      EXPECT_EQ(calls["<sphere[0].name=\"it's $x\">"], 4);
      EXPECT_EQ(calls["<" + image + ">"] + calls["<--output=" + image + ">"], 2);
      EXPECT_FALSE(std::filesystem::exists(folder_ / "PWNED"));
    }
}

TEST_F(BatchSubmit, FoldersThatSlurmCannotWriteLogsToAreRefused) {
  for (const char* folder : {"100%", "a\"b", "a\\b"}) {
    std::filesystem::create_directory(folder_ / folder);
    const std::string words = "submit good.toml -o '" + std::string(folder) + "/s.exr' ";
    EXPECT_EQ(run(words + "--slurm").status, 2) << folder;
    EXPECT_EQ(run(words + "--parallel 1").status, 0) << folder;
  }
}

}  // namespace
}  // namespace orrery::test
