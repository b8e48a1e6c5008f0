// SPDX-License-Identifier: Apache-2.0
// Data files: convert and info.
#include <algorithm>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/mentions.h"

namespace orrery::test {
namespace {

std::string dump_frame(int step, const std::string& columns, const std::vector<std::string>& rows) {
  std::string out = "ITEM: TIMESTEP\n" + std::to_string(step) + "\nITEM: NUMBER OF ATOMS\n" +
                    std::to_string(rows.size()) + "\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\nITEM: ATOMS " +
                    columns + "\n";
  for (const std::string& row : rows) out += row + "\n";
  return out;
}

constexpr const char* kColumns = "id type element radius x y z vx vy vz";

class CliConvert : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.dump", dump_frame(0, kColumns,
                               {"4 1 C 0.5 1.5 2 3 1 0 0", "2 2 Ar 0.7 4.25 2 7 3 0 0", "1 1 C 0.3 6 8.125 1 -2 0 0",
                                "3 1 C 1.1 0.1 5 5 0.5 0 0"}) +
                        dump_frame(10, kColumns, {}) + dump_frame(20, kColumns, {"1 1 C 1 1 2 3 6 0 0"}));
  }

  std::string converted(const std::string& arguments, const std::string& output = "out.csv") {
    const Outcome r = run("convert " + arguments + " -o " + output + " -q");
    EXPECT_EQ(r.status, 0) << arguments << ": " << r.err;
    return text_of(folder_ / output);
  }
  nlohmann::json info(const std::string& arguments) {
    const Outcome r = run("info " + arguments + " --json");
    EXPECT_EQ(r.status, 0) << arguments << ": " << r.err;
    return r.status == 0 ? nlohmann::json::parse(r.out) : nlohmann::json();
  }
  void expect_error(const std::string& arguments, int status, const std::string& part) {
    const Outcome r = run(arguments);
    EXPECT_EQ(r.status, status) << arguments << ": " << r.err;
    EXPECT_TRUE(contains(r.err, part)) << arguments << ": " << r.err;
  }
};

TEST_F(CliConvert, EveryFormatGivesTheSamePlotAndTheSameValues) {
  // Without a box, as in .npy and .csv, these are a molecule, which has another view and a depth cue.
  const std::string plot =
      " --up z --look-from 30,20 --depth-cue 0 --color-by vx --width 32 --height 18 --samples 4 --progress none -q";
  ASSERT_EQ(run("plot a.dump -o a.ppm" + plot).status, 0);
  const nlohmann::json before = info("a.dump");
  for (const std::string name : {"b.ply", "b.xyz", "b.npy", "b.csv"}) {
    const Outcome r = run("convert a.dump -o " + name);
    ASSERT_EQ(r.status, 0) << r.err;
    const bool has_texts = name != "b.ply", has_box = name == "b.xyz";
    EXPECT_EQ(r.err, "wrote " + name + ": 4 spheres; columns x, y, z, radius, id, type, " +
                         (has_texts ? "element, " : "") + "vx, vy, vz\n" +
                         (has_box ? "" : "note: " + name + ": left out the simulation box: only .xyz has one\n") +
                         (has_texts ? "" : "note: b.ply: left out element: the format cannot store these strings\n"));
    ASSERT_EQ(run("plot " + name + " -o b.ppm" + plot).status, 0) << name;
    EXPECT_TRUE(text_of(folder_ / "b.ppm") == text_of(folder_ / "a.ppm")) << name;
    const nlohmann::json after = info(name);
    EXPECT_EQ(after["roles"]["radius"], before["roles"]["radius"]);
    for (const nlohmann::json& column : before["columns"]) {
      const auto same = std::find_if(after["columns"].begin(), after["columns"].end(), [&](const auto& c) {
        return c["name"] == (column["name"] == "element" && name == "b.xyz" ? "species" : column["name"]);
      });
      if (column["name"] == "element" && !has_texts) continue;
      ASSERT_NE(same, after["columns"].end()) << name << column["name"];
      for (const char* key : {"minimum", "maximum", "distinct"})
        EXPECT_EQ(same->value(key, nlohmann::json()), column.value(key, nlohmann::json())) << name << column["name"];
    }
  }
}

TEST_F(CliConvert, SelectsSortsAndCopiesRows) {
  EXPECT_EQ(converted("a.dump --select 'type == 1 && x < 7' --replicate 1,2,1"),
            "x,y,z,radius,id,type,element,vx,vy,vz\n"
            "6,8.125,1,0.3,1,1,\"C\",-2,0,0\n"
            "0.1,5,5,1.1,3,1,\"C\",0.5,0,0\n"
            "1.5,2,3,0.5,4,1,\"C\",1,0,0\n"
            "6,18.125,1,0.3,1,1,\"C\",-2,0,0\n"
            "0.1,15,5,1.1,3,1,\"C\",0.5,0,0\n"
            "1.5,12,3,0.5,4,1,\"C\",1,0,0\n");
  // In front of the plane, as seen from the default view, is above it; the front is at -y.
  EXPECT_EQ(converted("a.dump --slice z=4"),
            "x,y,z,radius,id,type,element,vx,vy,vz\n6,8.125,1,0.3,1,1,\"C\",-2,0,0\n1.5,2,3,0.5,4,1,\"C\",1,0,0\n");
  EXPECT_EQ(converted("a.dump --slice y=5"),
            "x,y,z,radius,id,type,element,vx,vy,vz\n6,8.125,1,0.3,1,1,\"C\",-2,0,0\n0.1,5,5,1.1,3,1,\"C\",0.5,0,0\n");
}

TEST_F(CliConvert, CopiesOfAnAssemblyHaveTheRowsOfTheirChains) {
  std::string pdb = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n";
  for (const char* shift : {"0.00000", "5.00000"})
    pdb += std::string("REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        ") + shift +
           "\nREMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
           "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n";
  pdb +=
      "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n"
      "ATOM      2  C   GLY B   2       4.000   5.000   6.000  1.00  0.00           C\n"
      "ATOM      3  O   GLY B   3       7.000   8.000   9.000  1.00  0.00           O\n";
  write("a.pdb", pdb);
  EXPECT_EQ(converted("a.pdb --assembly 1 --element-radii vdw"),
            "x,y,z,radius,element,chain,name,residue,altloc,record,residue_number,b_factor,occupancy\n"
            "4,5,6,1.7,\"C\",\"B\",\"C\",\"GLY\",\"\",\"ATOM\",2,0,1\n"
            "7,8,9,1.52,\"O\",\"B\",\"O\",\"GLY\",\"\",\"ATOM\",3,0,1\n"
            "9,5,6,1.7,\"C\",\"B\",\"C\",\"GLY\",\"\",\"ATOM\",2,0,1\n"
            "12,8,9,1.52,\"O\",\"B\",\"O\",\"GLY\",\"\",\"ATOM\",3,0,1\n");
  const Outcome r = run("convert a.pdb -o a.xyz");
  EXPECT_EQ(r.status, 0);
  EXPECT_TRUE(
      mentions(r.err, {"note: a.xyz: no column radius", "--radius", "--element-radii", "\nnote: a.xyz", "altloc"}));
}

TEST_F(CliConvert, RadiusIsWrittenIfItIsKnown) {
  write("a.csv", "x,y,z,size\n1,2,3,4\n");
  Outcome r = run("convert a.csv -o b.csv");
  EXPECT_EQ(r.status, 0);
  EXPECT_TRUE(mentions(r.err, {"wrote b.csv: 1 sphere; columns x, y, z, size\nnote: b.csv", "radius", "--radius"}));
  EXPECT_EQ(text_of(folder_ / "b.csv"), "x,y,z,size\n1,2,3,4\n");
  EXPECT_EQ(converted("a.csv --radius 0.5"), "x,y,z,radius,size\n1,2,3,0.5,4\n");
  EXPECT_EQ(converted("a.csv --radius size --radius-scale 0.5"), "x,y,z,radius,size\n1,2,3,2,4\n");
  write("d.csv", "x,y,z,diameter\n1,2,3,4\n");
  EXPECT_EQ(converted("d.csv"), "x,y,z,radius\n1,2,3,2\n")
      << "a diameter beside the radius would contradict another one";
}

TEST_F(CliConvert, ColorsOfAMapAreSrgb) {
  write("a.csv", "x,y,z,t\n1,0,0,0\n2,0,0,1\n3,0,0,nan\n");
  EXPECT_EQ(converted("a.csv --radius 1 --color-by t --map viridis"),
            "x,y,z,radius,red,green,blue,t\n1,0,0,1,68,1,84,0\n2,0,0,1,253,231,37,1\n3,0,0,1,188,188,188,nan\n");
  EXPECT_TRUE(contains(converted("a.csv --radius 1 --color-by t --map viridis --range 1:2"), "\n2,0,0,1,68,1,84,1\n"));
  EXPECT_EQ(info("out.csv")["roles"]["rgb"]["maximum"], 255);
  EXPECT_TRUE(contains(converted("a.dump --select 'id == 3' --color-by element"), "\n0.1,5,5,1.1,144,144,144,3,1,"));
  // Speeds are 2, 3, 0.5 and 1; the computed column is not written.
  const std::string by_speed = converted("a.dump --color-by speed --map viridis");
  EXPECT_TRUE(by_speed.starts_with("x,y,z,radius,red,green,blue,id,type,element,vx,vy,vz\n"));
  EXPECT_TRUE(contains(by_speed, "\n4.25,2,7,0.7,253,231,37,2,")) << by_speed;
}

TEST_F(CliConvert, ColorsOfTheFileAreBytes) {
  write("a.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property ushort red\nproperty ushort green\nproperty ushort blue\nproperty float t\nend_header\n"
        "1 2 3 65535 32896 0 5\n1 2 4 0 257 128 6\n");
  const std::string colors = "x,y,z,red,green,blue,t\n1,2,3,255,128,0,5\n1,2,4,0,1,0,6\n";
  EXPECT_EQ(converted("a.ply"), colors);
  EXPECT_EQ(converted("a.ply --color-by rgb"), colors);
  EXPECT_EQ(converted("a.ply --color-by t --map viridis"),
            "x,y,z,red,green,blue,t\n1,2,3,68,1,84,5\n1,2,4,253,231,37,6\n");
  converted("a.ply", "b.npy");
  EXPECT_EQ(info("b.npy")["columns"][3]["type"], "uint8");
  expect_error("convert a.dump -o b.csv --color-by rgb", 65, "the file has no colours");
}

TEST_F(CliConvert, FramesAreSeparateFiles) {
  const Outcome r = run("convert a.dump -o f.##.csv --frames all --color-by vx --map viridis");
  EXPECT_EQ(r.status, 0);
  EXPECT_TRUE(contains(r.err, "a.dump: warning: frame 2: the frame has no particles\nwrote f.02.csv: 0 spheres"))
      << r.err;
  // One range for all frames: -2 to 6.
  EXPECT_TRUE(contains(text_of(folder_ / "f.01.csv"), "\n6,8.125,1,0.3,68,1,84,1,"));
  EXPECT_EQ(text_of(folder_ / "f.02.csv"), "x,y,z,radius,red,green,blue,id,type,element,vx,vy,vz\n");
  EXPECT_TRUE(contains(text_of(folder_ / "f.03.csv"), "\n1,2,3,1,253,231,37,1,"));
  EXPECT_TRUE(contains(converted("a.dump --frame 3"), "\n1,2,3,1,1,1,\"C\",6,0,0\n"));
  converted("a.dump --frames 3", "one.csv");
  EXPECT_EQ(text_of(folder_ / "one.csv"), text_of(folder_ / "out.csv"));
  expect_error("convert a.dump -o f.csv --frames 1,3", 2, "f.csv is one name for 2 frames; add a frame pattern");
  expect_error("convert a.dump -o g.##.csv", 2, "g.##.csv has a frame pattern");
  expect_error("convert a.dump -o g.##.csv --frames 3-4", 65, "there is no frame 4; a.dump has 3 frames");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "g.03.csv")) << "nothing is written before that is known";
  // A sequence of files.
  EXPECT_EQ(run("convert f.##.csv -o g.##.csv --frames 1,3 -q").status, 0);
  EXPECT_EQ(text_of(folder_ / "g.03.csv"), text_of(folder_ / "f.03.csv"));
}

TEST_F(CliConvert, AnExrNamesTheColorMap) {
  ASSERT_EQ(run("plot a.dump -o p.exr --color-by vx --map viridis --width 16 --height 9 --samples 1 -q").status, 0);
  const std::string exr = text_of(folder_ / "p.exr");
  EXPECT_TRUE(contains(exr, "orrery/points[0].color"));
  EXPECT_TRUE(contains(exr, "column = \"vx\", map = \"viridis\", range = ["));
}

TEST_F(CliConvert, NoInputIsOverwritten) {
  const std::string csv = "x,y,z\n1,2,3\n";
  write("a.01.csv", csv);
  write("a.02.csv", csv);
  std::filesystem::create_symlink("a.02.csv", folder_ / "link.csv");
  expect_error("convert a.01.csv -o a.01.csv --radius 1", 2, "a.01.csv");
  expect_error("convert a.02.csv -o link.csv --radius 1", 2, "link.csv");
  expect_error("convert a.##.csv -o a.##.csv --frames 1-2 --radius 1", 2, "a.01.csv");
  write("map.csv", "0,0,0\n1,1,1\n");
  expect_error("convert a.01.csv -o map.csv --color-by x --map map.csv", 2, "colour map");
  for (const char* file : {"a.01.csv", "a.02.csv"}) EXPECT_EQ(text_of(folder_ / file), csv) << file;
  EXPECT_EQ(text_of(folder_ / "map.csv"), "0,0,0\n1,1,1\n");
}

/// The column of elements keeps its meaning, whatever it is called.
TEST_F(CliConvert, ElementsOfAnXyzAreElements) {
  write("in.xyz", "2\nProperties=species:S:1:pos:R:3\nSi 0 0 0\nO 1 1 1\n");
  EXPECT_TRUE(contains(converted("in.xyz", "out.xyz"), "Properties=species:S:1:pos:R:3\nSi 0 0 0\nO 1 1 1"));
  EXPECT_EQ(info("out.xyz")["roles"]["element"], "species");
}

/// A text file with a wrong checksum decompresses, but not to what was written.
TEST_F(CliConvert, DamagedCompressionIsAnError) {
  write("in.csv", "x,y,z\n0,0,0\n2,0,0\n");
  ASSERT_EQ(std::system(("gzip -k " + (folder_ / "in.csv").string()).c_str()), 0);
  const std::string good = text_of(folder_ / "in.csv.gz");
  EXPECT_EQ(converted("in.csv.gz"), "x,y,z\n0,0,0\n2,0,0\n");
  write("more.csv", "4,0,0\n");
  ASSERT_EQ(std::system(("gzip -k " + (folder_ / "more.csv").string()).c_str()), 0);
  write("two.csv.gz", good + text_of(folder_ / "more.csv.gz") + std::string(16, '\0'));
  EXPECT_EQ(converted("two.csv.gz"), "x,y,z\n0,0,0\n2,0,0\n4,0,0\n") << "two members, padded";
  for (const std::size_t from_end : {1, 5, 12}) {
    std::string damaged = good;
    damaged[damaged.size() - from_end] ^= 1;
    write("damaged.csv.gz", damaged);
    expect_error("convert damaged.csv.gz -o out.csv", 65, "damaged compressed data");
  }
  write("short.csv.gz", good.substr(0, good.size() - 3));
  expect_error("convert short.csv.gz -o out.csv", 65, "truncated");
  write("longer.csv.gz", good + "x");
  expect_error("convert longer.csv.gz -o out.csv", 65, "damaged compressed data");
}

TEST_F(CliConvert, ColorMapsAreInputsOfAllCommands) {
  write("map.txt", "0 0 255\n255 0 0\n");
  write("a.csv", "x,y,z,q\n0,0,0,1\n1,0,0,2\n");
  const std::string plot = "plot a.csv -o a.ppm --width 8 --height 4 --samples 1 -q --color-by q --map ./map.txt ";
  for (const char* output : {"--stats map.txt", "--save-scene map.txt", "--legend map.txt"})
    EXPECT_EQ(run(plot + output).status, 2) << output;
  ASSERT_EQ(run(plot + "--save-scene s.toml").status, 0);
  EXPECT_EQ(run("render s.toml -o b.ppm --stats map.txt").status, 2);
  EXPECT_EQ(text_of(folder_ / "map.txt"), "0 0 255\n255 0 0\n");
}

/// Rendering the saved scene needs no option again, except those of sampling.
TEST_F(CliConvert, SavedScenesHaveTheSettingsOfTheCommandLine) {
  write("a.csv", "x,y,z,q\n0,0,0,1\n1,0,0,2\n");
  const std::string size = " --width 16 --height 9 --samples 4 -q";
  ASSERT_EQ(
      run("plot a.csv -o a.ppm --set camera.width=5 --set render.seed=7 --set color.exposure=1 --save-scene s.toml" +
          size)
          .status,
      0);
  ASSERT_EQ(run("render s.toml -o b.ppm -q").status, 0);
  EXPECT_TRUE(text_of(folder_ / "a.ppm") == text_of(folder_ / "b.ppm"));
  ASSERT_EQ(run("plot a.csv -o c.ppm" + size).status, 0);
  EXPECT_FALSE(text_of(folder_ / "a.ppm") == text_of(folder_ / "c.ppm")) << "the settings matter";
  EXPECT_EQ(run("plot a.csv -o c.ppm --radius 0.3 --radius-scale 2" + size).status, 2);
  const Outcome scaled = run("plot a.csv -o c.ppm --radius-scale 2 --width 16 --height 9 --samples 1");
  EXPECT_TRUE(mentions(scaled.err, {"radius 1: ", "scaled by 2"})) << scaled.err;
}

TEST_F(CliConvert, PlotsAndTheirSavedScenesHaveOpacities) {
  write("a.csv", "x,y,z,q\n0,0,0,1\n1,0,0,0.5\n");
  const std::string size = " --width 16 --height 9 --samples 4 -q";
  ASSERT_EQ(run("plot a.csv -o plain.ppm --radius 0.4" + size).status, 0);
  for (const char* const options :
       {"--opacity 0.4", "--opacity q", "--opacity 0.4 --opacity \"q == 1: 0.9\" --opacity \"x in [0:1]: 0.3\""}) {
    const Outcome plot =
        run(std::string("plot a.csv -o a.ppm --radius 0.4 --save-scene s.toml --force ") + options + size);
    ASSERT_EQ(plot.status, 0) << plot.err;
    ASSERT_EQ(run("render s.toml -o b.ppm -q").status, 0);
    EXPECT_TRUE(text_of(folder_ / "a.ppm") == text_of(folder_ / "b.ppm")) << options;
    EXPECT_FALSE(text_of(folder_ / "a.ppm") == text_of(folder_ / "plain.ppm")) << options;
  }
  ASSERT_EQ(run("plot a.csv -o b.ppm --radius 0.4 --opacity \"q == 7: 0.1\" --opacity 1" + size).status, 0);
  EXPECT_TRUE(text_of(folder_ / "plain.ppm") == text_of(folder_ / "b.ppm")) << "the last that matches decides";
  for (const auto& [options, status, told] :
       std::vector<std::tuple<const char*, int, const char*>>{{"--opacity 1.5", 2, "--opacity: 1.5 must be in 0..1"},
                                                              {"--opacity nan", 2, "--opacity: nan must be in 0..1"},
                                                              {"--opacity \"q == 1:2\"", 2, "`2` is not an opacity"},
                                                              {"--opacity \"q = 1:1\"", 65, "at character 3"},
                                                              {"--opacity w", 65, "the file has no column `w`"}}) {
    const Outcome r = run(std::string("plot a.csv -o b.ppm --radius 0.4 ") + options + size);
    EXPECT_EQ(r.status, status) << options;
    EXPECT_TRUE(contains(r.err, told)) << r.err;
  }
}

TEST_F(CliConvert, PlotsUseTheDefaultViewOfAConfigWithoutTheirOwn) {
  write("my.ocio",
        "ocio_profile_version: 1\nsearch_path: .\nroles: {default: lin_rec709, scene_linear: lin_rec709}\n"
        "displays:\n  d:\n    - !<View> {name: film, colorspace: lin_rec709}\n"
        "    - !<View> {name: other, colorspace: lin_rec709}\n"
        "  full:\n    - !<View> {name: film, colorspace: lin_rec709}\n"
        "    - !<View> {name: Un-tone-mapped, colorspace: lin_rec709}\nactive_displays: []\nactive_views: []\n"
        "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n");
  write("a.csv", "x,y,z,q\n0,0,0,1\n1,0,0,2\n");
  const std::string plot = "plot a.csv -o a.ppm --color-by q --width 16 --height 9 --samples 1 --legend l.svg ";
  const std::string choice = "plot: view transform film: the default; the OCIO config has no view Un-tone-mapped";
  for (const char* config : {"--set color.config=my.ocio", "--set color.config=my.ocio --save-scene s.toml"}) {
    const Outcome r = run(plot + config);
    EXPECT_EQ(r.status, 0) << config << r.err;
    EXPECT_TRUE(contains(r.err, choice)) << config << r.err;
  }
  EXPECT_TRUE(contains(text_of(folder_ / "s.toml"), "view = \"film\""));
  for (const char* config : {"", "--set color.config=my.ocio --set color.display=full",
                             "--set color.config=my.ocio --set color.view=other"}) {
    const Outcome r = run(plot + config);
    EXPECT_EQ(r.status, 0) << config << r.err;
    EXPECT_FALSE(contains(r.err, "display view")) << config << r.err;
  }
  for (const std::string key : {"color.view", "color.display"})
    EXPECT_TRUE(contains(run("plot a.csv -o a.ppm --set color.config=my.ocio --set " + key + "=none").err,
                         key + ": the OCIO config (my.ocio) has no "));
}

/// The scene of a plot is not a file: its lines mean nothing to the user.
TEST_F(CliConvert, ErrorsOfAPlotHaveNoLinesOfItsScene) {
  write("far.csv", "x,y,z\n1e30,0,0\n0,0,0\n");
  const Outcome r = run("plot far.csv -o far.png");
  EXPECT_EQ(r.status, 65);
  EXPECT_TRUE(contains(r.err, "far.csv: error: row 1 of far.csv: center")) << r.err;
}

TEST_F(CliConvert, FilesOfOtherLayoutsAreRefused) {
  write("a.pqr", "REMARK   1 PQR file\nATOM      1  N   ALA     1       1.000   2.000   3.000  0.1414 1.8240\n");
  expect_error("info a.pqr", 65, "PQR files are not supported");
}

TEST_F(CliConvert, ErrorsLeaveNoFile) {
  write("nan.csv", "x,y,z\n1,2,3\nnan,2,3\n");
  const int before = file_count();
  expect_error("convert a.dump -o a.vtp", 2, "unknown extension `.vtp`; use .ply, .xyz, .npy or .csv");
  expect_error("convert a.dump", 2, "-o");
  expect_error("convert a.dump -o a.csv --map viridis", 2, "--map and --range need --color-by");
  expect_error("convert a.dump -o a.csv --replicate 2,0,1", 2, "integers from 1 to 1000");
  expect_error("convert a.dump -o a.csv --replicate 1e9,1,1", 2, "integers from 1 to 1000");
  expect_error("convert a.dump -o none/a.csv", 73, "none");
  expect_error("convert none.dump -o a.csv", 66, "none.dump");
  expect_error("convert a.dump -o a.csv --select 'typ == 1'", 65, "a.dump: error: select:");
  expect_error("convert a.dump -o a.csv --color-by vxx", 65, "did you mean `vx`?");
  expect_error("convert nan.csv -o a.csv", 65, "row 2 of");
  expect_error("convert good.toml -o a.csv", 65, "unknown file format");
  EXPECT_EQ(file_count(), before);
  EXPECT_EQ(converted("nan.csv --skip-bad"), "x,y,z\n1,2,3\n");
  const Outcome none = run("convert a.dump -o b.csv --select 'type == 9'");
  EXPECT_EQ(none.status, 0);
  EXPECT_TRUE(mentions(none.err, {"warning: select", "4 particles\nwrote b.csv: 0 spheres;"}));
}

TEST_F(CliConvert, MaterialsAreAColumnLikeOthers) {
  ASSERT_EQ(run("generate cloud --count 100 -o cloud.toml").status, 0);
  EXPECT_TRUE(converted("cloud.ply").starts_with("x,y,z,radius,material\n"));
}

TEST_F(CliConvert, GenerateDoesNotReplaceConvertedFiles) {
  ASSERT_EQ(run("convert a.dump -o cloud.ply").status, 0);
  const std::string converted = text_of(folder_ / "cloud.ply");
  expect_error("generate cloud --count 10 -o cloud.toml", 73, "not written by orrery generate");
  EXPECT_EQ(text_of(folder_ / "cloud.ply"), converted);
  for (int i = 0; i < 2; ++i) ASSERT_EQ(run("generate cloud --count 10 -o own.toml").status, 0) << "its own file";
}

class CliDataInfo : public CliConvert {};

TEST_F(CliDataInfo, DescribesDataFilesByTheirContent) {
  const Outcome r = run("info a.dump --frame 3");
  EXPECT_EQ(r.status, 0);
  EXPECT_TRUE(r.out.starts_with("file        a.dump\nformat      LAMMPS dump\nframe       3 of 3, step 20\n")) << r.out;
  EXPECT_EQ(r.err, "");
  std::filesystem::rename(folder_ / "a.dump", folder_ / "a.pdb");
  EXPECT_EQ(info("a.pdb")["format"], "LAMMPS dump");
}

TEST_F(CliDataInfo, OptionsOfTheOtherKindOfFileAreRefused) {
  for (const std::string option : {"--settings", "--set camera.vfov=30", "--samples 3"})
    expect_error("info a.dump " + option, 2, option.substr(0, option.find(' ')) + ": a.dump is a data file");
  expect_error("info good.toml --component 1", 2, "--component: good.toml is a scene");
}

TEST_F(CliDataInfo, ErrorsAreThoseOfTheKindOfFile) {
  std::filesystem::rename(folder_ / "good.toml", folder_ / "good.txt");
  expect_error("info good.txt", 65, "unknown file format");
  expect_error("info none.dump", 66, "none.dump");
  write("a.exr", std::string("\x76\x2f\x31\x01\2\0\0\0", 8));
  expect_error("info a.exr", 65, "`oiiotool --info -v` shows");
  expect_error("info a.dump --frame 4", 2, "--frame 4: a.dump has 3 frames");
  std::filesystem::rename(folder_ / "a.dump", folder_ / "a.toml");
  expect_error("info a.toml", 65, "a.toml:1:");
  write("cut.dump", dump_frame(0, kColumns, {"1 1 C 0.5 1 2 3 0 0 0", "2 1 C"}));
  expect_error("info cut.dump", 65, "cut.dump:11");
}

}  // namespace
}  // namespace orrery::test
