// SPDX-License-Identifier: Apache-2.0
// Equivalent spellings of an override have the same effect in every command.
#include <tuple>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace orrery::test {
namespace {

/// Spellings of `table.key=value` for --set, quoted for the shell.
std::vector<std::string> spellings(const std::string& table, const std::string& key, const std::string& value) {
  return {"'" + table + "." + key + "=" + value + "'", "' " + table + " . " + key + " = " + value + " '",
          "'" + table + "={" + key + "=" + value + "}'", "'\"" + table + "\"." + key + "=" + value + "'",
          "'" + table + " = { \"" + key + "\" = " + value + "}'"};
}

class CliOverrides : public ProgramTest {};

TEST_F(CliOverrides, LimitAdaptiveSampling) {
  for (const std::string& setting : spellings("render", "samples", "20")) {
    const Outcome r = run("render good.toml -o a.exr --noise 0.0001 --stats s.json -q --set " + setting);
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "s.json"))["samples_most"], 20) << setting;
  }
}

TEST_F(CliOverrides, RequestLayersThatAnOutputMustHold) {
  for (const std::string& setting : spellings("output", "layers", "[\"Z\"]")) {
    const Outcome r = run("render good.toml -o a.png --set " + setting);
    EXPECT_EQ(r.status, 2) << setting;
    EXPECT_TRUE(contains(r.err, "the requested layers")) << r.err;
  }
}

TEST_F(CliOverrides, ConflictWithOptions) {
  for (const std::string& setting : spellings("render", "samples", "9")) {
    const Outcome r = run("render good.toml -o a.exr --samples 5 --set " + setting);
    EXPECT_EQ(r.status, 2) << setting;
    EXPECT_TRUE(contains(r.err, "set the same key")) << r.err;
  }
  EXPECT_EQ(run("info good.toml --samples 5 --set 'render={seed=9}'").status, 0);
}

TEST_F(CliOverrides, ConflictWithOptionsOfPlots) {
  write("a.csv", "x,y,z,radius\n0,0,0,1\n3,0,0,1\n");
  for (const auto& [option, table, key, value] :
       std::vector<std::tuple<std::string, std::string, std::string, std::string>>{
           {"--title a", "annotation", "title", "\"b\""},
           {"--scale-bar 2", "annotation", "scale_bar", "1"},
           {"--color-bar", "annotation", "color_bar", "false"},
           {"--outline 1", "annotation", "outline", "2"},
           {"--font DejaVuSans", "annotation", "font", "\"DejaVuSerif\""},
           {"--perspective 30", "camera", "vfov", "40"},
           {"--turntable 1s", "animation", "turntable", "2"},
           {"--fps 5", "animation", "fps", "6"}}) {
    for (const std::string& setting : spellings(table, key, value)) {
      const Outcome r = run("plot a.csv -o a.####.png --samples 1 --frames 1 " + option + " --set " + setting);
      EXPECT_EQ(r.status, 2) << option << ' ' << setting;
      EXPECT_TRUE(contains(r.err, option.substr(0, option.find(' ')) + " and --set ")) << r.err;
      EXPECT_TRUE(contains(r.err, "set the same key")) << r.err;
    }
  }
}

TEST_F(CliOverrides, FrameThePlot) {
  write("a.csv", "x,y,z,radius\n0,0,0,1\n3,0,0,1\n");
  const auto scene_of = [&](const std::string& options) {
    std::filesystem::remove(folder_ / "s.toml");
    const Outcome r = run("plot a.csv -o a.ppm --save-scene s.toml -q --height 9 --samples 1 " + options);
    EXPECT_EQ(r.status, 0) << r.err;
    return text_of(folder_ / "s.toml") + text_of(folder_ / "a.ppm");
  };
  const std::string expected = scene_of("--width 16");
  for (const std::string& setting : spellings("image", "width", "16"))
    EXPECT_EQ(scene_of("--set " + setting), expected) << setting;
}

/// An image is skipped if it exists: the spelling is no difference.
TEST_F(CliOverrides, AreComparedByValue) {
  ASSERT_EQ(run("render good.toml -o a.exr -q --set render.samples=2").status, 0);
  for (const std::string& setting : spellings("render", "samples", "2")) {
    const Outcome r = run("render good.toml -o a.exr --skip-existing --set " + setting);
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(contains(r.err, "skipped")) << setting << r.err;
  }
}

TEST_F(CliOverrides, AnEmptyValueOfLayersSelectsNone) {
  EXPECT_EQ(run("render good.toml -o a.exr -q --set output.layers=[Z]").status, 0);
  const std::string with = text_of(folder_ / "a.exr");
  const Outcome r = run("render good.toml -o a.exr -q --layers \"\"");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_LT(text_of(folder_ / "a.exr").size(), with.size());
}

TEST_F(CliOverrides, NumbersHaveNoLeadingZeros) {
  const Outcome r = run("check good.toml --samples 064");
  EXPECT_EQ(r.status, 65);
  EXPECT_TRUE(contains(r.err, "--samples: error: render.samples must be an integer, not \"064\"")) << r.err;
}

}  // namespace
}  // namespace orrery::test
