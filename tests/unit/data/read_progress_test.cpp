// SPDX-License-Identifier: Apache-2.0
#include "data/read_progress.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "data/byte_source.h"
#include "support/temp_dir.h"

namespace orrery::data {
namespace {

TEST(DataReadProgress, IsThePlaceInTheFileThatWasReadLast) {
  const support::TempDir folder;
  const std::filesystem::path file = folder / "file.txt";
  support::write_bytes(file, std::string(100, ' '));
  const auto progress = std::make_shared<ReadProgress>(0);
  Bytes bytes;
  {
    const ReadProgressScope scope(progress);
    bytes = ByteSource::open(file, 1000);
  }
  EXPECT_FALSE(ReadProgressScope::current());
  bytes->text(50, 25);
  EXPECT_EQ(*progress, 0.75);
  bytes->text(0, 10);
  EXPECT_EQ(*progress, 0.1);
  ByteSource::open(file, 1000)->text(0, 100);
  EXPECT_EQ(*progress, 0.1) << "a file that was opened outside reports nothing";
}

}  // namespace
}  // namespace orrery::data
