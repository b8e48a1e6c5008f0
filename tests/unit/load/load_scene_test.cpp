// SPDX-License-Identifier: Apache-2.0
#include "load/load_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "load/write_scene.h"
#include "support/read_scene_file.h"
#include "support/scene_files.h"
#include "support/temp_dir.h"

namespace orrery::load {
namespace {

using support::read_scene_file;
using support::SceneFiles;
using support::TempDir;

TEST(LoadScene, PointsFilesAreRelativeToTheScene) {
  SceneFiles files(read_scene_file);
  files.add("two.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
            "property float radius\nproperty int material\nend_header\n1 2 3 0.5 1\n4 5 6 0.25 0\n");
  // The order of the names differs from that in the file, which defines the indices.
  const auto read = files.read(
      "[material.b]\ntype = \"dielectric\"\n[material.a]\ntype = \"metal\"\nalbedo = [1,1,1]\n"
      "[[points]]\nfile = \"two.ply\"\nmaterial = \"b\"\n");
  ASSERT_EQ(read.scene.points.size(), 1u);
  EXPECT_EQ(read.scene.points[0].centers, (std::vector<math::Vec3d>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(read.scene.points[0].radii, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(read.scene.points[0].materials, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(read.scene.materials[1].name, "a");
}

/// Rods of a file are those of tables with the same numbers.
TEST(LoadScene, RodsOfFilesAreThoseOfTables) {
  SceneFiles files(read_scene_file);
  files.add("bonds.csv", "x0,y0,z0,x1,y1,z1,radius\n1,2,3,0,1,0.1,0.5\n0,0,0,1,0,0,0.25\n");
  const std::string materials =
      "[material]\na = { type = \"lambertian\", albedo = [0, 0, 0] }\nb = { type = \"metal\", albedo = [1, 1, 1] }\n";
  const auto from_file =
      files.read(materials + "[[rods]]\nfile = \"bonds.csv\"\nmaterial = [\"b\", \"a\"]\nname = \"all\"\n").scene;
  const auto from_tables = files
                               .read(materials + R"(
[[rod]]
from = [1, 2, 3]
to = [0, 1, 0.1]
radius = 0.5
material = ["b", "a"]
[[rod]]
from = [0, 0, 0]
to = [1, 0, 0]
radius = 0.25
material = ["b", "a"]
)")
                               .scene;
  ASSERT_EQ(from_file.rod_files.size(), 1u);
  EXPECT_EQ(from_file.rod_files[0].name, "all");
  EXPECT_EQ(from_file.rod_count(), 2u);
  const compile::CompiledScene a = compile::compile(from_file), b = compile::compile(from_tables);
  ASSERT_EQ(a.rods.size(), 2u);
  EXPECT_EQ(std::memcmp(a.rods.data(), b.rods.data(), 2 * sizeof(kernel::Rod)), 0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(a.object_materials[i], b.object_materials[i]) << i;
  EXPECT_EQ(a.rod_file_sizes, std::vector<std::size_t>{2});
  const auto one_radius =
      files.read(materials + "[[rods]]\nfile = \"bonds.csv\"\nradius = 2\nmaterial = \"a\"\n").scene;
  EXPECT_EQ(one_radius.rod_files[0].radii, (std::vector<double>{2, 2}));
}

TEST(LoadScene, ErrorsOfFilesOfRods) {
  SceneFiles files(read_scene_file);
  const auto told = [&](const std::string& data, const std::string& keys = "") {
    files.add("bonds.csv", data);
    return files.diagnostics(
        "[material.a]\ntype = \"lambertian\"\nalbedo = [0, 0, 0]\n"
        "[[rods]]\nfile = \"bonds.csv\"\nmaterial = \"a\"\n" +
        keys);
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  EXPECT_EQ(told("x0,y0,z0,x1,y1,z1,radius\n1,2,3,0,1,0.1,0.5\n"), "");
  expect(told("x0,y0,z0,x1,y1,radius\n1,2,3,0,1,0.1\n"),
         "scene.toml:5:8: error: rods[0].file: bonds.csv has no column `z1`; rods need x0, y0, z0, x1, y1 and z1");
  expect(told("x0,y0,z0,x1,y1,z1\n1,2,3,0,1,0.1\n"), "bonds.csv has no column `radius`; set `radius`");
  EXPECT_EQ(told("x0,y0,z0,x1,y1,z1\n1,2,3,0,1,0.1\n", "radius = 1\n"), "");
  expect(told("x0,y0,z0,x1,y1,z1,radius\n1,2,3,0,1,a,0.5\n"), "rods need numbers");
  expect(told("x0,y0,z0,x1,y1,z1,radius\n1,2,3,0,1,0,0.5\n1,2,3,0,nan,0,0.5\n"),
         "rods[0].file: row 2 of bonds.csv: to [0, nan, 0] is not finite");
  expect(told("x0,y0,z0,x1,y1,z1,radius\n1,2,3,0,1,0,-0.5\n"), "row 1 of bonds.csv: radius is -0.5; must be in");
  expect(told("x0,y0,z0,x1,y1,z1,radius\n1,2,3,0,1,0,0\n"), "row 1 of bonds.csv: radius is 0; must be in");
  expect(told("x,y,z,radius\n1,2,3,0.5\n"), "bonds.csv has no column `x0`");
  std::string many = "x0,y0,z0,x1,y1,z1,radius\n";
  for (int i = 0; i < 100; ++i) many += "0,0,0,1,1,1,0\n";
  expect(told(many), "more (100 in all)");
  expect(told("x0,y0,z0,x1,y1,z1,radius\n1,2,3,0,1,0.1,0.5\n", "\n[[rods]]\nfile = \"bonds.csv\"\nmaterial = \"b\"\n"),
         "rods[1].material is \"b\", which is not defined");
}

/// Spheres of earlier tables are still in memory when the next one is read.
TEST(LoadScene, TablesOfPointsShareTheMemoryLimit) {
  SceneFiles files(read_scene_file);
  std::string rows = "x,y,z,radius\n";
  for (int i = 0; i < 1000; ++i) rows += "0." + std::to_string(1000 + i) + ",0.1,0.2,0.3\n";
  files.add("a.csv", rows);
  const std::string table = "[[points]]\nfile = \"a.csv\"\nmaterial = \"a\"\n";
  SceneRequest request;
  request.source.file = files.folder() / "scene.toml";
  const auto fits = [&](int tables, std::uint64_t limit) {
    std::string text = "[material.a]\ntype = \"dielectric\"\n";
    for (int i = 0; i < tables; ++i) text += table;
    request.source.text = std::make_shared<const std::string>(std::move(text));
    request.memory_limit = limit;
    try {
      const auto count = read_with_data(request).scene.points.size();
      return count == static_cast<std::size_t>(tables);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory) << error.what();
      return false;
    }
  };
  // 1,000 rows need 40,000 bytes while they are read, and 24,000 for the coordinates afterwards.
  EXPECT_FALSE(fits(1, 35'000));
  EXPECT_TRUE(fits(1, 45'000));
  EXPECT_FALSE(fits(2, 60'000));
  EXPECT_TRUE(fits(2, 70'000));
  EXPECT_FALSE(fits(3, 80'000));
  EXPECT_TRUE(fits(3, 0)) << "no limit";
}

TEST(LoadScene, ErrorsOfAPointsFileAreReportedWithItsKey) {
  SceneFiles files(read_scene_file);
  files.add("bad.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
            "property float radius\nend_header\n1 2 nan 0.5\n4 5 6 0\n");
  const std::string scene =
      "[material.a]\ntype = \"dielectric\"\n[[points]]\nfile = \"bad.ply\"\nmaterial = \"a\"\n"
      "[[points]]\nfile = \"none.ply\"\nmaterial = \"a\"\n";
  EXPECT_EQ(files.diagnostics(scene),
            "scene.toml:4:8: error: points[0].file: row 1 of bad.ply has center [1, 2, nan] and radius 0.5\n"
            "    file = \"bad.ply\"\n"
            "           ^~~~~~~~~\n"
            "scene.toml:4:8: error: points[0].file: row 2 of bad.ply has center [4, 5, 6] and radius 0\n"
            "    file = \"bad.ply\"\n"
            "           ^~~~~~~~~\n"
            "scene.toml:4:8: error: points[0].file: 2 of 2 rows have coordinates that are not finite, or a radius that "
            "is not above 0; "
            "`skip_bad = true`, or --skip-bad, leaves them out\n"
            "    file = \"bad.ply\"\n"
            "           ^~~~~~~~~\n"
            "scene.toml:7:8: error: points[1].file: cannot open none.ply: No such file or directory\n"
            "    file = \"none.ply\"\n"
            "           ^~~~~~~~~~\n");
}

TEST(LoadScene, OnlyMissingPointsFilesAreMissingInput) {
  SceneFiles files(read_scene_file);
  const auto kind = [&](const std::string& text) {
    files.add("scene.toml", text);
    try {
      read_scene_file(files.folder() / "scene.toml");
      return base::ErrorKind::kInternal;
    } catch (const base::Error& error) {
      return error.kind();
    }
  };
  const std::string missing =
      "[material.a]\ntype = \"dielectric\"\n[[points]]\nfile = \"none.ply\"\nmaterial = \"a\"\n";
  EXPECT_EQ(kind(missing), base::ErrorKind::kMissingInput);
  EXPECT_EQ(kind(missing + "[image]\nwidth = 0\n"), base::ErrorKind::kBadData) << "the scene has another error";
  std::filesystem::create_directory(files.folder() / "none.ply");
  EXPECT_EQ(kind(missing), base::ErrorKind::kMissingInput);
}

TEST(LoadScene, RadiiOfPointsAreChecked) {
  SceneFiles files(read_scene_file);
  files.add("tiny.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
            "property double radius\nend_header\n1 2 3 0.5\n4 5 6 1e-40\n");
  const std::string told =
      files.diagnostics("[material.a]\ntype = \"dielectric\"\n[[points]]\nfile = \"tiny.ply\"\nmaterial = \"a\"\n");
  EXPECT_EQ(told,
            "scene.toml:4:8: error: points[0].file: row 2 of tiny.ply: radius is 1e-40; its magnitude must be in "
            "1e-30..1e+18\n    file = \"tiny.ply\"\n           ^~~~~~~~~~\n");
}

TEST(LoadScene, WritesPointsFilesNextToTheScene) {
  const TempDir folder;
  scene::Scene s;
  s.materials = {{"a", scene::Dielectric{}}, {"b", scene::Dielectric{2}}};
  s.points.resize(2);
  s.points[0].file = "one.ply";
  s.points[0].material = 1;
  s.points[0].centers = {{1, 2, 3}, {4, 5, 6}};
  s.points[0].radii = {0.1, -0.2};
  s.points[0].materials = {1, 0};
  s.points[1].file = "two.ply";
  s.points[1].radius.value = 0.25;
  s.points[1].centers = {{7, 8, 9}};
  s.points[1].radii = {0.25};
  write_scene(s, "", folder / "s.toml");
  const auto read = read_scene_file(folder / "s.toml").scene;
  ASSERT_EQ(read.points.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.points[i].file, s.points[i].file);
    EXPECT_EQ(read.points[i].material, s.points[i].material);
    EXPECT_EQ(read.points[i].radius.value, s.points[i].radius.value);
    EXPECT_EQ(read.points[i].centers, s.points[i].centers);
    EXPECT_EQ(read.points[i].radii, s.points[i].radii);
    EXPECT_EQ(read.points[i].materials, s.points[i].materials);
  }
}

TEST(LoadScene, ScenesWithoutCoincidentSpheresAreDistinctInTheirPrecision) {
  SceneFiles files(read_scene_file);
  const std::string material = "[material.a]\ntype = \"dielectric\"\n";
  const std::string sphere = "[[sphere]]\ncenter = [1, 2, 3]\nradius = 1\nmaterial = \"a\"\n";
  EXPECT_EQ(files.read(material + sphere).scene.distinct_in, scene::Precision::kExact);
  EXPECT_EQ(files.read(material + sphere, {"render.precision=fast"}).scene.distinct_in, scene::Precision::kFast);
  EXPECT_EQ(files.read(material + sphere + sphere).scene.distinct_in, std::nullopt);
}

}  // namespace
}  // namespace orrery::load
