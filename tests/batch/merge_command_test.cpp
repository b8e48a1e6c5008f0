// SPDX-License-Identifier: Apache-2.0
// One image rendered by many processes: shards, merging, and shards that must not be merged.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <random>
#include <vector>

#include "cli/program.h"
#include "support/paced_program.h"

namespace orrery::test {
namespace {

class BatchMerge : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("good.toml", std::string(kGoodScene) +
                           "[material.lamp]\ntype = \"emitter\"\nradiance = [4, 5, 6]\nlight_group = \"key\"\n"
                           "[[sphere]]\ncenter = [0.5, 0.7, -1]\nradius = 0.2\nmaterial = \"lamp\"\n");
    ASSERT_EQ(run("render good.toml -o whole.exr" + settings_).status, 0);
    whole_ = text_of(folder_ / "whole.exr");
  }
  void render(const std::string& name, const std::string& which) {
    const Outcome r = run("render good.toml -o " + name + settings_ + which);
    ASSERT_EQ(r.status, 0) << r.err;
  }
  /// Merges the shards in random order.
  Outcome merge(std::vector<std::string> parts, const std::string& more = "") {
    std::shuffle(parts.begin(), parts.end(), random_);
    std::string words;
    for (const std::string& part : parts) words += part + " ";
    return run("merge " + words + "-o merged.exr --reproducible " + more);
  }
  void expect_refused(const Outcome& r, int status, const std::vector<std::string>& words) {
    EXPECT_EQ(r.status, status) << r.err;
    for (const std::string& word : words)
      EXPECT_NE(r.err.find(word), std::string::npos) << r.err << "\nmissing: " << word;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "merged.exr"));
  }

  const std::string without_layers_ =
      " --set render.samples=35 --width 70 --height 45 --set background.alpha=0 --set render.filter=gaussian "
      "--reproducible -q ";
  const std::string settings_ =
      without_layers_ + "--layers Z,N,P,diffuse,emission,light_groups,variance,CryptoObject,denoise.albedo ";
  std::string whole_;
  std::minstd_rand random_{3};
};

TEST_F(BatchMerge, AnySplitMergesToTheSameBytes) {
  for (const int count : {1, 2, 3, 17}) {
    std::vector<std::string> by_samples, by_tiles;
    for (int i = 0; i < count; ++i) {
      by_samples.push_back("s" + std::to_string(i) + ".exr");
      render(by_samples.back(),
             "--sample-range " + std::to_string(35 * i / count) + ":" + std::to_string(35 * (i + 1) / count));
      by_tiles.push_back("t" + std::to_string(i) + ".exr");
      render(by_tiles.back(), "--shard " + std::to_string(i + 1) + "/" + std::to_string(count));
    }
    for (const auto& parts : {by_samples, by_tiles}) {
      const Outcome r = merge(parts, "--stats m.json");
      ASSERT_EQ(r.status, 0) << r.err;
      EXPECT_EQ(text_of(folder_ / "merged.exr"), whole_) << count;
      const auto json = nlohmann::json::parse(text_of(folder_ / "m.json"));
      EXPECT_EQ(json["samples"], 35);
      EXPECT_EQ(json["hosts"].size(), 1u);
    }
  }
}

TEST_F(BatchMerge, AReproducibleShardHasTheSameBytesInEachRun) {
  render("a.exr", "--shard 1/3");
  render("b.exr", "--shard 1/3");
  EXPECT_EQ(text_of(folder_ / "a.exr"), text_of(folder_ / "b.exr"));
}

TEST_F(BatchMerge, ShardsWithLayersMergeToAnImageWithoutLayers) {
  ASSERT_EQ(run("develop whole.exr -o whole.png -q").status, 0);
  render("a.exr", "--shard 1/2");
  render("b.exr", "--shard 2/2");
  const Outcome r = run("merge a.exr b.exr -o merged.png -q");
  ASSERT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(run("compare merged.png whole.png -q --fail-above max=0.01").status, 0);  // whole.exr is half
}

TEST_F(BatchMerge, SampleShardsAndPixelShardsCombine) {
  render("a.exr", "--sample-range 0:10 --shard 1/2");
  render("b.exr", "--sample-range 0:10 --shard 2/2");
  render("c.exr", "--sample-range 10:35");
  ASSERT_EQ(merge({"a.exr", "b.exr", "c.exr"}).status, 0);
  EXPECT_EQ(text_of(folder_ / "merged.exr"), whole_);
}

TEST_F(BatchMerge, MismatchedShardsAreNamed) {
  render("a.exr", "--sample-range 0:10");
  render("b.exr", "--sample-range 10:35");
  render("b1.exr", "--sample-range 9:35");
  expect_refused(merge({"a.exr"}), 65, {"samples 10:35"});
  expect_refused(run("merge a.exr b1.exr -o merged.exr"), 65, {"b1.exr: error: has samples that a.exr"});
  render("foreign.exr", "--sample-range 10:35 --set render.seed=8");
  ASSERT_EQ(run("render good.toml -o other.exr" + without_layers_ + "--sample-range 10:35 --layers Z").status, 0);
  expect_refused(run("merge a.exr foreign.exr other.exr nothing.exr whole.exr -o merged.exr"), 65,
                 {"foreign.exr: error: has render.seed = 8, not ", "other.exr: error: has layers",
                  "nothing.exr: error: cannot open", "whole.exr: error: whole.exr is not", "4 errors"});
  expect_refused(run("merge a.exr nothing.exr -o merged.exr"), 66, {"nothing.exr"});
  const std::string bytes = text_of(folder_ / "b.exr");
  for (const std::size_t share : {1u, 2u, 9u}) {
    write("b.exr", bytes.substr(0, bytes.size() * share / 10));
    expect_refused(run("merge a.exr b.exr -o merged.exr"), 65, {"b.exr: error"});
  }
  write("b.exr", bytes);
  expect_refused(run("merge a.exr a.exr -o merged.exr"), 2, {"a.exr is given twice"});
  render("t1.exr", "--shard 1/3");
  render("t3.exr", "--shard 3/3");
  expect_refused(run("merge t1.exr t3.exr -o merged.exr"), 65,
                 {"there is no shard with --sample-range 0:35 --shard 2/3"});
  EXPECT_EQ(run("merge a.exr b.exr -o a.exr").status, 2);  // an input
  EXPECT_EQ(text_of(folder_ / "b.exr"), bytes);
}

TEST_F(BatchMerge, MissingSamplesCanBeAllowed) {
  render("a.exr", "--sample-range 0:10");
  render("c.exr", "--sample-range 20:35");
  const Outcome r = merge({"a.exr", "c.exr"}, "--allow-missing -o merged.png --stats m.json");
  ASSERT_EQ(r.status, 0) << r.err;
  EXPECT_NE(r.err.find("warning: samples 10:20 of all pixels are missing"), std::string::npos) << r.err;
  EXPECT_NE(text_of(folder_ / "merged.exr").find("orrery/missing"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "m.json"))["samples"], 25);
  // It is as bright as the complete image: the mean is over 25 samples.
  EXPECT_EQ(run("compare merged.exr whole.exr -q --fail-above bias=0.01").status, 0);
}

TEST_F(BatchMerge, FilesThatAreNotShardsAreReportedIfThereAreNoOthers) {
  expect_refused(merge({"missing.exr"}), 66, {"missing.exr"});
  expect_refused(merge({"whole.exr"}), 65, {"whole.exr"});
  expect_refused(merge({"missing.exr"}, "--allow-missing"), 66, {"missing.exr"});
}

TEST_F(BatchMerge, DamagedShardsCanBeTreatedAsMissing) {
  render("a.exr", "--sample-range 0:10");
  render("b.exr", "--sample-range 10:35");
  const std::string bytes = text_of(folder_ / "b.exr");
  std::string flipped = bytes;
  flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 1);
  for (const std::string& damaged : {flipped, bytes.substr(0, bytes.size() / 2), std::string()}) {
    write("b.exr", damaged);
    expect_refused(run("merge a.exr b.exr -o merged.exr"), 65, {"b.exr: error"});
    for (const char* parts : {"merge a.exr b.exr", "merge b.exr a.exr", "merge b.exr a.exr nothing.exr"}) {
      const Outcome r = run(std::string(parts) + " --allow-missing -o m.exr --stats m.json");
      ASSERT_EQ(r.status, 0) << r.err;
      EXPECT_NE(r.err.find("b.exr: warning: "), std::string::npos) << r.err;
      EXPECT_NE(r.err.find("warning: samples 10:35 of all pixels are missing"), std::string::npos) << r.err;
      EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "m.json"))["samples"], 10);
    }
    expect_refused(run("merge b.exr nothing.exr --allow-missing -o merged.exr"), 65, {"b.exr: error", "nothing.exr"});
  }
}

TEST_F(BatchMerge, UnfinishedShardIsNamed) {
  render("b.exr", "--sample-range 10:35");
  // A render that is stopped at once leaves a checkpoint of its shard.
  {
    PacedProgram part(folder_, {"render", "good.toml", "-o", "a.exr", "--samples", "3000000", "--sample-range",
                                "0:2999965", "--width", "70", "--height", "45", "--progress", "arnold", "-t", "1"});
    ASSERT_TRUE(part.run_to(0)) << part.text();
    part.send(SIGTERM);
    ASSERT_EQ(part.wait(), 75) << part.text();
  }
  ASSERT_TRUE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
  ASSERT_EQ(run("render good.toml -o z.exr --samples 3000000 --sample-range 2999965:3000000 --width 70 "
                "--height 45 -q")
                .status,
            0);
  expect_refused(run("merge a.checkpoint.exr z.exr -o merged.exr"), 65,
                 {"a.checkpoint.exr: error: is unfinished", "--resume"});
  EXPECT_EQ(run("merge a.checkpoint.exr z.exr -o merged.exr --allow-missing -q").status, 0);
}

TEST_F(BatchMerge, InvalidShardOptionsAreRejected) {
  const auto refused = [&](const std::string& words) {
    const Outcome r = run("render good.toml " + words);
    EXPECT_EQ(r.status, 2) << words << "\n" << r.err;
    EXPECT_FALSE(r.err.empty());
  };
  for (const char* range : {"5:5", "7:3", ":", "0:", ":4", "a:b", "0:4294967296", "-1:3", "0:3:4"})
    refused(std::string("-o a.exr --sample-range ") + range);
  for (const char* tiles : {"0/2", "3/2", "1", "1/0", "a/b", "1/99999999"})
    refused(std::string("-o a.exr --shard ") + tiles);
  EXPECT_TRUE(contains(run("render good.toml -o a.exr --shard 1/65537").err, "N up to 65536"));
  refused("-o a.png --shard 1/2");
  refused("-o a.exr -o b.exr --shard 1/2");
  refused("-o a.exr --shard 1/2 --noise 0.1");
  refused("-o a.exr --shard 1/2 --deep d.exr");
  refused("-o a.exr --sample-range 0:5");  // the scene has four
}

TEST_F(BatchMerge, SceneOptionFindsAMovedScene) {
  render("a.exr", "");
  render("b.exr", "--sample-range 0:35");
  std::filesystem::rename(folder_ / "good.toml", folder_ / "moved.toml");
  EXPECT_EQ(run("merge b.exr -o merged.exr").status, 66);
  ASSERT_EQ(run("merge b.exr -o merged.exr --scene moved.toml --reproducible").status, 0);
  EXPECT_EQ(text_of(folder_ / "merged.exr"), whole_);
  // A different scene of that name gives a different image.
  write("moved.toml", std::string(kGoodScene) + "[[sphere]]\ncenter = [0, 1, -1]\nradius = 0.1\nmaterial = \"grey\"\n");
  std::filesystem::remove(folder_ / "merged.exr");
  expect_refused(run("merge b.exr -o merged.exr --scene moved.toml"), 65, {"moved.toml", "b.exr"});
}

}  // namespace
}  // namespace orrery::test
