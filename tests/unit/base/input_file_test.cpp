// SPDX-License-Identifier: Apache-2.0
#include "base/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::base {
namespace {

/// Returns why a file is refused, without its name; empty if it is accepted.
std::string reason(const std::filesystem::path& file) {
  try {
    require_readable(file);
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMissingInput);
    const std::string begin = "cannot open " + file.string() + ": ";
    EXPECT_EQ(std::string(error.what()).rfind(begin, 0), 0u) << error.what();
    return std::string(error.what()).substr(begin.size());
  }
}

TEST(BaseInputFile, OnlyRegularFilesAreInputs) {
  const support::TempDir folder;
  support::write_bytes(folder / "file", "x");
  EXPECT_EQ(reason(folder / "file"), "");
  std::filesystem::create_symlink("file", folder / "link");
  EXPECT_EQ(reason(folder / "link"), "") << "a link counts as its target";
  EXPECT_EQ(reason(folder / "none"), "No such file or directory");
  EXPECT_EQ(reason(folder.path()), "it is a directory");
  EXPECT_EQ(reason("/dev/zero"), "it is not a regular file");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(reason(folder / "pipe"), "it is not a regular file") << "and opening does not wait for a writer";
}

}  // namespace
}  // namespace orrery::base
