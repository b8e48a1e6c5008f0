// SPDX-License-Identifier: Apache-2.0
#include "image/input.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

using base::ErrorKind;

class ImageInput : public testing::Test {
 protected:
  support::TempDir folder_;
};

/// Writes one file of every supported format.
std::vector<std::filesystem::path> write_all(const support::TempDir& folder, int width, int height) {
  std::vector<std::filesystem::path> out;
  for (const char* compression : {"zips", "zip", "piz", "none", "dwaa"}) {
    out.push_back(folder / (std::string(compression) + ".exr"));
    ExrOptions options;
    options.compression = compression;
    write_exr(out.back(), test_picture(width, height), {}, options);
  }
  out.push_back(folder / "a.hdr");
  write_hdr(out.back(), test_picture(width, height));
  for (const char* name : {"a.png", "a.tif", "a.jpg", "a.ppm"}) {
    out.push_back(folder / name);
    write_encoded(out.back(), test_encoded(width, height, 8), "orrery");
  }
  return out;
}

TEST_F(ImageInput, ATruncatedFileIsBadData) {
  for (const auto& file : write_all(folder_, 100, 80)) {
    const std::string bytes = support::file_bytes(file);
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{3}, std::size_t{40}, bytes.size() / 2, bytes.size() - 50}) {
      SCOPED_TRACE(file.filename().string() + " cut to " + std::to_string(size) + " of " +
                   std::to_string(bytes.size()));
      support::write_bytes(file, bytes.substr(0, size));
      testing::internal::CaptureStderr();
      expect_error(ErrorKind::kBadData, {file.filename().string()}, [&] { read(file); });
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "a library printed";
    }
  }
}

TEST_F(ImageInput, ADamagedPngIsBadDataAndNothingIsPrinted) {
  const auto file = folder_ / "a.png";
  write_encoded(file, test_encoded(30, 20, 8), {});
  std::string bytes = support::file_bytes(file);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  support::write_bytes(file, bytes);
  testing::internal::CaptureStderr();
  expect_error(ErrorKind::kBadData, {"a.png", "a checksum does not match"}, [&] { read(file); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ImageInput, DamagedBytesNeverCrashAndPrintNothing) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (const auto& file : write_all(folder_, 24, 20)) {
    const std::string bytes = support::file_bytes(file);
    for (int round = 0; round < 60; ++round) {
      std::string damaged = bytes;
      const std::size_t first = round % 2 == 0 ? std::min<std::size_t>(bytes.size(), 400) : bytes.size();
      for (std::size_t n = 1 + below(4); n > 0; --n) damaged[below(first)] = static_cast<char>(below(256));
      support::write_bytes(file, damaged);
      try {
        const film::Picture picture = read(file);
        for (const film::Plane& plane : picture.planes)
          ASSERT_EQ(plane.values.size(),
                    static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
      } catch (const base::Error& error) {
        EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(ErrorKind::kBadData)) << error.what();
      }
    }
  }
  std::string printed = testing::internal::GetCapturedStdout(), line;
  std::istringstream lines(testing::internal::GetCapturedStderr());
  // libpng prints some messages that OpenImageIO does not catch.
  while (std::getline(lines, line))
    if (line.rfind("libpng ", 0) != 0) printed += line + "\n";
  EXPECT_EQ(printed, "");
}

}  // namespace
}  // namespace orrery::image
