// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "generate/generate.h"
#include "load/read_scene.h"
#include "load/write_scene.h"
#include "support/read_scene_file.h"

namespace orrery::generate {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

class GenerateFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("orrery-generate-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_;
};

TEST_F(GenerateFiles, FinalReadsBackAsTheSameScene) {
  const auto file = folder_ / "a.toml";
  generate_final({5, 3}, file);
  const auto read = support::read_scene_file(file);
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(load::scene_text(read.scene, ""), load::scene_text(make_final_scene({5, 3}), ""));
  EXPECT_EQ(files(), 1u);
}

TEST_F(GenerateFiles, FinalNamesTheCommandThatReproducesIt) {
  generate_final({5, 3}, folder_ / "a.toml");
  EXPECT_NE(bytes_of(folder_ / "a.toml").find("orrery generate final --seed 5 --grid 3 -o a.toml\n"),
            std::string::npos);
}

TEST_F(GenerateFiles, LargeFinalHasAPointsFile) {
  const auto file = folder_ / "wide.toml";
  generate_final({1, 40}, file);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "wide.ply"));
  const auto read = support::read_scene_file(file);
  EXPECT_EQ(read.scene.points.at(0).materials, make_final_scene({1, 40}).points.at(0).materials);
}

TEST_F(GenerateFiles, CloudReadsBackAsTheSameSpheres) {
  const auto file = folder_ / "c.toml";
  generate_cloud({1, 500}, file);
  const auto read = support::read_scene_file(file);
  const auto made = make_cloud({1, 500});
  ASSERT_EQ(read.scene.points.size(), 1u);
  EXPECT_EQ(read.scene.points[0].file, "c.ply");
  EXPECT_EQ(read.scene.points[0].centers, made.points[0].centers);
  EXPECT_EQ(read.scene.points[0].radii, made.points[0].radii);
  EXPECT_EQ(read.scene.points[0].materials, made.points[0].materials);
  for (std::size_t i = 0; i < made.materials.size(); ++i)
    EXPECT_EQ(read.scene.materials.at(i).name, made.materials[i].name) << "points count materials in this order";
}

TEST_F(GenerateFiles, CloudNamesTheCommandWithItsRadius) {
  generate_cloud({2, 10, 0.125}, folder_ / "c.toml");
  EXPECT_NE(bytes_of(folder_ / "c.toml").find("orrery generate cloud --seed 2 --count 10 --radius 0.125 -o c.toml\n"),
            std::string::npos);
}

TEST_F(GenerateFiles, TwiceGivesTheSameBytes) {
  generate_cloud({2, 100}, folder_ / "c.toml");
  const std::string toml = bytes_of(folder_ / "c.toml"), ply = bytes_of(folder_ / "c.ply");
  generate_cloud({2, 100}, folder_ / "c.toml");
  EXPECT_EQ(bytes_of(folder_ / "c.toml"), toml);
  EXPECT_EQ(bytes_of(folder_ / "c.ply"), ply);
}

TEST_F(GenerateFiles, SceneNamedLikeItsPointsIsAUsageError) {
  try {
    generate_cloud({1, 10}, folder_ / "cloud.ply");
    FAIL() << "the scene replaced its own points file";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("cloud.toml"), std::string::npos) << error.what();
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(GenerateFiles, MissingFolderIsCannotCreate) {
  try {
    generate_final({}, folder_ / "none" / "a.toml");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate) << error.what();
  }
}

TEST_F(GenerateFiles, AForeignPointsFileIsNotReplaced) {
  std::ofstream(folder_ / "c.ply") << "ply\nformat ascii 1.0\nmy own data\n";
  const std::string mine = bytes_of(folder_ / "c.ply");
  try {
    generate_cloud({1, 50}, folder_ / "c.toml");
    ADD_FAILURE() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
    EXPECT_NE(std::string(error.what()).find("move it, or choose another -o"), std::string::npos) << error.what();
  }
  EXPECT_THROW(generate_final({1, 40}, folder_ / "c.toml"), base::Error);
  EXPECT_EQ(bytes_of(folder_ / "c.ply"), mine);
  EXPECT_EQ(files(), 1u) << "no scene file either";
  generate_final({1, 3}, folder_ / "c.toml");  // has no points file
  EXPECT_EQ(bytes_of(folder_ / "c.ply"), mine);
}

TEST_F(GenerateFiles, AGeneratedPointsFileIsReplaced) {
  generate_cloud({1, 50}, folder_ / "c.toml");
  const std::string first = bytes_of(folder_ / "c.ply");
  generate_cloud({2, 60}, folder_ / "c.toml");
  EXPECT_NE(bytes_of(folder_ / "c.ply"), first);
}

TEST_F(GenerateFiles, SceneAndPointsMustBeDifferentFiles) {
  generate_cloud({1, 50}, folder_ / "c.toml");
  std::filesystem::remove(folder_ / "c.toml");
  std::filesystem::create_symlink("c.ply", folder_ / "c.toml");
  EXPECT_THROW(generate_cloud({1, 50}, folder_ / "c.toml"), base::Error);
}

}  // namespace
}  // namespace orrery::generate
