// SPDX-License-Identifier: Apache-2.0
// Outputs are checked before any work: no input is overwritten, and names and formats are valid.
#include <nlohmann/json.hpp>

#include <map>

#include "cli/program.h"

namespace orrery::test {
namespace {

constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    "property float radius\nend_header\n0 0 -1 0.5\n";

class CliOutputs : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("points.toml", with_points("use.ply"));
    write("picture.toml", with_points("in.png"));
    write("frames.toml", with_points("p.##.png"));
    for (const char* name : {"use.ply", "in.png", "p.01.png", "p.02.png"}) write(name, kPly);
  }
  static std::string with_points(const std::string& file) {
    return kGoodScene + ("[[points]]\nfile = \"" + file + "\"\nmaterial = \"grey\"\n");
  }

  /// my.ocio, whose only view uses film.cube.
  void write_film_config() {
    write("film.cube", "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n");
    write("my.ocio",
          "ocio_profile_version: 1\nsearch_path: .\nroles: {default: lin_rec709, scene_linear: lin_rec709}\n"
          "displays:\n  d:\n    - !<View> {name: film, colorspace: film}\nactive_displays: []\nactive_views: []\n"
          "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n"
          "  - !<ColorSpace> {name: film, from_reference: !<FileTransform> {src: film.cube, interpolation: linear}}\n");
  }

  /// Contents of all files, by name.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (const std::string name = entry.path().filename().string(); name != ".out" && name != ".err")
        out[name] = entry.is_regular_file() ? text_of(entry.path()) : "";
    return out;
  }

  /// Expects exit status 2, a message that contains `text`, and unchanged files.
  void expect_refused(const std::string& arguments, const std::string& text, const std::string& before = "") {
    const auto files = contents();
    const Outcome r = run(arguments, before);
    EXPECT_EQ(r.status, 2) << before << arguments << "\n" << r.err;
    EXPECT_NE(r.err.find(text), std::string::npos) << arguments << "\n" << r.err;
    EXPECT_TRUE(contents() == files) << arguments << " changed a file";
  }
};

TEST_F(CliOutputs, RenderDoesNotOverwriteItsInputs) {
  expect_refused("render good.toml -o a.png --stats ./good.toml", "would overwrite good.toml (scene)");
  expect_refused("render points.toml -o a.png --stats use.ply", "would overwrite use.ply (points file)");
  expect_refused("render picture.toml -o in.png", "in.png (-o) would overwrite in.png (points file)");
  expect_refused("render picture.toml -o a.exr --deep in.png", "in.png");
  expect_refused("render frames.toml -o p.##.png --frames 1-2", "p.01.png (points file)");
  std::filesystem::create_hard_link(folder_ / "use.ply", folder_ / "hard.json");
  std::filesystem::create_symlink("good.toml", folder_ / "soft.json");
  expect_refused("render points.toml -o a.png --stats hard.json", "points file");
  expect_refused("render good.toml -o a.png --stats soft.json", "scene");
}

TEST_F(CliOutputs, OcioConfigIsAnInput) {
  write("my.ocio", "a file that is not a config");
  expect_refused("render good.toml -o a.png --stats my.ocio", "my.ocio (OCIO config)", "OCIO=my.ocio");
  expect_refused("develop a.exr --ocio my.png -o my.png", "my.png (OCIO config)");
  // A scene's config is read before its outputs are checked; the statistics of that failure must not overwrite it.
  write("config.toml", std::string("[color]\nconfig = \"my.ocio\"\n") + kGoodScene);
  EXPECT_EQ(run("render config.toml -o a.exr --stats my.ocio").status, 65);
  EXPECT_EQ(text_of(folder_ / "my.ocio"), "a file that is not a config");
}

/// An image that was made with another config, or with another table of the config, is not up to date.
TEST_F(CliOutputs, ContentsOfTheOcioConfigCount) {
  const auto write_config = [&](const char* interpolation) {
    write(
        "my.ocio",
        std::string("ocio_profile_version: 1\nsearch_path: .\nroles: {default: lin_rec709, scene_linear: lin_rec709}\n"
                    "displays:\n  d:\n    - !<View> {name: v, colorspace: out}\nactive_displays: []\nactive_views: []\n"
                    "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n"
                    "  - !<ColorSpace> {name: out, from_reference: !<FileTransform> {src: out.cube, interpolation: ") +
            interpolation + "}}\n");
  };
  const auto write_table = [&](const std::string& last) {
    write("out.cube", "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n" + last + "\n");
  };
  const auto is_skipped = [&] {
    const Outcome r = run("render good.toml -o a.png --skip-existing", "OCIO=my.ocio");
    EXPECT_EQ(r.status, 0) << r.err;
    return r.err.find("skipped") != std::string::npos;
  };
  write_config("linear");
  write_table("1 1 1");
  EXPECT_FALSE(is_skipped());
  EXPECT_TRUE(is_skipped());
  write_config("tetrahedral");
  EXPECT_FALSE(is_skipped()) << "another config";
  EXPECT_TRUE(is_skipped());
  write_table("1 1 0.5");
  EXPECT_FALSE(is_skipped()) << "another table";
  EXPECT_TRUE(is_skipped());
}

TEST_F(CliOutputs, PlotDoesNotOverwriteItsInputs) {
  write_film_config();
  for (const char* name : {"pp.0001.ply", "pp.0002.ply", "all.ply"}) write(name, kPly);
  const std::string size = " --width 16 --height 9 --samples 1 -q ";
  const std::string frames = "plot 'pp.%04d.ply' -o q.####.png --frames 1-2" + size;
  const std::string one = "plot all.ply -o q.png" + size;
  for (const char* option : {"--save-scene", "--legend", "--stats"}) {
    const std::string files = option == std::string("--stats") ? " pp.%04d.ply" : " pp.0002.ply";
    expect_refused(frames + option + files, "pp.000");
    expect_refused(one + option + " all.ply", "all.ply");
    expect_refused(one + "--set color.config=my.ocio " + option + " my.ocio", "my.ocio (OCIO config)");
    expect_refused(one + option + " my.ocio", "my.ocio (OCIO config)", "OCIO=my.ocio");
  }
}

TEST_F(CliOutputs, OutputsOfPlotMustBeDistinctFiles) {
  write("a.csv", "x,y,z,v\n0,0,0,1\n1,0,0,2\n");
  const std::string plot = "plot a.csv --color-by v --radius 0.3 --width 16 --height 9 --samples 1 -q ";
  for (const char* option : {"--stats", "--save-scene"})
    expect_refused(plot + "-o q.png --legend l.svg " + option + " ./l.svg", "are the same file");
  expect_refused(plot + "-o q.png --save-scene s.toml --stats ./s.toml", "are the same file");
  expect_refused(plot + "-o q.####.png --frames 1 --legend q.0001.png", "are the same file");
  expect_refused(plot + "-o q.exr --legend q.checkpoint.exr", "are the same file");
  EXPECT_EQ(run(plot + "-o q.####.png --frames 1 --legend l.svg --stats t --save-scene s.toml").status, 0);
  for (const char* name : {"q.0001.png", "l.svg", "t", "s.toml"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
}

TEST_F(CliOutputs, OutputsMustBeDistinctFiles) {
  expect_refused("render good.toml -o a.png -o ./a.png", "are the same file");
  expect_refused("render good.toml -o a.png --stats s.png --preview ./s.png", "are the same file");
  expect_refused("render good.toml -o a.exr -o a.checkpoint.exr", "a.checkpoint.exr (checkpoint)");
  expect_refused("render good.toml ./good.toml -o {scene}.png", "./good.toml is given twice");
  std::filesystem::create_directory(folder_ / "sub");
  std::filesystem::create_symlink("sub/new.exr", folder_ / "link.exr");
  expect_refused("render good.toml -o link.exr -o sub/new.exr", "are the same file");
  write("sub/good.toml", kGoodScene);
  expect_refused("render good.toml sub/good.toml -o {scene}.png", "good.png (-o of good.toml)");
}

TEST_F(CliOutputs, BatchChecksAllScenesFirst) {
  // The first scene's output is an input of the second.
  write("in.toml", kGoodScene);
  expect_refused("render in.toml picture.toml -o {scene}.png", "in.png");
}

TEST_F(CliOutputs, FailedRenderKeepsThePointsFile) {
  // The scene is invalid, but it refers to the file that --stats names.
  write("wrong.toml", with_points("use.ply") + "[camera]\nvfov = 1000\n");
  const auto files = contents();
  EXPECT_EQ(run("render wrong.toml -o a.png --stats use.ply").status, 65);
  write("broken.toml", with_points("use.ply") + "[camera\n");
  EXPECT_EQ(run("render broken.toml -o a.png --stats use.ply").status, 65);
  EXPECT_EQ(text_of(folder_ / "use.ply"), kPly);
  EXPECT_EQ(run("render wrong.toml -o a.png --stats s.json").status, 65);
  EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "s.json"))["exit_status"], 65);
}

TEST_F(CliOutputs, OtherCommandsDoNotOverwriteTheirInputs) {
  std::filesystem::create_symlink("good.toml", folder_ / "scene.html");
  std::filesystem::create_symlink("use.ply", folder_ / "points.html");
  expect_refused("study good.toml -o scene.html", "(scene)");
  expect_refused("study points.toml -o points.html", "points file");
  expect_refused("submit points.toml -o a.png --stats use.ply --slurm", "points file");
  expect_refused("submit frames.toml -o p.##.png --frames 1-2 --slurm", "points file");
  ASSERT_EQ(run("render good.toml -o a.exr -o b.exr -q").status, 0);
  expect_refused("compare a.exr b.exr --heat b.exr", "would overwrite");
  expect_refused("compare a.exr b.exr --flip b.exr", "would overwrite");
  expect_refused("compare a.exr b.exr --heat c.png --flip ./c.png", "are the same file");
  std::filesystem::create_symlink("a.exr", folder_ / "soft.png");
  expect_refused("develop a.exr -o soft.png", "would overwrite");
  ASSERT_EQ(run("render good.toml -o shard.exr --sample-range 0:2 -q").status, 0);
  expect_refused("merge shard.exr -o shard.exr --allow-missing", "shard.exr (shard)");
  expect_refused("merge shard.exr -o m.exr --allow-missing --stats good.toml", "scene");
  expect_refused("merge shard.exr ./shard.exr -o m.exr --allow-missing", "given twice");
}

TEST_F(CliOutputs, SizeBeyondTheFormatIsRejectedBeforeRendering) {
  // A render of that many samples would take hours.
  expect_refused("render good.toml -o a.jpg --width 65501 --samples 1000000000", "65500");
  expect_refused("render good.toml -o a.exr -o a.jpg --height 65536 --samples 1000000000", "65500");
  EXPECT_EQ(run("render good.toml -o a.jpg --width 65500 --height 1 --samples 1 -q").status, 0);
  for (const char* name : {"a.png", "a.hdr", "a.ppm"})
    expect_refused("render good.toml --width 65536 --samples 1000000000 -o " + std::string(name), "65535");
  EXPECT_EQ(run("render good.toml -o a.png -o a.hdr -o a.ppm --width 65535 --height 1 --samples 1 -q").status, 0);
  EXPECT_EQ(run("render good.toml -o a.exr -o a.tif --width 65536 --height 1 --samples 1 -q").status, 0);
  expect_refused("develop a.exr -o b.jpg", "65500");
  expect_refused("compare a.exr a.exr --heat b.jpg", "65500");
}

TEST_F(CliOutputs, LongestFileNamesWorkAndLongerOnesExit73) {
  const std::string stem(251, 'n');
  EXPECT_EQ(run("render good.toml -q -o " + stem + ".exr").status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / (stem + ".exr")));
  const Outcome r = run("render good.toml --samples 1000000000 -o " + stem + "n.exr");
  EXPECT_EQ(r.status, 73) << r.err;
  EXPECT_NE(r.err.find("File name too long"), std::string::npos) << r.err;
  EXPECT_EQ(run("render good.toml --samples 1000000000 -o a.png --stats " + stem + ".json").status, 73);
  EXPECT_EQ(run("study good.toml -o " + stem + ".html").status, 73);
  EXPECT_EQ(run("generate cloud -o " + std::string(252, 'n')).status, 73) << "its points file";
}

TEST_F(CliOutputs, DiskLimitIsEnforced) {
  const Outcome r = run("render good.toml -o a.exr --samples 1000000000 --disk-limit 1K");
  EXPECT_EQ(r.status, 73) << r.err;
  EXPECT_NE(r.err.find("--disk-limit allows only 1.0 KiB; raise the limit"), std::string::npos) << r.err;
  EXPECT_EQ(run("render good.toml -o a.exr -q --disk-limit 1G").status, 0);
}

TEST_F(CliOutputs, PngAndTiffKeepTheAlphaOfATransparentBackground) {
  const std::string empty = "render good.toml -q --type float --set background.alpha=0 ";
  ASSERT_EQ(run(empty + "-o a.exr -o a.png -o a.tif -o a.jpg").status, 0);
  ASSERT_EQ(run("develop a.exr -o d.png -o d.tif -o d.jpg").status, 0);
  // Returns the number of channels; expects equal values.
  const auto agreeing = [&](const std::string& a, const std::string& b) {
    const auto found = nlohmann::json::parse(run("compare " + a + " " + b + " --json").out);
    EXPECT_EQ(found["differing"], 0) << a;
    return found["values"].get<int>() / (32 * 18);
  };
  EXPECT_EQ(agreeing("a.png", "d.png"), 4);
  EXPECT_EQ(agreeing("a.tif", "d.tif"), 4);
  EXPECT_EQ(agreeing("a.jpg", "d.jpg"), 3);
  // A frame without transparent pixels has as many channels as the other frames of its sequence.
  ASSERT_EQ(run(empty + "-o full.exr -o full.png --set camera.vfov=5").status, 0);
  ASSERT_EQ(run("develop full.exr -o full.tif").status, 0);
  EXPECT_EQ(agreeing("full.png", "full.tif"), 4);
}

}  // namespace
}  // namespace orrery::test
