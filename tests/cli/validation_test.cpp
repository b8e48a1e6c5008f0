// SPDX-License-Identifier: Apache-2.0
// Every command reports the same errors for an invalid scene.
#include <sys/stat.h>

#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include "cli/program.h"
#include "support/exr_file.h"
#include "support/mentions.h"

namespace orrery::test {
namespace {

struct Broken {
  const char* name;     ///< of the scene file
  const char* text;     ///< appended to the good scene
  const char* options;  ///< for every command
  int status;
  const char* told;  ///< part of the message; the file name precedes a leading colon
};

const Broken kBroken[] = {
    {"AColorSpace", "[color]\nspace = \"foo\"\n", "", 65, ":15:9: error: color.space: the OCIO config (built-in)"},
    {"ADisplayReferredSpace", "[color]\nspace = \"srgb_texture\"\n", "", 65, "is not scene-linear"},
    {"AWorkingSpace", "[color]\nworking = \"foo\"\n", "", 65, ":15:11: error: color.working: "},
    {"ADisplay", "[color]\ndisplay = \"sGRB\"\n", "", 65, ":15:11: error: color.display: "},
    {"AView", "[color]\nview = \"Filmik\"\n", "", 65, ":15:8: error: color.view: "},
    {"AViewOfAnotherDisplay", "[color]\ndisplay = \"Gamma 2.0 Rec.709\"\nview = \"ACES 1.0 SDR Video\"\n", "", 65,
     ":16:8: error: color.view: "},
    {"ALook", "[color]\nlook = \"foo\"\n", "", 65, ":15:8: error: color.look: "},
    {"AllNames", "[color]\nspace = \"a\"\nworking = \"b\"\ndisplay = \"c\"\nlook = \"d\"\n", "", 65, ": 4 errors"},
    {"AMissingConfig", "[color]\nconfig = \"none.ocio\"\n", "", 66,
     ":15:10: error: color.config: cannot open none.ocio: No such file"},
    {"AnInvalidConfig", "[color]\nconfig = \"good.toml\"\n", "", 65, ":15:10: error: color.config: "},
    {"ADeviceAsConfig", "[color]\nconfig = \"/dev/zero\"\n", "", 66, "it is not a regular file"},
    {"AnOverriddenView", "", "--set color.view=Filmik", 65, "--set: error: color.view: "},
    {"ALayer", "[output]\nlayers = [\"Z\", \"Y\"]\n", "", 65, ":15:16: error: output.layers[1] is \"Y\""},
    {"ALayerWithoutLightPaths", "[output]\nlayers = [\"Z\", \"diffuse\"]\n", "--set render.shading=normal", 65,
     ":15:16: error: output.layers[1]: diffuse requires render.shading"},
    {"ALightGroupNamedLikeALayer",
     "[material.lamp]\ntype = \"emitter\"\nradiance = [1, 1, 1]\nlight_group = \"diffuse_direct\"\n", "", 65,
     ":17:15: error: material.lamp.light_group: \"diffuse_direct\" is the name of another layer"},
    {"ALightGroupThatIsNotAWord",
     "[material.lamp]\ntype = \"emitter\"\nradiance = [1, 1, 1]\nlight_group = \"key.left\"\n", "", 65,
     ":17:15: error: material.lamp.light_group: \"key.left\" must consist of letters, digits and underscores"},
    {"ALightGroupWithoutLightPaths", "[output]\nlayers = [\"light_groups\"]\n", "--set render.shading=normal", 65,
     ":15:11: error: output.layers[0]: light_groups requires render.shading"},
    {"ALayerOption", "", "--layers Z,Y", 65, "--layers: error: output.layers[1] is \"Y\""},
    {"ASampleCount", "", "--samples 0", 65, "--samples: error: render.samples is 0; must be in"},
    {"ACameraWithoutDirection", "[camera]\nlook_at = [0, 0, 0]\n", "", 65, "error: camera.look_at: "},
    {"ADepthCueWithoutData", "", "--set camera.depth_cue=0.5", 65, "camera.depth_cue: needs `depth_cue_range`"},
    {"AnEmptyDepthCueRange", "", "--set camera.depth_cue_range=[2,2]", 65, "error: camera.depth_cue_range"},
    {"ADepthCueAboveOne", "", "--set camera.depth_cue=1.5", 65, "must be in 0..1"},
    {"AGradientWithoutDirection", "", "--set background.up=[0,0,0]", 65, "background.up"},
    {"TwoPages", "", "--set sphere[0].page=true --set sphere[1].page=true", 65, "sphere[1].page"},
    {"AShutter", "[camera]\nshutter_open = 1\n", "", 65, "error: camera.shutter_close: "},
    {"CropAndOverscan", "", "--set image.crop=[0,0,2,2] --set image.overscan=1", 65, "--set: error: image.overscan: "},
    {"CropAndAnnotation", "", "--set image.crop=[0,0,2,2] --set annotation.title=a", 65, "error: annotation"},
    {"ScaleBarInPerspective", "", "--set annotation.scale_bar=1", 65, "requires camera.projection"},
    {"ATarget", "[[key]]\ntarget = \"camera.speed\"\nframes = [1]\nvalues = [1]\n", "", 65, ":15:10: error: key[0]"},
    {"AnAmbiguousTarget",
     "[[sphere]]\nname = \"b\"\ncenter = [0, 0, -3]\nradius = 1\nmaterial = \"grey\"\n[[sphere]]\nname = \"b\"\n"
     "center = [0, 1, -3]\nradius = 1\nmaterial = \"grey\"\n"
     "[[key]]\ntarget = \"sphere.b.radius\"\nframes = [1]\nvalues = [1]\n",
     "", 65,
     "key[0].target: \"sphere.b.radius\" matches 2 spheres; use an index, such as sphere[1].radius or "
     "sphere[2].radius"},
    {"ARodOfGlass",
     "[material.glass]\ntype = \"dielectric\"\n"
     "[[rod]]\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nradius = 1\nmaterial = [\"grey\", \"glass\"]\n",
     "", 65, ":20:12: error: rod[0].material: \"glass\" is a dielectric, but rods transmit no light"},
    {"APlasticOfAnIndexBelowOne", "[material.m]\ntype = \"plastic\"\nalbedo = [1, 1, 1]\nior = 0.9\n", "", 65,
     ":17:7: error: material.m.ior is 0.9; must be in 1..1e+06"},
    {"AnOpacityAboveOne", "[material.ghost]\ntype = \"metal\"\nalbedo = [1, 1, 1]\nopacity = 1.5\n", "", 65,
     ":17:11: error: material.ghost.opacity is 1.5; must be in 0..1"},
    {"AnOpacityOfGlass", "[material.glass]\ntype = \"dielectric\"\nopacity = 0.5\n", "", 65,
     ":16:1: error: unknown key `opacity` in material.glass of type dielectric"},
    {"AnOpacityOfPointsOfGlass",
     "[material.glass]\ntype = \"dielectric\"\n"
     "[[points]]\nfile = \"atoms.csv\"\nmaterial = \"glass\"\nradius = 1\nopacity = 0.5\n",
     "", 65, "has opacity 0.5 and the dielectric \"glass\", but glass is transparent already"},
    {"AnOpacityWithoutCondition",
     "[[points]]\nfile = \"atoms.csv\"\nmaterial = \"grey\"\nradius = 1\nopacity = { where = [\"x > 0\"] }\n", "", 65,
     "points[0].opacity.where[0]: `x > 0` is not an opacity; write a number in 0..1"},
    {"AnOpacityThatIsNoList",
     "[[points]]\nfile = \"atoms.csv\"\nmaterial = \"grey\"\nradius = 1\nopacity = { where = \"x > 0: 1\" }\n", "", 65,
     "points[0].opacity.where must be a list of strings, not \""},
    {"ARodThatShrinks",
     "[camera]\nshutter_close = 1\n[[rod]]\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nradius = 1\nmaterial = \"grey\"\n"
     "[[key]]\ntarget = \"rod[0].radius\"\nframes = [1, 2]\nvalues = [1, 0]\n",
     "", 65, "values is 0; must be in"},
    {"AValueOutsideItsRangeBetweenKeys",
     "[[key]]\ntarget = \"sphere[0].radius\"\ninterpolation = \"cubic\"\nframes = [-9, 0, 2, 3]\n"
     "values = [1e18, 1e18, 1e18, 1]\n",
     "", 65, "at frame 1; must be in"},
    {"MissingPoints", "[[points]]\nfile = \"none.ply\"\nmaterial = \"grey\"\n", "", 66,
     ":15:8: error: points[0].file: cannot open none.ply: No such file"},
    {"ADeviceAsPoints", "[[points]]\nfile = \"/dev/zero\"\nmaterial = \"grey\"\n", "", 66,
     "cannot open /dev/zero: it is not a regular file"},
    {"APipeAsPoints", "[[points]]\nfile = \"pipe\"\nmaterial = \"grey\"\n", "", 66,
     "cannot open pipe: it is not a regular file"},
    {"AFolderAsPoints", "[[points]]\nfile = \".\"\nmaterial = \"grey\"\n", "", 66, "cannot open .: it is a directory"},
    {"PointsOfAnUnknownVersion", "[[points]]\nfile = \"two.ply\"\nmaterial = \"grey\"\n", "", 65,
     "two.ply:2: error: unsupported format version `2.0`"},
    {"AnIncompletePointsLine", "[[points]]\nfile = \"lines.ply\"\nmaterial = \"grey\"\n", "", 65,
     "lines.ply:9: error: the row has 3 values, not 4"},
    {"MorePointsThanDeclared", "[[points]]\nfile = \"more.ply\"\nmaterial = \"grey\"\n", "", 65,
     "more.ply:3: error: the header declares 2 rows of `vertex`, but there are 3"},
    {"BondsOfGlass",
     "[material.glass]\ntype = \"dielectric\"\n"
     "[[points]]\nfile = \"good.ply\"\nmaterial = \"glass\"\nbonds = { length = 3 }\n",
     "", 65, ":19:9: error: points[0].bonds: bonds are opaque, but have the material of their spheres, \"glass\""},
    {"BondsOfGlassByCondition",
     "[material.glass]\ntype = \"dielectric\"\n"
     "[[points]]\nfile = \"good.ply\"\nmaterial = \"grey\"\nbonds.length = 3\nmaterial_where = [\"x > -9: glass\"]\n",
     "", 65, "points[0].bonds: bonds are opaque, but have the material of their spheres, \"glass\""},
    {"ArrowsOfGlass",
     "[material.glass]\ntype = \"dielectric\"\n"
     "[[points]]\nfile = \"good.ply\"\nmaterial = \"glass\"\nvectors.columns = [\"x\", \"y\", \"z\"]\n",
     "", 65, "points[0].vectors: arrows are opaque, but have the material of their spheres, \"glass\""},
    {"BondsOfAnotherGlass",
     "[material.glass]\ntype = \"dielectric\"\n"
     "[[points]]\nfile = \"good.ply\"\nmaterial = \"grey\"\nbonds = { length = 3, material = \"glass\" }\n",
     "", 65, ":19:34: error: points[0].bonds.material: \"glass\" is a dielectric, but rods transmit no light"},
    {"BondsOfAnUndefinedMaterial",
     "[[points]]\nfile = \"good.ply\"\nmaterial = \"grey\"\nbonds = { length = 3, material = \"gray\" }\n", "", 65,
     "points[0].bonds.material is \"gray\", which is not defined; did you mean `grey`"},
    {"BondsThatTheFileLacks", "[[points]]\nfile = \"good.ply\"\nmaterial = \"grey\"\nbonds = { from = \"file\" }\n", "",
     65, ":17:18: error: points[0].bonds.from: the file has no bonds; set `from = \"distance\"`"},
    {"BondsWithoutElements", "[[points]]\nfile = \"good.ply\"\nmaterial = \"grey\"\nbonds = true\n", "", 65,
     ":17:9: error: points[0].bonds: the file has no bonds and no column of chemical elements; set `bonds.length`"},
    {"BondsOfTwoRules", "[[points]]\nfile = \"good.ply\"\nmaterial = \"grey\"\nbonds = { length = 3, factor = 1 }\n",
     "", 65, "error: points[0].bonds: only one of `factor` and `length` can be set"},
    {"AWordAsBonds", "[[points]]\nfile = \"good.ply\"\nmaterial = \"grey\"\nbonds = \"file\"\n", "", 65,
     ":17:9: error: points[0].bonds must be true or false, not \""},
    {"MissingPointsAndAnUnknownKey", "[image.more]\n[[points]]\nfile = \"none.ply\"\nmaterial = \"grey\"\n", "", 65,
     ": 2 errors"},
    {"AnImageBackgroundWithoutAFile", "[background]\ntype = \"image\"\n", "", 65,
     "error: background.file: type \"image\" needs an EXR or HDR file"},
    {"AMissingTexture", "[material.m]\ntype = \"lambertian\"\nalbedo = { texture = \"image\", file = \"none.png\" }\n",
     "", 66, ":16:38: error: material.m.albedo.file: cannot open none.png: No such file"},
    {"ATruncatedTexture", "[material.m]\ntype = \"lambertian\"\nalbedo = { texture = \"image\", file = \"cut.exr\" }\n",
     "", 65, ":16:38: error: material.m.albedo.file: cannot read image cut.exr: "},
    {"ATextureOfAnUnknownType", "[material.m]\ntype = \"lambertian\"\nalbedo = { texture = \"wood\" }\n", "", 65,
     ":16:22: error: material.m.albedo.texture is \"wood\"; must be one of checker, noise"},
    {"AMissingBackground", "[background]\ntype = \"image\"\nfile = \"none.exr\"\n", "", 66,
     ":16:8: error: background.file: cannot open none.exr: No such file"},
    {"APipeAsBackground", "[background]\ntype = \"image\"\nfile = \"pipe\"\n", "", 66,
     "cannot open pipe: it is not a regular file"},
    {"AFolderAsBackground", "[background]\ntype = \"image\"\nfile = \".\"\n", "", 66,
     "cannot open .: it is a directory"},
    {"ADisplayImageAsBackground", "[background]\ntype = \"image\"\nfile = \"good.toml\"\n", "", 65,
     "an environment map must be an exr or hdr file"},
    {"ATruncatedBackground", "[background]\ntype = \"image\"\nfile = \"cut.exr\"\n", "", 65,
     ":16:8: error: background.file: cannot read image cut.exr: "},
    {"ABackgroundOfNoSize", "[background]\ntype = \"image\"\nfile = \"empty.hdr\"\n", "", 65,
     ":16:8: error: background.file: cannot read image empty.hdr: "},
    {"ABackgroundSpace", "[background]\ntype = \"image\"\nfile = \"sky.exr\"\ncolor_space = \"foo\"\n", "", 65,
     ":17:15: error: background.color_space: "},
    {"AVisibility", "[background]\nvisible = 1\n", "", 65, "background.visible must be true or false, not an integer"},
    {"InvalidToml", "[[[", "", 65, ":14:3: error: "},
};

class CliValidation : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    const std::string rows =
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property float radius\nend_header\n";
    write("atoms.csv", "x,y,z\n0,0,0\n1,0,0\n");
    write("two.ply", "ply\nformat ascii 2.0\n" + rows + "0 0 -3 1\n0 2 -3 1\n");
    write("good.ply", "ply\nformat ascii 1.0\n" + rows + "0 0 -3 1\n0 2 -3 1\n");
    write("lines.ply", "ply\nformat ascii 1.0\n" + rows + "0 0 -3\n1\n0 2 -3 1\n");
    const support::ExrFile sky = support::ExrFile::constant(8, 4, {1, 1, 1});
    write("sky.exr", sky.bytes());
    write("cut.exr", sky.bytes().substr(0, sky.bytes().size() - 50));
    write("empty.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n");
    write("more.ply", "ply\nformat ascii 1.0\n" + rows + "0 0 -3 1\n0 2 -3 1\n0 4 -3 1\n");
  }
  void write_bad(const std::string& text) { write("bad.toml", kGoodScene + text); }

  /// Expects check and render to fail with the same messages, and no image.
  void expect_same(const std::string& scene, const std::string& options, int status, const std::string& told) {
    const Outcome check = run("check " + scene + " " + options);
    EXPECT_EQ(check.status, status) << check.err;
    EXPECT_TRUE(contains(check.err, told)) << check.err;
    const Outcome render = run("render " + scene + " -q -o a.exr " + options);
    EXPECT_EQ(render.status, status);
    EXPECT_EQ(render.err, check.err);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
  }
};

/// Runs each command once for all scenes with the same options and status: starting a process costs more than reading a
/// scene.
TEST_F(CliValidation, CheckAndRenderReportTheSameErrors) {
  std::map<std::pair<std::string, int>, std::vector<const Broken*>> groups;
  for (const Broken& broken : kBroken) {
    write(std::string(broken.name) + ".toml", std::string(kGoodScene) + broken.text);
    groups[{broken.options, broken.status}].push_back(&broken);
  }
  for (const auto& [group, members] : groups) {
    const auto& [options, status] = group;
    std::string scenes;
    for (const Broken* broken : members) scenes += std::string(broken->name) + ".toml ";
    const Outcome check = run("check " + scenes + options);
    EXPECT_EQ(check.status, status) << check.err;
    EXPECT_EQ(check.out, "") << "none of the scenes is valid";
    for (const Broken* broken : members) {
      const std::string file = std::string(broken->name) + ".toml", told = broken->told;
      EXPECT_TRUE(contains(check.err, told[0] == ':' ? file + told : told)) << told << "\n" << check.err;
      EXPECT_TRUE(contains(check.err, "orrery: " + file + ": "));
    }
    const Outcome render = run("render " + scenes + "-q -o out.{scene}.exr " + options);
    EXPECT_EQ(render.status, status);
    EXPECT_EQ(render.err.substr(0, check.err.size()), check.err);
    const std::string count = std::to_string(members.size());
    EXPECT_EQ(contains(render.err, "0 of " + count + " rendered, 0 skipped, " + count + " failed\n"),
              members.size() > 1);
  }
}

TEST_F(CliValidation, AllCommandsReportTheSameSceneErrors) {
  for (const char* text : {"[color]\nview = \"Filmik\"\n", "[[points]]\nfile = \"none.ply\"\nmaterial = \"grey\"\n"}) {
    write_bad(text);
    const Outcome check = run("check bad.toml");
    EXPECT_NE(check.status, 0);
    for (const char* command : {"render bad.toml -q -o a.png", "info bad.toml", "bench bad.toml -q",
                                "study bad.toml -q", "submit bad.toml -o a.png --parallel 1"}) {
      const Outcome r = run(command);
      EXPECT_EQ(r.status, check.status) << command;
      EXPECT_EQ(r.err, check.err) << command;
    }
  }
}

TEST_F(CliValidation, SceneMustBeARegularFile) {
  expect_same("pipe", "", 66, "orrery: cannot open pipe: it is not a regular file\n");
  expect_same("/dev/zero", "", 66, "orrery: cannot open /dev/zero: it is not a regular file\n");
  expect_same(".", "", 66, "orrery: cannot open .: it is a directory\n");
}

TEST_F(CliValidation, InvalidDisplayOptionsAreNamedUsageErrors) {
  ASSERT_EQ(run("render good.toml -q -o a.exr").status, 0);
  const std::string develop = "develop a.exr -o a.png ";
  EXPECT_EQ(run(develop + "--view Filmik").err.rfind("orrery: the OCIO config (built-in) has no view", 0), 0u);
  EXPECT_EQ(run(develop + "--view Filmik").status, 2);
  EXPECT_EQ(run(develop + "--display sGRB").status, 2);
  const Outcome missing = run(develop + "--ocio none.ocio");
  EXPECT_EQ(missing.status, 66);
  EXPECT_TRUE(mentions(missing.err, {"orrery: cannot open none.ocio"}));
}

TEST_F(CliValidation, OptionsThatAreGuessedNameTheRightOnes) {
  const Outcome view = run("render good.toml -o a.png --view Raw");
  EXPECT_EQ(view.status, 2);
  EXPECT_EQ(view.err, "orrery: unknown option --view; use --set color.view=NAME\nTry orrery render --help.\n");
  for (const char* option :
       {"--ocio=a", "--display=a", "--look=a", "--exposure=1", "--seed=1", "--max-depth=1", "--accelerator=list",
        "--isa=avx2", "--log=a", "--fail-fast", "--size=9", "--res=9", "--spp=4", "--bg=white"}) {
    const Outcome r = run(std::string("render good.toml -o a.png ") + option);
    EXPECT_EQ(r.status, 2) << option;
    EXPECT_TRUE(contains(r.err, "; use ")) << r.err;
  }
}

TEST_F(CliValidation, AnOptionIsNoValueOfAnother) {
  Outcome r = run("plot none.csv -o a.png --scale-bar --progress none");
  EXPECT_EQ(r.status, 2);
  EXPECT_EQ(r.err, "orrery: --scale-bar needs a value, LENGTH; --progress follows\nTry orrery plot --help.\n");
  r = run("plot none.csv -o a.png --title --color-bar");
  EXPECT_EQ(r.status, 2) << "without another error";
  EXPECT_EQ(r.err, "orrery: --title needs a value, TEXT; --color-bar follows\n");
  EXPECT_EQ(run("plot none.csv -o a.png --title=--color-bar").status, 66) << "with =, a value may begin with dashes";
  EXPECT_TRUE(contains(run("develop a.exr -o --bits 8").err, "-o needs a value, FILE; --bits follows"));
}

TEST_F(CliValidation, JsonMessagesIncludeErrorsOfTheCommandLine) {
  for (const char* words :
       {"plot a.csv --progress json --size 3", "plot --progress=json", "render --progress json --time= a",
        "render good.toml -o a.png --progress json --samples 1 --samples 2"}) {
    const Outcome r = run(words);
    EXPECT_EQ(r.status, 2) << words;
    EXPECT_FALSE(nlohmann::json::parse(r.err)["message"].empty()) << r.err;
  }
}

TEST_F(CliValidation, OcioVariableIsIgnoredForExrOutput) {
  const std::string before = "OCIO=none.ocio";
  const Outcome check = run("check good.toml", before);
  EXPECT_EQ(check.status, 66);
  EXPECT_TRUE(mentions(check.err, {"orrery: $OCIO: cannot open none.ocio"}));
  const Outcome shown = run("render good.toml -q -o a.png", before);
  EXPECT_EQ(shown.status, 66);
  EXPECT_EQ(shown.err, check.err);
  EXPECT_EQ(run("render good.toml -q -o a.exr", before).status, 0) << "EXR output needs no display transform";
}

TEST_F(CliValidation, CheckValidatesEveryFrame) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float radius\nend_header\n";
  for (const char* frame : {"1", "2", "4"}) write("c." + std::string(frame) + ".ply", header + "0 0 -3 1\n");
  write("c.5.ply", header + "0 0 -3\n");
  write("c.toml", std::string(kGoodScene) + "[[points]]\nfile = \"c.%d.ply\"\nmaterial = \"grey\"\n");
  EXPECT_EQ(run("check c.toml").out, "c.toml: ok\n");
  EXPECT_EQ(run("check c.toml --frames 1-2").out, "c.toml: ok, 2 frames\n");
  const Outcome r = run("check c.toml --frames 1-7");
  EXPECT_EQ(r.status, 66) << "the status of the first failure, as for a render";
  EXPECT_TRUE(contains(r.err, "cannot open c.3.ply")) << r.err;
  EXPECT_TRUE(contains(r.err, "c.5.ply:9: error: ")) << r.err;
  EXPECT_TRUE(contains(r.err, "orrery: c.toml: 4 of 7 frames have errors: 3,5-7\n")) << r.err;
  EXPECT_EQ(run("render c.toml -q -o a.##.png --frames 1-7").status, 66);
}

TEST_F(CliValidation, ErrorOfEveryFrameIsReportedOnce) {
  write_bad("[camera]\nvfov = 200\n");
  const Outcome r = run("check bad.toml --frames 1-20");
  EXPECT_EQ(r.status, 65);
  EXPECT_EQ(r.err.find("camera.vfov is 200"), r.err.rfind("camera.vfov is 200")) << r.err;
  EXPECT_TRUE(contains(r.err, "20 of 20 frames have errors: 1-20")) << r.err;
}

TEST_F(CliValidation, InfoAndBenchTakeOneFrame) {
  write("shot.toml",
        std::string(kGoodScene) + "[[key]]\ntarget = \"camera.vfov\"\nframes = [1, 11]\nvalues = [20, 40]\n");
  EXPECT_TRUE(contains(run("info shot.toml --settings").out, "camera.vfov                20 "));
  EXPECT_TRUE(contains(run("info shot.toml --settings --frame 6").out, "camera.vfov                30 "));
  EXPECT_TRUE(contains(run("info shot.toml --settings --frames 6").out, "camera.vfov                30 "));
  EXPECT_TRUE(contains(run("info shot.toml --frame 6").out, "\nframe       6\n"));
  const Outcome many = run("info shot.toml --frames 1-6");
  EXPECT_EQ(many.status, 2);
  EXPECT_TRUE(mentions(many.err, {"--frame 1-6", "6 frames", "orrery check"}));
  const std::string bench = "bench shot.toml -q --rounds 1 --seconds 0.001 --frame ";
  EXPECT_NE(run(bench + "1").out.substr(0, 40), run(bench + "6").out.substr(0, 40)) << "the scene hash differs";
}

TEST_F(CliValidation, LongErrorListsAreTruncated) {
  std::string text;
  for (int i = 0; i < 2000; ++i) text += "[[sphere]]\nradius = \"big\"\nmaterial = \"gray\"\n";
  write_bad(text);
  const Outcome r = run("check bad.toml");
  EXPECT_EQ(r.status, 65);
  EXPECT_TRUE(contains(r.err, "bad.toml: error: and 5900 more (6000 in all)\norrery: bad.toml: 6000 errors\n"));
  EXPECT_LT(r.err.size(), 30000u);
}

TEST_F(CliValidation, ReportMustBeAnHtmlFile) {
  for (const char* name : {"x.pdf", "x", "x.json"}) {
    const Outcome r = run(std::string("study good.toml -o ") + name);
    EXPECT_EQ(r.status, 2);
    EXPECT_EQ(r.err, "orrery: " + std::string(name) +
                         ": the report is an HTML file; name it .html, or print numbers with --json\n");
  }
}

TEST_F(CliValidation, AllLayersMatchInfo) {
  const Outcome info = run("info good.toml --layers all");
  EXPECT_TRUE(contains(info.out, "layers      Z, depth, N, ")) << info.out;
  ASSERT_EQ(run("render good.toml -q -o a.exr --layers all").status, 0);
  const std::string header = text_of(folder_ / "a.exr").substr(0, 20000);
  for (const char* channel : {"transmission_indirect.B", "CryptoObject02.A", "denoise.normal.X", "material_id.X"})
    EXPECT_TRUE(contains(header, channel)) << channel;
  EXPECT_FALSE(contains(header, "CryptoGroup")) << "no sphere has a group";
  EXPECT_EQ(run("render good.toml -q -o b.exr --set 'output.layers=[Z,N]'").status, 0);
  EXPECT_EQ(run("render good.toml -q -o c.exr --layers all --set render.shading=flat").status, 0);
}

TEST_F(CliValidation, LightsHaveLayers) {
  EXPECT_FALSE(contains(run("info good.toml").out, "emission"));
  write("lit.toml", std::string(kGoodScene) +
                        "[material.lamp]\ntype = \"emitter\"\nradiance = [1, 1, 1]\nlight_group = \"key\"\n"
                        "[[sphere]]\ncenter = [0, 3, -3]\nradius = 1\nmaterial = \"lamp\"\n");
  const Outcome info = run("info lit.toml --layers all");
  EXPECT_TRUE(contains(info.out, "background, emission, light_groups, variance")) << info.out << info.err;
  for (const char* parts : {"", " --multipart"}) {
    ASSERT_EQ(run(std::string("render lit.toml -q -o a.exr --layers all") + parts).status, 0);
    const std::string header = text_of(folder_ / "a.exr").substr(0, 200000);
    for (const char* channel : {"emission.B", "key.R", "key_diffuse_direct.G", "key_transmission_indirect.B",
                                "key_emission.R", "default.R", "default_background.B", "default_specular_direct.R"})
      EXPECT_TRUE(contains(header, channel)) << channel;
    EXPECT_FALSE(contains(header, "key_background")) << "only the background has this lobe";
    EXPECT_FALSE(contains(header, "default_emission")) << "all emitters are in another group";
  }
}

constexpr const char* kImageBackground = "[background]\ntype = \"image\"\nfile = ";

TEST_F(CliValidation, FaultsOfABackgroundImageAreWarnings) {
  support::ExrFile odd = support::ExrFile::constant(7, 4, {1, 1, 1});
  odd.rgb[3] = std::numeric_limits<float>::quiet_NaN();
  write("odd.exr", odd.bytes());
  write("a.toml", std::string(kGoodScene) + kImageBackground + "\"odd.exr\"\n");
  const Outcome check = run("check a.toml");
  EXPECT_EQ(check.status, 0);
  EXPECT_TRUE(contains(check.err, "a.toml:16:8: warning: background.file: 7 x 4 texels; a latitude-longitude map"))
      << check.err;
  EXPECT_TRUE(contains(check.err, "1 values are NaN and 0 negative; they are replaced by 0")) << check.err;
  const Outcome render = run("render a.toml -o a.exr");
  EXPECT_EQ(render.status, 0);
  EXPECT_TRUE(contains(render.err, check.err)) << render.err;
  const Outcome unused = run("check a.toml --set background.type=constant");
  EXPECT_EQ(unused.status, 0);
  EXPECT_TRUE(contains(unused.err, "background.file: has no effect")) << unused.err;
}

TEST_F(CliValidation, ABackgroundImageIsNotOverwritten) {
  write("a.toml", std::string(kGoodScene) + kImageBackground + "\"sky.exr\"\n");
  const std::string before = text_of(folder_ / "sky.exr");
  for (const char* frames : {"", " --frames 1"}) {
    const Outcome r = run(std::string("render a.toml -q -o sky.exr") + frames);
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(contains(r.err, "would overwrite sky.exr (background image)")) << r.err;
  }
  EXPECT_EQ(text_of(folder_ / "sky.exr"), before);
}

TEST_F(CliValidation, ATextureIsNotOverwritten) {
  write("a.toml", std::string(kGoodScene) +
                      "[material.m]\ntype = \"lambertian\"\nalbedo = { texture = \"image\", file = \"sky.exr\" }\n");
  const std::string before = text_of(folder_ / "sky.exr");
  for (const char* frames : {"", " --frames 1"}) {
    const Outcome r = run(std::string("render a.toml -q -o sky.exr") + frames);
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(contains(r.err, "would overwrite sky.exr (texture)")) << r.err;
  }
  EXPECT_EQ(text_of(folder_ / "sky.exr"), before);
}

TEST_F(CliValidation, ABackgroundImageMayBeASequence) {
  write("s.0001.exr", support::ExrFile::constant(8, 4, {1, 1, 1}).bytes());
  write("s.0002.exr", support::ExrFile::constant(8, 4, {2, 2, 2}).bytes());
  write("a.toml", std::string(kGoodScene) + kImageBackground + "\"s.####.exr\"\n");
  EXPECT_EQ(run("check a.toml --frames 1-2").out, "a.toml: ok, 2 frames\n");
  EXPECT_EQ(run("check a.toml --frames 1-3").status, 66);
  EXPECT_NE(run("info a.toml --frame 1").out.substr(0, 30), run("info a.toml --frame 2").out.substr(0, 30));
  EXPECT_EQ(run("render a.toml -q -o s.%04d.exr --frames 2").status, 2) << "an output would be an input";
}

TEST_F(CliValidation, TheMemoryOfABackgroundImageIsCheckedBeforeItIsRead) {
  write("huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32768 +X 65536\n");
  write("a.toml", std::string(kGoodScene) + kImageBackground + "\"huge.hdr\"\n");
  const Outcome r = run("render a.toml -q -o a.exr --memory-limit 1G");
  EXPECT_EQ(r.status, 71);
  EXPECT_EQ(r.err,
            "orrery: huge.hdr: an image of 65536 x 32768 texels needs about 26.7 GiB, and --memory-limit allows "
            "1.0 GiB\n");
  write("b.toml", std::string(kGoodScene) + kImageBackground + "\"sky.exr\"\n");
  EXPECT_TRUE(contains(run("info b.toml").out, "background  sky.exr: 8 x 4, lin_rec709\n"));
  EXPECT_TRUE(contains(run("info b.toml").out, ", background 0.4 KiB\n")) << run("info b.toml").out;
}

TEST_F(CliValidation, LightsTooBrightForTheFilmAreErrors) {
  const auto errors = [&](const std::string& text) {
    write("a.toml", std::string(kGoodScene) + text);
    const Outcome r = run("check a.toml");
    return (r.status == 65 ? "" : "not 65: ") + r.err;
  };
  const std::string lamp = "[material.lamp]\ntype = \"emitter\"\n";
  EXPECT_TRUE(
      contains(errors(lamp + "radiance = [1, 1, 1e6]\nexposure = 20\n"), "material.lamp.exposure: the radiance"));
  EXPECT_TRUE(contains(errors("[background]\ntype = \"sky\"\nexposure = 40\n"), "background.exposure: the radiance"));
  write("map.exr", support::ExrFile::constant(8, 4, {2, 2, 2}).bytes());
  EXPECT_TRUE(contains(errors(std::string(kImageBackground) + "\"map.exr\"\nexposure = 34\n"),
                       "background.exposure: the radiance"));
  EXPECT_TRUE(mentions(errors(lamp + "radiance = { texture = \"image\", file = \"map.exr\" }\nexposure = 34\n"),
                       {"material.lamp.exposure", "34359738368", "17179869184"}));
  EXPECT_EQ(run("check a.toml --set material.lamp.exposure=33").status, 0);
}

TEST_F(CliValidation, UnusedPointColoursAreReported) {
  write("c.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n0 0 -3 255 0 0\n");
  write("c.toml", std::string(kGoodScene) + "[[points]]\nfile = \"c.ply\"\nradius = 1\nmaterial = \"grey\"\n");
  EXPECT_TRUE(contains(run("info c.toml").out, "points      c.ply: 1 sphere; unused: red, green, blue\n"));
}

}  // namespace
}  // namespace orrery::test
