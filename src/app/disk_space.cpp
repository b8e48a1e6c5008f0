// SPDX-License-Identifier: Apache-2.0
#include "app/disk_space.h"

#include <cstdint>
#include <map>

#include "app/text.h"
#include "base/error.h"
#include "image/format.h"
#include "kernel/pixel_sum.h"

namespace orrery::app {
namespace {

/// Bytes that a pixel of a picture takes at most.
double bytes_per_pixel(const Job& job, const std::filesystem::path& file, std::size_t layer_planes) {
  const double channel = job.bits == 16 ? 2 : 1;
  switch (image::format_of(file)) {
    case image::Format::kExr:
      if (is_part(job)) return 4 * 2 + sizeof(kernel::PixelSum);
      return 4 * (job.exr.as_float ? 4 : 2) + 4 * static_cast<double>(layer_planes);
    case image::Format::kHdr: return 4;
    case image::Format::kJpeg: return 0.5;
    case image::Format::kPng:
    case image::Format::kTiff:
    case image::Format::kPpm: return 3 * channel;
  }
  return 0;
}

}  // namespace

void require_disk_space(const Job& job, const compile::World& world, std::size_t layer_planes) {
  const double pixels = static_cast<double>(world.width) * world.height;
  std::map<std::filesystem::path, double> needed;
  for (const std::filesystem::path& file : job.outputs)
    needed[file.has_parent_path() ? file.parent_path() : "."] += pixels * bytes_per_pixel(job, file, layer_planes);
  for (const auto& [folder, bytes] : needed) {
    std::error_code failed;
    const std::filesystem::space_info space = std::filesystem::space(folder, failed);
    if (failed || static_cast<double>(space.available) >= bytes) continue;
    throw base::Error(base::ErrorKind::kCannotCreate,
                      "the pictures need up to " + bytes_text(static_cast<std::uint64_t>(bytes)) + ", and " +
                          folder.string() + " has room for " + bytes_text(space.available) + "; make some");
  }
}

}  // namespace orrery::app
