// SPDX-License-Identifier: Apache-2.0
#include "job/disk_space.h"

#include <cstdint>
#include <string>

#include "job/text.h"
#include "base/error.h"
#include "image/format.h"

namespace orrery::job {
namespace {

// Measured on the book's final scene, 480 x 270, at 4 samples per pixel, and rounded up: noise is what compresses
// least.

/// The part of its size in memory that a channel of an EXR keeps.
double kept_by(const std::string& compression, bool is_float) {
  if (compression == "none") return 1;
  if (compression == "rle") return is_float ? 0.9 : 0.65;
  if (compression.rfind("dwa", 0) == 0) return 0.3;
  return is_float ? 0.7 : 0.5;
}

/// Bytes of a pixel of exact sums, with a preview; what layers add to them; of samples in depth.
constexpr double kPartBytes = 27, kPartLayerBytes = 130, kDeepBytes = 24;

double bytes_per_pixel(const Job& job, const std::filesystem::path& file, std::size_t layer_planes) {
  const bool is_deep_color = job.bits == 16;
  switch (image::format_of(file)) {
    case image::Format::kExr:
      if (is_shard(job)) return kPartBytes + (layer_planes > 0 ? kPartLayerBytes : 0);
      return 4 * (job.exr.as_float ? 4 : 2) * kept_by(job.exr.compression, job.exr.as_float) +
             4 * static_cast<double>(layer_planes) * kept_by(job.exr.compression, true);
    case image::Format::kHdr: return 3;
    case image::Format::kJpeg: return 0.8;
    case image::Format::kPng:
    case image::Format::kTiff: return is_deep_color ? 4.8 : 1.8;
    case image::Format::kPpm: return 3;
  }
  return 0;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

}  // namespace

std::map<std::filesystem::path, double> estimate_disk_space(const Job& job, int width_px, int height_px,
                                                            std::size_t layer_planes) {
  const double pixels = static_cast<double>(width_px) * height_px;
  std::map<std::filesystem::path, double> needed;
  for (const std::filesystem::path& file : job.outputs)
    needed[folder_of(file)] += pixels * bytes_per_pixel(job, file, layer_planes);
  if (!job.deep.empty()) needed[folder_of(job.deep)] += pixels * kDeepBytes;
  return needed;
}

void require_disk_space(const Job& job, const compile::CompiledScene& compiled, std::size_t layer_planes) {
  for (const auto& [folder, bytes] : estimate_disk_space(job, compiled.width, compiled.height, layer_planes)) {
    std::error_code failed;
    const std::filesystem::space_info space = std::filesystem::space(folder, failed);
    const std::uint64_t allowed = job.disk_limit > 0 ? job.disk_limit : space.available;
    if ((failed && job.disk_limit == 0) || static_cast<double>(allowed) >= bytes) continue;
    const std::string need =
        "the pictures need about " + base::bytes_text(static_cast<std::uint64_t>(bytes)) + ", and ";
    throw base::Error(base::ErrorKind::kCannotCreate,
                      job.disk_limit > 0 ? need + base::bytes_text(allowed) + " is what --disk-limit allows; allow more"
                                         : need + folder.string() + " has room for " + base::bytes_text(allowed) +
                                               "; make some, or say --disk-limit to try nevertheless");
  }
}

}  // namespace orrery::job
