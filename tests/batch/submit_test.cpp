// SPDX-License-Identifier: Apache-2.0
// Checks generated jobs against the specifications of the schedulers. slurm.sh and parallel.sh run the scripts for
// Slurm and GNU parallel.
#include <nlohmann/json.hpp>

#include <regex>
#include <set>

#include "cli/program.h"

namespace orrery::test {
namespace {

class BatchSubmit : public ProgramTest {
 protected:
  std::string submit(const std::string& words) {
    const Outcome r = run("submit good.toml " + words);
    EXPECT_EQ(r.status, 0) << r.err;
    return r.out;
  }
};

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

TEST_F(BatchSubmit, PassesOutputOptionsOnAsTyped) {
  const std::string text = submit(
      "-o s.exr -o s.png --stats s.json --time 90s --bits 16 --exposure -1.5 --disk-limit 8G --multipart "
      "--compression dwaa:45 --type float --parallel 1");
  EXPECT_NE(
      text.find("-o s.exr -o s.png --type float --compression dwaa:45 --multipart --disk-limit 8G --exposure -1.5 "
                "--bits 16 --time 90s --stats s.json --resume"),
      std::string::npos)
      << text;
}

/// Two jobs of one scene with different settings must not find each other's shards.
TEST_F(BatchSubmit, ShardsBelongToTheImage) {
  const std::string a = submit("-o red.exr --shards 2 --slurm"),
                    b = submit("-o blue.####.exr --frames 1-2 --shards 2 --openjd");
  EXPECT_NE(a.find("-o red.exr.shards/%d.\"$shard\".shard.exr"), std::string::npos) << a;
  EXPECT_NE(a.find("merge red.exr.shards/\"$frame\".1.shard.exr"), std::string::npos) << a;
  EXPECT_NE(b.find("blue.____.exr.shards.%d."), std::string::npos) << b;
}

TEST_F(BatchSubmit, ParallelDoesNotSeeTheNamesOfFiles) {
  const std::string text = submit("-o 'o{1}.exr' --shards 2 --parallel 2");
  EXPECT_NE(text.find("'sh -c \"$ORRERY_render\" sh {1} {2}'"), std::string::npos) << text;
  EXPECT_EQ(text.find("--resume-failed"), std::string::npos) << "which skips tasks by their number, whatever they do";
}

TEST_F(BatchSubmit, NamesCannotAddLinesToScripts) {
  write("a\nrm -rf x.toml", kGoodScene);
  const Outcome r = run("submit 'a\nrm -rf x.toml' -o s.exr --slurm");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(r.out.find("\nrm -rf x.toml,"), std::string::npos) << r.out;
  EXPECT_EQ(run("submit good.toml -o 's\"x.exr' --slurm").status, 2);
  EXPECT_EQ(run("submit good.toml -o '{{Param.x}}.exr' --openjd").status, 2);
}

TEST_F(BatchSubmit, InvalidJobsFailAtSubmission) {
  const auto expect = [&](const std::string& words, int status, const std::string& word) {
    const Outcome r = run("submit " + words);
    EXPECT_EQ(r.status, status) << words << "\n" << r.err;
    EXPECT_NE(r.err.find(word), std::string::npos) << r.err;
    EXPECT_EQ(r.out, "");
  };
  expect("good.toml -o s.exr", 2, "one of --slurm");
  expect("good.toml -o s.exr --slurm --openjd", 2, "one of --slurm");
  expect("good.toml -o s.exr --frames 1-3 --slurm", 2, "one name for 3 frames");
  expect("good.toml -o s.xyz --slurm", 2, "unknown image format .xyz");
  expect("nothing.toml -o s.exr --slurm", 66, "nothing.toml");
  expect("good.toml -o s.exr --slurm --set camera.vfow=3", 65, "vfow");
  expect("good.toml -o s.exr --slurm --shards 2 --noise 0.1", 2, "--shards");
  expect("good.toml -o s.exr --slurm --queue all", 2, "--queue");
}

}  // namespace
}  // namespace orrery::test
