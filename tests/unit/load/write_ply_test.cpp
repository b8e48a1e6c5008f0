// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "load/write_scene.h"
#include "points/load_points.h"
#include "support/temp_dir.h"

namespace orrery::load {
namespace {

scene::Points some_points(std::size_t count, bool with_materials) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-10, 10);
  scene::Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.centers.push_back({uniform(random), uniform(random), uniform(random)});
    points.radii.push_back(uniform(random));
    if (with_materials) points.materials.push_back(static_cast<std::uint32_t>(i % 5));
  }
  return points;
}

scene::Points read_back(const std::filesystem::path& file) {
  scene::Points points;
  points::LoadRequest request;
  request.file = file;
  request.key = "points[0]";
  const std::vector<scene::Material> materials(5);
  request.materials = &materials;
  for (const scene::SceneDiagnostic& diagnostic : points::load_points(request, points))
    EXPECT_EQ(diagnostic.severity, base::Severity::kWarning) << diagnostic.text;
  return points;
}

TEST(LoadWritePly, DoublesReadBackToTheSameBits) {
  const support::TempDir folder;
  for (const bool with_materials : {false, true}) {
    const auto points = some_points(100, with_materials);
    write_ply(points, folder / "a.ply");
    const auto read = read_back(folder / "a.ply");
    EXPECT_EQ(read.centers, points.centers);
    EXPECT_EQ(read.radii, points.radii);
    EXPECT_EQ(read.materials, points.materials);
  }
}

TEST(LoadWritePly, WritesAFileWithoutPoints) {
  const support::TempDir folder;
  write_ply({}, folder / "a.ply");
  EXPECT_TRUE(read_back(folder / "a.ply").centers.empty());
}

TEST(LoadWritePly, TheHeaderNamesTheWriter) {
  const support::TempDir folder;
  write_ply({}, folder / "a.ply");
  EXPECT_TRUE(is_ply_of(kPlyWriter, folder / "a.ply"));
  EXPECT_FALSE(is_ply_of("orrery", folder / "a.ply")) << "convert";
  EXPECT_FALSE(is_ply_of(kPlyWriter, folder / "none.ply"));
}

TEST(LoadWritePly, MissingFolderIsCannotCreate) {
  const support::TempDir folder;
  try {
    write_ply({}, folder / "none" / "a.ply");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
  }
}

}  // namespace
}  // namespace orrery::load
