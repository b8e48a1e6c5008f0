// SPDX-License-Identifier: Apache-2.0
// The command submit: its options, and what it refuses.
#include <nlohmann/json.hpp>

#include <regex>
#include <set>
#include <sstream>

#include "batch/submit.h"

namespace orrery::test {
namespace {

using BatchSubmitCommand = SubmitTest;

TEST_F(BatchSubmitCommand, PassesOptionsOnAsTyped) {
  const std::string text = submit(
      "-o s.exr -o s.png --stats s.json --time 90s --bits 16 --disk-limit 8G --multipart "
      "--compression dwaa:45 --type float --samples 9 --set camera.vfov=30 --memory-limit 4G --parallel 1");
  EXPECT_NE(text.find("render good.toml --progress none -q -t \"$threads\" -o s.exr -o s.png --bits 16 "
                      "--type float --compression dwaa:45 --multipart --disk-limit 8G --set camera.vfov=30 --samples 9 "
                      "--time 90s --memory-limit 4G --stats s.json --resume"),
            std::string::npos)
      << text;
}

/// With shards, the merge makes the images and the statistics.
TEST_F(BatchSubmitCommand, ShardsGetTheOptionsOfRenderingAndTheMergeThoseOfImages) {
  const std::string text = submit(
      "-o s.exr --bits 16 --denoise --type float --stats s.json --memory-limit 4G --checkpoint 5m "
      "--samples 9 --shards 2 --slurm");
  EXPECT_NE(text.find("render good.toml --progress alf --denoise --samples 9 --checkpoint 5m --memory-limit 4G "
                      "-o s.exr.shards/%d.\"$shard\".shard.exr --shard \"$shard\"/2 --frames \"$frame\" --resume "
                      "--skip-existing &\n"),
            std::string::npos)
      << text;
  EXPECT_NE(
      text.find("merge s.exr.shards/\"$frame\".1.shard.exr s.exr.shards/\"$frame\".2.shard.exr -o s.exr --bits 16 "
                "--type float --denoise --memory-limit 4G --stats s.json\n"),
      std::string::npos)
      << text;
}

TEST_F(BatchSubmitCommand, HasEveryOptionOfRender) {
  const auto options_of = [&](const std::string& command) {
    std::set<std::string> out;
    const std::string help = run(command + " --help").out;
    const std::regex option("\n  (?:-[a-z],)?(--[a-z-]+)");
    for (auto i = std::sregex_iterator(help.begin(), help.end(), option); i != std::sregex_iterator(); ++i)
      out.insert((*i)[1]);
    return out;
  };
  const std::set<std::string> known = options_of("submit");
  EXPECT_GT(known.size(), 30u);
  for (const std::string& option : options_of("render"))
    EXPECT_EQ(known.count(option), option == "--shard" || option == "--sample-range" ? 0u : 1u) << option;
}

/// Two jobs of one scene with different settings must not find each other's shards.
TEST_F(BatchSubmitCommand, ShardsBelongToTheImage) {
  const std::string a = submit("-o red.exr --shards 2 --slurm"),
                    b = submit("-o blue.####.exr --frames 1-2 --shards 2 --openjd");
  EXPECT_NE(a.find("-o red.exr.shards/%d.\"$shard\".shard.exr"), std::string::npos) << a;
  EXPECT_NE(a.find("merge red.exr.shards/\"$frame\".1.shard.exr"), std::string::npos) << a;
  EXPECT_NE(b.find("blue.____.exr.shards.%d."), std::string::npos) << b;
}

TEST_F(BatchSubmitCommand, InvalidJobsFailAtSubmission) {
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
