// SPDX-License-Identifier: Apache-2.0
#include "study/file_axis.h"

#include <chrono>
#include <filesystem>
#include <string>

#include <fmt/core.h>

#include "base/temp_dir.h"
#include "compare/errors.h"
#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "study/study.h"

namespace orrery::study {

std::vector<FilePoint> measure_file_axis(const film::Picture& picture) {
  const base::TempDir scratch;
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
