// SPDX-License-Identifier: Apache-2.0
#include "data/byte_source.h"

#include <archive.h>
#include <archive_entry.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/read_progress.h"
#include "support/peak_memory.h"
#include "support/temp_dir.h"

namespace orrery::data {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

/// Writes `size` bytes of `text`, repeated, as a gzip file.
void write_gzip(const std::filesystem::path& file, std::uint64_t size, const std::string& text) {
  const gzFile out = gzopen(file.c_str(), "wb1");
  for (std::uint64_t done = 0; done < size; done += text.size())
    gzwrite(out, text.data(), static_cast<unsigned>(std::min<std::uint64_t>(text.size(), size - done)));
  gzclose(out);
}

/// The same as a zstd file.
void write_zstd(const std::filesystem::path& file, std::uint64_t size, const std::string& text) {
  archive* const out = archive_write_new();
  archive_write_add_filter_zstd(out);
  archive_write_set_format_raw(out);
  archive_write_open_filename(out, file.c_str());
  archive_entry* const entry = archive_entry_new();
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_write_header(out, entry);
  for (std::uint64_t done = 0; done < size; done += text.size())
    archive_write_data(out, text.data(), static_cast<std::size_t>(std::min<std::uint64_t>(text.size(), size - done)));
  archive_entry_free(entry);
  archive_write_free(out);
}

/// The message of opening a file; empty if it can be opened.
std::string error_of(const std::filesystem::path& file, std::uint64_t limit) {
  try {
    ByteSource::open(file, limit);
  } catch (const base::Error& error) {
    return error.diagnostics().at(0).text;
  }
  return {};
}

class DataByteSource : public testing::Test {
 protected:
  support::TempDir folder_;
};

TEST_F(DataByteSource, BlocksHaveTheBytesOfTheirParts) {
  ByteBlocks blocks;
  std::string all;
  for (int i = 0; blocks.size() < 3 * kMiB; ++i) {
    const std::string part(static_cast<std::size_t>(i * 77777), static_cast<char>('a' + i));
    blocks.append(part);
    all += part;
  }
  ASSERT_EQ(blocks.size(), all.size());
  const auto source = ByteSource::of_memory("memory", std::move(blocks));
  EXPECT_EQ(source->text(0, all.size()), all);
  EXPECT_EQ(source->text(kMiB - 5, 10), all.substr(kMiB - 5, 10));
  EXPECT_EQ(source->memory(), all.size());
}

TEST_F(DataByteSource, TheLimitIsExact) {
  write_gzip(folder_ / "a.gz", 3 * kMiB, "0123456789");
  write_zstd(folder_ / "a.zst", 3 * kMiB, "0123456789");
  for (const char* name : {"a.gz", "a.zst"}) {
    EXPECT_EQ(ByteSource::open(folder_ / name, 3 * kMiB)->size(), 3 * kMiB) << name;
    EXPECT_EQ(ByteSource::open(folder_ / name, 3 * kMiB)->text(3 * kMiB - 6, 9), "234567") << name;
    EXPECT_NE(error_of(folder_ / name, 3 * kMiB - 1).find("decompresses to more than"), std::string::npos) << name;
  }
}

/// A vector that grows exists twice: a limit that is checked afterwards is exceeded threefold.
TEST_F(DataByteSource, MemoryStaysWithinTheLimit) {
  if (!support::kMeasuresMemory) GTEST_SKIP() << "sanitizers take memory of their own";
  constexpr std::uint64_t kLimit = 64 * kMiB;
  const std::string text(1000, ' ');
  write_gzip(folder_ / "bomb.gz", 4 * kLimit, text);
  write_zstd(folder_ / "bomb.zst", 4 * kLimit, text);
  write_gzip(folder_ / "most.gz", kLimit, text);
  write_gzip(folder_ / "small.gz", 1000, text);
  const std::uint64_t before = support::peak_memory([&] { ByteSource::open(folder_ / "small.gz", kLimit); });
  for (const char* name : {"bomb.gz", "bomb.zst", "most.gz"}) {
    const std::uint64_t peak = support::peak_memory([&] { error_of(folder_ / name, kLimit); });
    EXPECT_LT(peak, before + kLimit + kLimit / 10) << name;
    EXPECT_GT(peak, before + kLimit / 2) << name << ": the measurement works";
  }
}

TEST_F(DataByteSource, AByteOrderMarkIsSkipped) {
  const std::string text = "\xEF\xBB\xBFITEM";
  support::write_bytes(folder_ / "a", text);
  write_gzip(folder_ / "a.gz", text.size(), text);
  for (const char* name : {"a", "a.gz"}) {
    const auto source = ByteSource::open(folder_ / name, kMiB);
    EXPECT_EQ(source->size(), 4u) << name;
    EXPECT_EQ(source->text(0, 10), "ITEM") << name;
    EXPECT_EQ(source->text(1, 2), "TE") << name;
  }
}

TEST_F(DataByteSource, ReportsThePlaceInTheFileThatWasReadLast) {
  const support::TempDir folder;
  support::write_bytes(folder / "file.txt", std::string(100, ' '));
  const auto progress = std::make_shared<base::ReadProgress>(0);
  Bytes bytes;
  {
    const base::ReadProgressScope scope(progress);
    bytes = ByteSource::open(folder / "file.txt", 1000);
  }
  bytes->text(50, 25);
  EXPECT_EQ(*progress, 0.75);
  bytes->text(0, 10);
  EXPECT_EQ(*progress, 0.1);
  ByteSource::open(folder / "file.txt", 1000)->text(0, 100);
  EXPECT_EQ(*progress, 0.1) << "a file that was opened outside reports nothing";
}

}  // namespace
}  // namespace orrery::data
