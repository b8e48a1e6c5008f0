// SPDX-License-Identifier: Apache-2.0
// The command plot.
#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>
#include "cli/plot.h"

namespace orrery::test {
namespace {

using CliPlot = PlotTest;

/// The display transform of the image applies to the legend.
TEST_F(CliPlot, LegendsHaveTheSettingsOfTheImage) {
  const auto legend = [&](const std::string& options) {
    const Outcome r = plot("c.csv -o a.ppm --color-by q -q --legend l.svg " + options);
    EXPECT_EQ(r.status, 0) << r.err;
    return text_of(folder_ / "l.svg");
  };
  const std::string plain = legend("");
  EXPECT_NE(legend("--set color.exposure=-2"), plain);
  EXPECT_NE(legend("--set color.view=Raw"), plain);
}

TEST_F(CliPlot, LegendsAsImagesHaveText) {
  ASSERT_EQ(plot("c.csv -o a.ppm --color-by q -q --legend l.ppm").status, 0);
  const std::string bar = text_of(folder_ / "l.ppm");
  ASSERT_EQ(plot("c.csv -o a.ppm --color-by q --range 0:2 -q --legend l.ppm").status, 0);
  EXPECT_NE(text_of(folder_ / "l.ppm"), bar) << "other ticks";
  ASSERT_EQ(plot("a.dump -o a.ppm -q --legend l.ppm").status, 0) << "types";
  std::string many = "x,y,z,radius,q\n";
  for (int i = 0; i <= 500; ++i) many += std::to_string(i) + ",0,0,1," + std::to_string(i) + "\n";
  write("many.csv", many);
  const Outcome r = plot("many.csv -o a.ppm -q --color-by q --map tab10 --legend l.ppm");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(contains(r.err, "up to 500 values; name an .svg file")) << r.err;
}

TEST_F(CliPlot, TitlesHaveNumbersOfTheHeader) {
  write("e.xyz", "1\nProperties=species:S:1:pos:R:3 energy=-3.5 time=2\nC 0 0 0\n");
  ASSERT_EQ(plot("e.xyz -o a.svg -q --title 'E = {energy / 2:.3f} at {time}'").status, 0);
  EXPECT_TRUE(contains(text_of(folder_ / "a.svg"), ">E = -1.750 at 2<"));
  expect_error("plot e.xyz -o a.svg --title '{enthalpy}'", 65, "columns are frame, energy, time");
}

TEST_F(CliPlot, ChoicesOfTheRenderArePrinted) {
  Outcome r = run("plot a.dump -o a.ppm --width 16 --height 9");
  EXPECT_TRUE(contains(r.err, "\nplot: frame 1 of 2: ")) << r.err;
  EXPECT_TRUE(contains(r.err, "\nplot: view transform Neutral: ")) << r.err;
  EXPECT_TRUE(contains(
      r.err, "\nplot: quality good: noise 0.15, denoised; --quality, --noise, --time or --samples change it\n"))
      << r.err;
  EXPECT_TRUE(contains(r.err, "\nplot: prepared in ")) << r.err;
  EXPECT_FALSE(contains(r.err, "\nplot: size")) << r.err;
  r = plot("a.dump -o a.ppm --style flat --set color.view=Raw");
  EXPECT_FALSE(contains(r.err, "view transform") || contains(r.err, "plot: quality") || contains(r.err, "plot: style"))
      << r.err;
  r = run("plot a.dump -o a.ppm --style flat --set image.width=16 --set image.height=9");
  EXPECT_TRUE(contains(r.err, "\nplot: samples 100: ")) << r.err;
}

TEST_F(CliPlot, TimesIncludeThePlotsOwnPass) {
  const Outcome r = plot("a.dump -o a.##.ppm --frames all --stats s.##.json -v");
  ASSERT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(contains(r.err, "\nprepare ")) << r.err;
  const auto lines = std::count(r.err.begin(), r.err.end(), '\n');
  EXPECT_GT(lines, 0);
  std::size_t totals = 0;
  for (std::size_t at = r.err.find(" s in all\n"); at != std::string::npos; at = r.err.find(" s in all\n", at + 1))
    ++totals;
  EXPECT_EQ(totals, 2u) << "one per frame: " << r.err;
  EXPECT_GT(nlohmann::json::parse(text_of(folder_ / "s.01.json"))["seconds"]["prepare"], 0);
}

/// The second frame is malformed, which is an error only when it is read.
TEST_F(CliPlot, RequestsAreCheckedBeforeFramesAreRead) {
  write("bad.dump", frame({"1 1 0 0 zero 1 0"}) + frame({"1 1 0 0 0 1 0"}));
  const std::string plot = "plot bad.dump ";
  expect_error(plot + "-o a.ppm", 65, "'zero' is not a number");
  expect_error(plot + "-o none/a.png", 73, "none");
  write("worse.dump", frame({"1 1 0 0 0 1 0"}) + frame({"1 1 0 0 zero 1 0"}) + frame({"1 1 0 0 0 1 0"}));
  expect_error("plot worse.dump -o a.png --frames all", 2,
               "a.png is one name for 3 frames; add a frame pattern, e.g. a.####.png");
  expect_error(plot + "-o a.##.png", 2, "a.##.png has a frame pattern");
  expect_error(plot + "-o a.png --layers Z", 2, "the requested layers");
  expect_error(plot + "-o a.png --bits 32", 2, "bits");
  expect_error(plot + "-o a.png --material wood", 2, "wood");
  expect_error(plot + "-o a.png --material glass --color-by type", 2, "glass has no colour");
  expect_error(plot + "-o a.png --set color.view=Rw", 65, "did you mean `Raw`?");
  expect_error(plot + "-o a.png --set render.samples=0", 65, "render.samples");
}

TEST_F(CliPlot, ASelectionThatMatchesNothingIsAnError) {
  Outcome r = plot("c.csv -o none.ppm --select 'q > 5'");
  EXPECT_EQ(r.status, 65) << r.err;
  EXPECT_TRUE(contains(r.err, "nothing to render: --select leaves none of the 2 particles")) << r.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.ppm"));
  r = plot("c.csv -o none.ppm --select 'q > 5' --allow-empty");
  EXPECT_EQ(r.status, 0) << r.err;
  write("empty.xyz", "0\n\n");
  EXPECT_EQ(plot("empty.xyz -o none.ppm").status, 65);
  EXPECT_EQ(plot("empty.xyz -o none.ppm --allow-empty").status, 0);
}

/// One setting in three spellings: the projection, the field of view, or both.
TEST_F(CliPlot, PerspectiveAndTurntableAreFitted) {
  const auto scene = [&](const std::string& options) {
    const Outcome r = plot("c.csv -o a.ppm --save-scene s.toml -q " + options);
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(r.err, "");
    return text_of(folder_ / "s.toml");
  };
  const std::string wide = scene("--set 'camera.projection=\"perspective\"'");
  EXPECT_FALSE(contains(wide, "orthographic")) << wide;  // the defaults: perspective, 90 degrees
  EXPECT_EQ(scene("--set camera.vfov=90"), wide);
  const std::string narrow = scene("--set camera.vfov=30");
  EXPECT_TRUE(contains(narrow, "vfov = 30")) << narrow;
  EXPECT_EQ(scene("--set camera.vfov=30 --set 'camera.projection=\"perspective\"'"), narrow);
  EXPECT_FALSE(contains(scene("--set animation.turntable=0"), "up = [0.0, 0.0, 1.0]"));
  EXPECT_TRUE(contains(scene("--set animation.turntable=4"), "turntable = 4")) << text_of(folder_ / "s.toml");
}

TEST_F(CliPlot, BondsAreDrawnAndSaved) {
  write("m.xyz", "3\n\nC 0 0 0\nC 1.5 0 0\nO 2.2 1.2 0\n");
  const Outcome balls = plot("m.xyz -o a.png --representation ball-and-stick --save-scene m.toml");
  ASSERT_EQ(balls.status, 0) << balls.err;
  EXPECT_TRUE(contains(balls.err, "plot: 2 bonds: closer than 1.2 times")) << balls.err;
  EXPECT_TRUE(contains(text_of(folder_ / "m.toml"), "bonds = true\n"));
  ASSERT_EQ(run("render m.toml -o b.png -q --samples 1").status, 0);
  EXPECT_EQ(run("compare a.png b.png --fail-above max=0").status, 0);
  EXPECT_TRUE(contains(run("info m.toml").out, "points      m.xyz: 3 spheres, 2 rods of bonds\n"));
  ASSERT_EQ(plot("m.xyz -o a.png -q --bonds length=1.45 --save-scene l.toml").status, 0);
  EXPECT_TRUE(contains(text_of(folder_ / "l.toml"), "bonds = { length = 1.45 }\n"));
  ASSERT_EQ(plot("m.xyz -o a.png -q --bonds 1.1 --save-scene f.toml").status, 0);
  EXPECT_TRUE(contains(text_of(folder_ / "f.toml"), "bonds = { factor = 1.1 }\n"));
}

TEST_F(CliPlot, BondsThatCannotBeDrawnAreErrors) {
  for (const std::string bonds : {"no", "length=", "length=0", "-1", "length=1e30", "nan"})
    expect_error("plot a.dump -o a.ppm --bonds=" + bonds, 2, "--bonds: `" + bonds + "`");
  expect_error("plot a.dump -o a.ppm --bonds 3", 2, "write --bonds length=3");
  expect_error("plot a.dump -o a.ppm --radius vdw", 65, "--element-radii vdw");
  expect_error("plot a.dump -o a.ppm --bonds file", 65, "set `from = \"distance\"`");
  expect_error("plot a.dump -o a.ppm --representation sticks", 65, "or --bonds length=X, to the largest length");
  expect_error("plot a.dump -o a.ppm --vectors x,y", 65, "has 2 columns; a vector has three");
  expect_error("plot a.dump -o a.ppm --vectors x,y,nothing", 65, "nothing");
  expect_error("plot a.dump -o a.ppm --vectors x,y,z --material glass", 2, "arrows of glass");
  expect_error("plot c.csv -o a.ppm --box", 65, "--box: c.csv has no simulation box");
  expect_error("plot a.dump -o a.ppm --representation stick", 2, "did you mean `sticks`");
}

TEST_F(CliPlot, ATopologyFitsTheTrajectory) {
  const std::string seeds = ORRERY_ROOT "/tests/fuzz/corpus/data/";
  const Outcome r = plot(seeds + "xtc/water.xtc -o a.ppm --frame 2 --title '{step} {time:.1f}' --unwrap --topology " +
                         seeds + "gro/water.gro --bonds auto");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(contains(r.err, "20 bonds")) << r.err;
  expect_error("plot " + seeds + "xtc/few.xtc -o a.ppm --topology " + seeds + "gro/water.gro", 65, "5 atoms");
  expect_error("plot " + seeds + "xtc/few.xtc -o a.ppm --topology none.pdb", 66, "none.pdb");
  expect_error("plot " + seeds + "xtc/few.xtc -o a.ppm --color-by element", 65, "--topology FILE");
  expect_error("plot " + seeds + "psf/water.psf -o a.ppm", 65, "no positions");
  expect_error("info a.dump --topology c.csv", 65, "needs no topology");
  EXPECT_EQ(run("info " + seeds + "dcd/water.dcd --topology " + seeds + "gro/water.gro").status, 0);
}

TEST_F(CliPlot, ScenesAndDataFilesAreDistinguished) {
  write("b.mmcif", "data_b\nloop_\n_atom_site.cartn_x\n_atom_site.cartn_y\n_atom_site.cartn_z\n1 2 3\n");
  write("c.csv.gz", "\x1f\x8b\x08");
  write("dump.txt", frame({}));
  for (const std::string data : {"a.dump", "b.mmcif", "c.csv", "c.csv.gz", "dump.txt"})
    for (const std::string& command : {"render " + data + " -o a.png", "check " + data, "study " + data,
                                       "submit " + data + " -o a.##.png --frames 1-2 --slurm"})
      expect_error(command, 2, "; render it: orrery plot " + data + " -o IMAGE");
  write("scene.txt", "[image\n");
  expect_error("check scene.txt", 65, "scene.txt:1:");
  expect_error("plot good.toml -o a.png", 2, "; render it: orrery render good.toml");
  write("bad.TOML", "[image\n");
  expect_error("plot bad.TOML -o a.png", 2, "; render it: orrery render bad.TOML");
}

/// A pattern stands for files only if no file has this very name, and only in the name of the file.
TEST_F(CliPlot, NamesLikeFramePatternsAreRead) {
  std::filesystem::create_directory(folder_ / "run##2");
  for (const std::string name : {"20%density.csv", "run##2/a.csv", "a.##.csv"}) {
    write(name, "x,y,z,radius\n0,0,0,1\n");
    std::filesystem::remove(folder_ / "a.toml");
    EXPECT_EQ(plot("'" + name + "' -o a.ppm -q --save-scene a.toml").status, 0) << name;
    EXPECT_EQ(run("check a.toml -q").status, 0) << name;
    EXPECT_EQ(run("convert '" + name + "' -o a.PLY -q").status, 0) << name;
    EXPECT_EQ(run("submit a.toml -o a.##.png --frames 1-2 --slurm").status, 0) << name;
  }
  expect_error("plot 30%density.csv -o a.png", 66, "301ensity.csv");
}

/// Without pointing into a scene that nobody wrote.
TEST_F(CliPlot, NamesThatScenesCannotHoldAreRefused) {
  write("bad\xff.dump", frame({"1 1 0 0 0 1 0"}));
  expect_error("plot 'bad\xff.dump' -o a.png", 2, "is not valid UTF-8");
  write("caf\xc3\xa9.dump", frame({"1 1 0 0 0 1 0"}));
  EXPECT_EQ(plot("'caf\xc3\xa9.dump' -o a.ppm -q").status, 0);
}

TEST_F(CliPlot, NamesOfParticlesThatAreNoElementsAreTypes) {
  write("model.xyz", "4\n\nA 0 0 0\nB 2 0 0\nC1 4 0 0\nH2 6 0 0\n");
  const Outcome r = plot("model.xyz -o a.ppm");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(contains(r.err, "radius 1: half the median distance")) << r.err;
  EXPECT_TRUE(contains(r.err, "colour by type")) << r.err;
}

TEST_F(CliPlot, AdiosFoldersAreRefused) {
  for (const char* name : {"a.bp", "a.bp4", "a.bp5"}) {
    std::filesystem::create_directory(folder_ / name);
    expect_error(std::string("plot ") + name + " -o a.png", 65, "ADIOS2 files are not supported");
    expect_error(std::string("info ") + name, 65, "ADIOS2 files are not supported");
  }
}

/// What convert writes is plotted like what it read, whatever the format.
TEST_F(CliPlot, ColorsSurviveConversion) {
  write("rgb.csv", "x,y,z,radius,red,green,blue\n0,0,0,1,255,13,128\n3,0,0,1,1,254,77\n");
  ASSERT_EQ(plot("rgb.csv -o a.ppm --up z -q").status, 0);
  const std::string expected = text_of(folder_ / "a.ppm");
  for (const std::string name : {"b.ply", "b.xyz", "b.npy", "b.csv"}) {
    ASSERT_EQ(run("convert rgb.csv -o " + name + " -q").status, 0);
    const Outcome r = plot(name + " -o b.ppm --up z");
    EXPECT_TRUE(contains(r.err, "plot: colour by rgb: ")) << name << r.err;
    EXPECT_EQ(text_of(folder_ / "b.ppm"), expected) << name;
  }
  EXPECT_TRUE(contains(text_of(folder_ / "b.xyz"), "Properties=pos:R:3:radius:R:1:color:R:3\n"))
      << "as other programs write it";
  ASSERT_EQ(run("convert b.xyz -o c.xyz -q").status, 0);
  EXPECT_EQ(text_of(folder_ / "c.xyz"), text_of(folder_ / "b.xyz"));
}

TEST_F(CliPlot, MemoryOfMoleculesIsEstimated) {
  std::string pdb;
  for (int i = 0; i < 20000; ++i)
    pdb += "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00  0.00           C\n";
  write("a.pdb", pdb);
  const Outcome r = plot("a.pdb -o a.ppm --memory-limit 1M");
  EXPECT_EQ(r.status, 71) << r.err;
  EXPECT_TRUE(contains(r.err, "the atoms need about ")) << r.err;
}

TEST_F(CliPlot, EditedScenesAreNotReplaced) {
  const std::string save = "a.dump -o a.ppm -q --save-scene s.toml";
  ASSERT_EQ(plot(save).status, 0);
  ASSERT_EQ(plot(save + " --look-from +x").status, 0) << "its own file";
  const std::string edited = text_of(folder_ / "s.toml") + "# a note\n";
  write("s.toml", edited);
  std::filesystem::remove(folder_ / "a.ppm");
  const Outcome r = plot(save);
  EXPECT_EQ(r.status, 73) << r.err;
  EXPECT_TRUE(contains(r.err, "s.toml: the existing file was edited")) << r.err;
  EXPECT_EQ(text_of(folder_ / "s.toml"), edited);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.ppm")) << "refused before anything is written";
  EXPECT_EQ(plot(save + " --force").status, 0);
  EXPECT_EQ(run("render s.toml -o b.ppm -q").status, 0);

  write("g.toml", kGoodScene);
  EXPECT_EQ(run("generate final --grid 1 -o g.toml").status, 73);
  EXPECT_EQ(run("generate cloud --count 9 -o g.toml").status, 73);
  EXPECT_EQ(text_of(folder_ / "g.toml"), kGoodScene);
  EXPECT_EQ(run("generate final --grid 1 -o g.toml --force").status, 0);
  EXPECT_EQ(run("generate final --grid 2 -o g.toml").status, 0) << "its own file";
}

/// Messages are JSON, too, wherever they come from.
TEST_F(CliPlot, EveryLineOfJsonProgressIsJson) {
  for (const char* words :
       {"plot a.dump -o a.png --width 16 --height 9 --samples 1 -v --set color.display=sRGB -o a.exr",
        "plot a.dump -o none/a.png", "render good.toml -o a.exr --bits 16",
        "render good.toml -o a.exr --set camera.vfow=3", "render none.toml -o a.exr"}) {
    const Outcome r = run(std::string(words) + " --progress json");
    std::istringstream lines(r.err);
    int messages = 0;
    for (std::string line; std::getline(lines, line);) {
      const auto json = nlohmann::json::parse(line, nullptr, false);
      ASSERT_TRUE(json.is_object()) << words << ": " << line;
      EXPECT_NE(json.contains("progress"), json.contains("message")) << line;
      messages += json.contains("message");
    }
    EXPECT_GT(messages, 0) << words << r.err;
  }
}

}  // namespace
}  // namespace orrery::test
