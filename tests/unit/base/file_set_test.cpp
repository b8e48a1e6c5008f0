// SPDX-License-Identifier: Apache-2.0
#include "base/file_set.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::base {
namespace {

namespace fs = std::filesystem;

class BaseFileSet : public testing::Test {
 protected:
  BaseFileSet() {
    support::write_bytes(folder_ / "in", "data");
    fs::create_directory(folder_ / "sub");
    fs::create_directory_symlink("sub", folder_ / "link");
  }

  /// Returns the message about writing one file while another is read or written; empty if there is no conflict.
  static std::string conflict(const fs::path& output, const fs::path& other, bool is_input) {
    FileSet files, reverse;
    std::string found[2];
    const auto add = [&](FileSet& set, bool output_first, std::string& text) {
      try {
        if (output_first) set.reserve(output, "-o");
        is_input ? static_cast<void>(set.add_input(other, "scene")) : set.reserve(other, "--stats");
        if (!output_first) set.reserve(output, "-o");
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kUsage);
        text = error.what();
      }
    };
    add(files, false, found[0]);
    add(reverse, true, found[1]);
    EXPECT_EQ(found[0].empty(), found[1].empty()) << "the order of adding matters";
    return found[0];
  }

  support::TempDir folder_;
};

TEST_F(BaseFileSet, AnInputIsProtectedUnderAnyName) {
  fs::create_symlink("in", folder_ / "soft");
  fs::create_hard_link(folder_ / "in", folder_ / "hard");
  fs::create_symlink("soft", folder_ / "sub/chain");
  const fs::path in = folder_ / "in";
  for (const char* name : {"in", "./in", "sub/../in", "link/../in", "soft", "hard"})
    EXPECT_NE(conflict(folder_.path() / name, in, true), "") << name;
  EXPECT_EQ(conflict(folder_ / "in", in, true),
            in.string() + " (-o) would overwrite " + in.string() + " (scene); choose another name");
  EXPECT_EQ(conflict(folder_ / "out", in, true), "");
}

TEST_F(BaseFileSet, TwoOutputsMustBeDifferentFiles) {
  const fs::path& f = folder_.path();
  EXPECT_NE(conflict(f / "out", f / "out", false), "");
  EXPECT_NE(conflict(f / "sub/out", f / "link/out", false), "") << "neither file exists";
  EXPECT_NE(conflict(f / "none/out", f / "none/../none/out", false), "") << "their folder does not exist either";
  EXPECT_EQ(conflict(f / "sub/out", f / "out", false), "");
  fs::create_hard_link(f / "in", f / "hard");
  EXPECT_NE(conflict(f / "hard", f / "in", false), "");
  fs::create_symlink("../later", f / "sub/dangling");
  EXPECT_NE(conflict(f / "sub/dangling", f / "later", false), "") << "a dangling link is its target";
}

TEST_F(BaseFileSet, ANameStaysTakenWhenItsFileAppearsOrDisappears) {
  FileSet files;
  files.add_output(folder_ / "later", "-o");
  files.add_output(folder_ / "in", "-o");
  support::write_bytes(folder_ / "later", "now");
  fs::remove(folder_ / "in");
  EXPECT_THROW(files.add_input(folder_ / "later", "points file"), Error);
  EXPECT_THROW(files.add_input(folder_ / "in", "points file"), Error);
}

TEST_F(BaseFileSet, AnOutputCanBeCreatedUnlessALaterStepChecksIt) {
  FileSet files;
  try {
    files.add_output(folder_ / "none/out", "-o");
    ADD_FAILURE() << "its folder does not exist";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCannotCreate);
  }
  EXPECT_NO_THROW(files.reserve(folder_ / "none/other", "--stats"));
  EXPECT_NO_THROW(files.add_output(folder_ / "sub/out", "--deep"));
  EXPECT_FALSE(fs::exists(folder_ / "sub/out"));
}

TEST_F(BaseFileSet, AnInputMayBeReadTwice) {
  FileSet files;
  EXPECT_TRUE(files.add_input(folder_ / "in", "part"));
  EXPECT_FALSE(files.add_input(folder_.path() / "./in", "part"));
}

}  // namespace
}  // namespace orrery::base
