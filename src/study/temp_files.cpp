// SPDX-License-Identifier: Apache-2.0
#include "study/temp_files.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "base/error.h"
#include "compare/errors.h"
#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "study/study.h"

namespace orrery::study {

TempDir::TempDir() {
  std::error_code failed;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failed);
  std::string name = ((failed ? std::filesystem::path("/tmp") : parent) / "orrery-study-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw base::Error(
        base::ErrorKind::kCannotCreate,
        fmt::format("{}: {}; set $TMPDIR to another folder for temporary files", name, std::strerror(errno)));
  path_ = name;
}

TempDir::~TempDir() {
  std::error_code ignored;  // destructors cannot report errors
  std::filesystem::remove_all(path_, ignored);
}

std::vector<FilePoint> measure_file_axis(const film::Picture& picture) {
  const TempDir scratch;
  const std::filesystem::path file = scratch.path() / "picture.exr";
  std::vector<FilePoint> out;
  for (const bool as_float : {false, true}) {
    for (const char* compression : {"none", "rle", "zips", "zip", "piz", "dwaa", "dwab"}) {
      image::ExrOptions options;
      options.as_float = as_float;
      options.compression = compression;
      FilePoint point;
      point.name = std::string(as_float ? "float " : "half ") + compression;
      point.flags = fmt::format("--type {} --compression {}", as_float ? "float" : "half", compression);
      const auto begin = std::chrono::steady_clock::now();
      image::write_exr(file, picture, {}, options);
      point.write_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      point.bytes = std::filesystem::file_size(file);
      const film::Picture back = image::read(file);
      point.error = compare::pixel_errors(compare::color_of(back), compare::color_of(picture)).display;
      out.push_back(std::move(point));
    }
  }
  return out;
}

}  // namespace orrery::study
