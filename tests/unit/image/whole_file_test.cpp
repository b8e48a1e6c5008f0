// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

/// Simulates a full disk: during its lifetime no file of the process can exceed `bytes`.
class FullDisk {
 public:
  explicit FullDisk(std::uintmax_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{static_cast<rlim_t>(bytes), before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

struct Writer {
  std::string name;
  std::function<void(const std::filesystem::path&)> write;
};

void write_exr_as(const std::string& compression, const std::filesystem::path& file) {
  ExrOptions options;
  options.compression = compression;
  write_exr(file, test_picture(130, 90), {}, options);
}

std::vector<Writer> writers() {
  std::vector<Writer> out;
  for (const char* compression : {"zips", "zip", "piz", "none", "dwaa:45"})
    out.push_back({"a.exr", [=](const auto& file) { write_exr_as(compression, file); }});
  out.push_back({"a.hdr", [](const auto& file) { write_hdr(file, test_picture(130, 90)); }});
  for (const char* name : {"a.png", "a.tif", "a.jpg", "a.ppm"})
    out.push_back({name, [](const auto& file) { write_encoded(file, test_encoded(130, 90, 8), "orrery"); }});
  for (const char* name : {"a.png", "a.tif"})
    out.push_back({name, [](const auto& file) { write_encoded(file, test_encoded(130, 90, 16), "orrery"); }});
  return out;
}

TEST(ImageWholeFile, AFullDiskIsAnErrorAndLeavesNoFile) {
  for (const Writer& writer : writers()) {
    const support::TempDir folder;
    writer.write(folder / writer.name);
    const std::uintmax_t size = std::filesystem::file_size(folder / writer.name);
    std::filesystem::remove(folder / writer.name);
    for (const std::uintmax_t room : {std::uintmax_t{0}, std::uintmax_t{1}, std::uintmax_t{100}, size / 3, size / 2,
                                      size - 5000, size - 1000, size - 100, size - 8, size - 2, size - 1}) {
      SCOPED_TRACE(writer.name + ", room for " + std::to_string(room) + " of " + std::to_string(size) + " bytes");
      const FullDisk full(room);
      expect_error(base::ErrorKind::kIo, {writer.name, "File too large"}, [&] { writer.write(folder / writer.name); });
      EXPECT_EQ(folder.count(), 0u);
    }
    const FullDisk just_enough(size);
    EXPECT_NO_THROW(writer.write(folder / writer.name)) << writer.name;
  }
}

TEST(ImageWholeFile, AFailedWriteKeepsTheOldFile) {
  for (const Writer& writer : writers()) {
    const support::TempDir folder;
    support::write_bytes(folder / writer.name, "the old picture");
    {
      const FullDisk full(1000);
      EXPECT_THROW(writer.write(folder / writer.name), base::Error);
    }
    EXPECT_EQ(support::file_bytes(folder / writer.name), "the old picture");
    EXPECT_EQ(folder.count(), 1u);
    writer.write(folder / writer.name);
    EXPECT_NE(support::file_bytes(folder / writer.name), "the old picture");
    EXPECT_EQ(folder.count(), 1u);
  }
}

TEST(ImageWholeFile, AFailurePrintsNothing) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for (const Writer& writer : writers()) {
    const support::TempDir folder;
    writer.write(folder / writer.name);
    const FullDisk full(1000);
    EXPECT_THROW(writer.write(folder / ("b" + writer.name)), base::Error);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(ImageWholeFile, AnUnwritablePathIsReportedWithTheReason) {
  const support::TempDir folder;
  std::filesystem::create_directory(folder / "b.exr");
  for (const Writer& writer : writers()) {
    expect_error(base::ErrorKind::kCannotCreate, {writer.name, "does not exist"},
                 [&] { writer.write(folder / "none" / writer.name); });
  }
  expect_error(base::ErrorKind::kCannotCreate, {"b.exr", "it is a directory"},
               [&] { write_exr(folder / "b.exr", test_picture(2, 2), {}, {}); });
  if (::geteuid() == 0) return;  // root may write anywhere
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_error(base::ErrorKind::kCannotCreate, {"Permission denied"},
               [&] { write_exr(folder / "a.exr", test_picture(2, 2), {}, {}); });
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

TEST(ImageWholeFile, FileNamesMayHoldSpecialCharacters) {
  const support::TempDir folder;
  for (const char* name : {"a b.exr", "a####.exr", "a%04d.exr", "a?b=c&d.exr", "-o.exr", "\xc3\xa4.exr"}) {
    write_exr(folder / name, test_picture(4, 4), {}, {});
    EXPECT_EQ(read(folder / name).width, 4) << name;
  }
  EXPECT_EQ(folder.count(), 6u);
}

}  // namespace
}  // namespace orrery::image
