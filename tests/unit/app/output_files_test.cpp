// SPDX-License-Identifier: Apache-2.0
#include "app/output_files.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/scratch_folder.h"

namespace orrery::app {
namespace {

class AppOutputFiles : public testing::Test {
 protected:
  /// What is said about such files, and of which kind it is; nothing where all is well.
  std::string verdict(const std::vector<std::filesystem::path>& pictures, int bits = 0,
                      const std::vector<std::filesystem::path>& others = {}) {
    try {
      check_output_files(pictures, bits, others, {folder_ / "scene.toml"});
    } catch (const base::Error& error) {
      kind_ = error.kind();
      return error.what();
    }
    return {};
  }

  support::ScratchFolder folder_;
  base::ErrorKind kind_{};
};

TEST_F(AppOutputFiles, LeaveNoTraceWhereAllIsWell) {
  EXPECT_EQ(verdict({folder_ / "a.exr", folder_ / "a.png"}, 0, {folder_ / "stats.json"}), "");
  EXPECT_EQ(folder_.count(), 0u);
}

TEST_F(AppOutputFiles, UnknownExtensionsAreUsage) {
  EXPECT_NE(verdict({folder_ / "a.webp"}), "");
  EXPECT_EQ(kind_, base::ErrorKind::kUsage);
}

TEST_F(AppOutputFiles, BitsMustFitTheFormat) {
  EXPECT_EQ(verdict({folder_ / "a.png", folder_ / "a.exr"}, 16), "");
  EXPECT_NE(verdict({folder_ / "a.png", folder_ / "a.jpg"}, 16).find("a.jpg holds 8 bits"), std::string::npos);
  EXPECT_EQ(kind_, base::ErrorKind::kUsage);
}

TEST_F(AppOutputFiles, OneFileByTwoNamesIsFound) {
  std::filesystem::create_directory(folder_ / "sub");
  EXPECT_NE(verdict({folder_ / "a.png", folder_.path() / "sub/../a.png"}).find("written twice"), std::string::npos);
  std::filesystem::create_directory_symlink(folder_ / "sub", folder_ / "link");
  EXPECT_NE(verdict({folder_.path() / "sub/a.png", folder_.path() / "link/a.png"}), "");
  EXPECT_NE(verdict({folder_ / "a.png"}, 0, {folder_ / "a.png"}), "");
  EXPECT_EQ(kind_, base::ErrorKind::kUsage);
}

TEST_F(AppOutputFiles, TheInputIsNotOverwritten) {
  EXPECT_NE(verdict({folder_ / "a.png"}, 0, {folder_ / "scene.toml"}).find("would be overwritten"), std::string::npos);
  EXPECT_EQ(kind_, base::ErrorKind::kUsage);
}

TEST_F(AppOutputFiles, MissingFoldersAreFoundForAllFiles) {
  EXPECT_NE(verdict({folder_ / "a.png", folder_.path() / "none/a.exr"}), "");
  EXPECT_EQ(kind_, base::ErrorKind::kCannotCreate);
  EXPECT_NE(verdict({folder_ / "a.png"}, 0, {folder_.path() / "none/s.json"}), "");
  EXPECT_EQ(kind_, base::ErrorKind::kCannotCreate);
}

}  // namespace
}  // namespace orrery::app
