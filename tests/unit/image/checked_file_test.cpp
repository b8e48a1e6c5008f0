// SPDX-License-Identifier: Apache-2.0
#include "image/checked_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <random>
#include <string>

#include "support/temp_dir.h"

namespace orrery::image {
namespace {

TEST(ImageCheckedFile, HoldsTheBytesWrittenInAnyOrder) {
  const support::TempDir folder;
  support::write_bytes(folder / "a", "old content");
  CheckedFile file(folder / "a");
  std::string expected;
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (int i = 0; i < 3000; ++i) {
    const bool large = below(100) == 0;
    const std::string bytes(1 + below(large ? 200000 : 3000), static_cast<char>('a' + below(26)));
    const std::size_t at = below(3) > 0 ? expected.size() : below(expected.size() + 1);
    expected.resize(std::max(expected.size(), at + bytes.size()));
    expected.replace(at, bytes.size(), bytes);
    ASSERT_TRUE(file.seek(static_cast<int64_t>(at)));
    ASSERT_EQ(file.write(bytes.data(), bytes.size()), bytes.size());
    ASSERT_EQ(file.tell(), static_cast<int64_t>(at + bytes.size()));
    ASSERT_EQ(file.size(), expected.size());
    if (below(10) > 0) continue;
    std::string back(below(5000), '\0');
    const std::size_t from = below(expected.size());
    const std::size_t got = file.pread(back.data(), back.size(), static_cast<int64_t>(from));
    ASSERT_EQ(back.substr(0, got), expected.substr(from, back.size()));
  }
  EXPECT_EQ(file.finish(), 0);
  EXPECT_TRUE(support::file_bytes(folder / "a") == expected);
}

TEST(ImageCheckedFile, ReportsWhyItCouldNotBeOpened) {
  const support::TempDir folder;
  CheckedFile file(folder / "none");
  EXPECT_FALSE(file.opened());
  EXPECT_EQ(file.write("x", 1), 0u);
  EXPECT_EQ(file.finish(), ENOENT);
}

TEST(ImageCheckedFile, KeepsTheFailureOfABufferedWrite) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  CheckedFile file("/dev/full");
  EXPECT_EQ(file.write("x", 1), 1u);  // buffered
  EXPECT_EQ(file.finish(), ENOSPC);
}

TEST(ImageCheckedFile, RefusesWritesAfterAFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  CheckedFile file("/dev/full");
  const std::string large(100000, 'x');
  EXPECT_EQ(file.write(large.data(), large.size()), 0u);
  EXPECT_EQ(file.write("x", 1), 0u);
  EXPECT_EQ(file.finish(), ENOSPC);
}

}  // namespace
}  // namespace orrery::image
