// SPDX-License-Identifier: Apache-2.0
// The options of plot for data, view and look.
#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>
#include "cli/plot.h"

namespace orrery::test {
namespace {

using CliPlotOptions = PlotTest;

TEST_F(CliPlotOptions, FramesMayBeCountedFromTheEnd) {
  ASSERT_EQ(plot("a.dump -o a.ppm -q --color-by vx --range 0:3 --frame 2").status, 0);
  for (const char* frame : {"last", "-1"}) {
    ASSERT_EQ(plot("a.dump -o b.ppm -q --color-by vx --range 0:3 --frame " + std::string(frame)).status, 0);
    EXPECT_EQ(text_of(folder_ / "b.ppm"), text_of(folder_ / "a.ppm")) << frame;
  }
  expect_error("plot a.dump -o a.ppm --frame -3", 65, "there is no frame -3; a.dump has 2 frames");
  for (const std::string frame : {"0", "first", "1.5"})
    expect_error("plot a.dump -o a.ppm --frame " + frame, 2, "--frame: `" + frame + "` is not a frame");
  ASSERT_EQ(run("convert a.dump -o b.csv --frame last").status, 0);
  EXPECT_TRUE(contains(text_of(folder_ / "b.csv"), ",3\n")) << "vx of the last frame";
}

/// Exit status, and the number of spheres that the plot reports.
TEST_F(CliPlotOptions, RepeatedSelectionsAndSlicesCombine) {
  write("d.csv", "x,y,z,radius\n0,0,0,1\n3,0,0,1\n0,3,0,1\n3,3,0,1\n");
  for (const std::string options : {"--select 'x > 1' --select 'y > 1'", "--slice x=1 --slice y=1 --look-from 0,20",
                                    "--select 'x > 1 || x < 1' --select 'y > 1 && x > 1'"}) {
    const Outcome r = plot("d.csv -o a.ppm " + options);
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(contains(r.err, "\nplot: 1 sphere: --s")) << options << r.err;
  }
  ASSERT_EQ(run("convert d.csv -o e.csv -q --select 'x > 1' --select 'y > 1'").status, 0);
  const std::string converted = text_of(folder_ / "e.csv");
  EXPECT_TRUE(contains(converted, "\n3,3,0")) << converted;
  EXPECT_EQ(std::count(converted.begin(), converted.end(), '\n'), 2) << converted;
}

TEST_F(CliPlotOptions, OptionsWithoutEffectAreRefused) {
  expect_error("plot c.csv -o a.png --map viridis", 2, "--map has nothing to map");
  expect_error("plot c.csv -o a.png --range 0:1", 2, "--range has nothing to map");
  expect_error("plot c.csv -o a.png --component 1", 2, "only HDF5 files have components");
  expect_error("convert c.csv -o a.ply --component 1", 2, "only HDF5 files have components");
  expect_error("convert c.csv -o a.ply --color-by none --map viridis", 2, "--map has nothing to map");
}

TEST_F(CliPlotOptions, AShutterBlursTheMotionOfParticles) {
  ASSERT_EQ(plot("a.dump -o rest.ppm -q").status, 0);
  const Outcome made = plot("a.dump -o next.ppm --shutter 0.5 --save-scene s.toml");
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(made.err, "motion to the next frame")) << made.err;
  EXPECT_NE(text_of(folder_ / "next.ppm"), text_of(folder_ / "rest.ppm"));
  EXPECT_TRUE(contains(text_of(folder_ / "s.toml"), "motion = { next_frame = true }")) << text_of(folder_ / "s.toml");
  ASSERT_EQ(run("render s.toml -o again.ppm -q --width 16 --height 9 --samples 1").status, 0);
  EXPECT_EQ(text_of(folder_ / "again.ppm"), text_of(folder_ / "next.ppm"));
  ASSERT_EQ(plot("a.dump -o film.##.ppm -q --shutter 0.5 --frames all").status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "film.02.ppm"));
  write("v.csv", "x,y,z,radius,v_x,v_y,v_z\n0,0,0,1,0,1,0\n3,0,0,1,1,0,0\n");
  ASSERT_EQ(plot("v.csv -o v.ppm -q --shutter 0.5 --frame-time 2 --velocity v").status, 0);
  expect_error("plot v.csv -o v.ppm --shutter 0.5", 2, "add --frame-time T");
  expect_error("plot v.csv -o v.ppm --shutter 0.5 --velocity v", 2, "add --frame-time T");
  expect_error("plot v.csv -o v.ppm --frame-time 2 --velocity v", 2, "no effect without --shutter");
  expect_error("plot v.csv -o v.ppm --shutter 0.5 --frame-time 2", 65, "the file has no velocities");
  expect_error("plot v.csv -o v.ppm --shutter 0.5 --set camera.shutter_close=1", 2, "--shutter");
}

TEST_F(CliPlotOptions, RulesByConditionAreSaved) {
  write("m.xyz", "3\n\nC 0 0 0\nC 1.5 0 0\nO 2.2 1.2 0\n");
  const Outcome made = plot(
      "m.xyz -o a.png --representation sticks --representation 'element O: spheres' --color 'element O: #f00' --radius "
      "'element O: 0.7' --save-scene m.toml");
  ASSERT_EQ(plot("m.xyz -o b.png --radius 0.5 --radius 'element O: 0.7' --save-scene n.toml").status, 0);
  EXPECT_TRUE(contains(text_of(folder_ / "n.toml"), R"(radius = { value = 0.5, where = ["element O: 0.7"] })"));
  ASSERT_EQ(run("render n.toml -o c.png -q --samples 1").status, 0);
  EXPECT_EQ(run("compare b.png c.png --fail-above max=0").status, 0);
  ASSERT_EQ(made.status, 0) << made.err;
  const std::string text = text_of(folder_ / "m.toml");
  for (const char* part : {R"(["sticks", "element O: spheres"])", R"(["element O: #f00"])", R"(["element O: 0.7"])"})
    EXPECT_TRUE(contains(text, part)) << part << text;
  ASSERT_EQ(run("render m.toml -o b.png -q --samples 1").status, 0);
  EXPECT_EQ(run("compare a.png b.png --fail-above max=0").status, 0);
  EXPECT_TRUE(contains(run("info m.toml").out, "3 spheres, 1 rod")) << "not to the sphere";
  expect_error("plot m.xyz -o a.png --representation 'element O: cartoon'", 2, "--representation: `cartoon`");
  expect_error("plot m.xyz -o a.png --color 'element O: reddish'", 2, "`reddish` is not a colour");
  expect_error("plot m.xyz -o a.png --radius 'element O: 0'", 2, "--radius: `0` is not a radius");
  expect_error("plot m.xyz -o a.png --fit 'element H'", 65, "--fit `element H` matches none");
}

TEST_F(CliPlotOptions, MaterialsByConditionAreSaved) {
  write("m.xyz", "3\n\nC 0 0 0\nC 1.5 0 0\nO 9 0 0\n");
  const std::string options = "m.xyz --representation sticks --material matte --material 'element C: metal'";
  const Outcome made = plot(options + " --material 'element O: glass' -o a.png --save-scene m.toml");
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(text_of(folder_ / "m.toml"), R"(["element C: metal", "element O: glass"])"));
  ASSERT_EQ(run("render m.toml -o b.png -q --samples 1").status, 0);
  EXPECT_EQ(run("compare a.png b.png --fail-above max=0").status, 0);
  EXPECT_TRUE(contains(run("info m.toml").out, "2 metal, 1 dielectric")) << "coloured, and not";
  ASSERT_EQ(plot(options + " --material plastic -o c.png --save-scene p.toml").status, 0);
  EXPECT_FALSE(contains(text_of(folder_ / "p.toml"), "material_where")) << "plastic replaces them";
  expect_error("plot " + options + " --material 'element C: glass' -o a.png", 65, "bonds are opaque");
  expect_error("plot m.xyz -o a.png --material 'element C: steel'", 2, "--material: `steel` is not a material");
  expect_error("plot m.xyz -o a.png --material glas", 2, "did you mean `glass`");
}

TEST_F(CliPlotOptions, LikelyMistakesNameTheRemedy) {
  expect_error("plot c.csv -o a.png --color q", 2, "--color-by COLUMN");
  expect_error("plot c.csv -o a.png --set camera", 65, "not of the form KEY=VALUE");
  write("-c.csv", "x,y,z\n1,2,3\n");
  expect_error("plot -c.csv -o a.png", 2, "write ./-c.csv");
}

TEST_F(CliPlotOptions, ATextAmongTheNumbersOfAColumnIsExplained) {
  write("t.csv", "x,y,z,q\n0,0,0,1\n1,1,1,fast\n");
  EXPECT_TRUE(contains(plot("t.csv -o a.png --color-by q").err, "map set2: colours for categories: q is text"));
}

/// Readers look first for what they must write.
TEST_F(CliPlotOptions, HelpBeginsWithTheFileToWrite) {
  const std::string help = run("plot --help").out;
  EXPECT_LT(help.find("--output"), help.find("--select"));
  EXPECT_LT(help.find("--font"), help.find("--help"));
}

TEST_F(CliPlotOptions, TheSizeInPrintIsThatInPixels) {
  const Outcome made = run("plot c.csv -o a.png --samples 1 --dpi 100 --print-width 2.54cm");
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(made.err, "wrote a.png: 100 x 56")) << made.err;
  expect_error("plot c.csv -o a.png --print-width 8cm", 2, "add --dpi");
  expect_error("plot c.csv -o a.png --print-width 8 --dpi 300", 2, "`8` is not a length");
  expect_error("plot c.csv -o a.png --print-width 8cm --dpi 300 --width 9", 2, "--print-width and --width");
  expect_error("plot c.csv -o a.png --print-width 8000in --dpi 300", 2, "it must be 1 to");
}

TEST_F(CliPlotOptions, RangesAreFinite) {
  expect_error("plot c.csv -o a.png --color-by q --range=-1e308:1e308 --legend a.svg", 2,
               "--range: the numbers must be from -1e+300");
  EXPECT_EQ(plot("c.csv -o a.ppm -q --color-by q --range=-1e300:1e300 --legend a.svg").status, 0);
}

}  // namespace
}  // namespace orrery::test
