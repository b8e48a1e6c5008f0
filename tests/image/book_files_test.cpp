// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "base/error.h"
#include "generate/generate.h"
#include "load/read_scene.h"
#include "support/read_scene_file.h"

namespace orrery {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = ORRERY_SCENES;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> scene_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

TEST(ImageBookFiles, EverySceneReadsWithoutDiagnostics) {
  const auto files = scene_files(kScenes);
  EXPECT_GE(files.size(), 22u);
  for (const fs::path& file : files) {
    try {
      EXPECT_TRUE(support::read_scene_file(file).warnings.empty()) << file;
    } catch (const base::Error& error) {
      ADD_FAILURE() << error.what();
      for (const base::Diagnostic& diagnostic : error.diagnostics()) ADD_FAILURE() << base::formatted(diagnostic);
    }
  }
}

/// True if the text begins with `title`, after the checksum of a generated file.
bool has_title(const std::string& text, const std::string& title) {
  return text.starts_with(title) || text.find('\n' + title) == text.find('\n');
}

TEST(ImageBookFiles, EverySceneNamesItsSectionOfTheBook) {
  for (const fs::path& file : scene_files(kScenes / "book"))
    EXPECT_TRUE(has_title(text_of(file), "# Ray Tracing in One Weekend, \"")) << file;
}

TEST(ImageBookFiles, EverySceneOfTheNextWeekNamesItsSectionOfTheBook) {
  for (const fs::path& file : scene_files(kScenes / "next-week"))
    EXPECT_TRUE(has_title(text_of(file), "# Ray Tracing: The Next Week, ")) << file;
}

TEST(ImageBookFiles, EverySceneNamesItsRenderCommand) {
  for (const char* folder : {"book", "next-week"})
    for (const fs::path& file : scene_files(kScenes / folder))
      EXPECT_NE(text_of(file).find("orrery render " + file.filename().string() + " -o "), std::string::npos) << file;
}

TEST(ImageBookFiles, EverySceneIsShownInTheReadme) {
  const std::string readme = text_of(kScenes / "README.md");
  for (const fs::path& file : scene_files(kScenes / "book")) {
    EXPECT_NE(readme.find("(book/" + file.filename().string() + ")"), std::string::npos) << file;
    const std::string picture = "thumbnails/" + file.stem().string() + ".png";
    EXPECT_NE(readme.find("(" + picture + ")"), std::string::npos) << picture;
    EXPECT_TRUE(fs::exists(kScenes / picture)) << picture;
  }
}

TEST(ImageBookFiles, FinalSceneMatchesGenerate) {
  const fs::path folder = fs::path(testing::TempDir()) / "orrery-book-files";
  fs::create_directories(folder);
  generate::generate_final({}, folder / "final.toml", true);
  EXPECT_TRUE(text_of(folder / "final.toml") == text_of(kScenes / "book/final.toml"))
      << "regenerate it: orrery generate final -o scenes/book/final.toml";
  fs::remove_all(folder);
}

TEST(ImageBookFiles, EverySceneOfTheNextWeekIsInTheReadme) {
  const std::string readme = text_of(kScenes / "README.md");
  for (const fs::path& file : scene_files(kScenes / "next-week"))
    EXPECT_NE(readme.find("(next-week/" + file.filename().string() + ")"), std::string::npos) << file;
}

}  // namespace
}  // namespace orrery
