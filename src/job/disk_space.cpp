// SPDX-License-Identifier: Apache-2.0
#include "job/disk_space.h"

#include <cstdint>
#include <string>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "film/layer_film.h"
#include "film/layers.h"
#include "image/exr_options.h"
#include "image/format.h"
#include "job/outputs.h"

namespace orrery::job {
namespace {

// Measured on the book's final scene, 480 x 270, at 4 samples per pixel, and rounded up: noise compresses worst.

/// Compressed size of an EXR channel as a fraction of its size in memory.
double compressed_fraction(const std::string& compression, bool is_float) {
  if (compression == "none") return 1;
  if (compression == "rle") return is_float ? 0.9 : 0.65;
  if (compression.rfind("dwa", 0) == 0) return 0.3;
  return is_float ? 0.7 : 0.5;
}

/// Bytes per pixel: of a shard with its preview, of the layers of a shard, of a light group in it, of deep samples. A
/// light group with light in one lobe per pixel takes 39 bytes.
constexpr double kShardBytes = 27, kShardLayerBytes = 130, kShardLightGroupBytes = 40, kDeepBytes = 24;

double bytes_per_pixel(const Outputs& outputs, bool is_shard, image::Format format, const ImageSize& size) {
  const image::ExrOptions& exr = outputs.exr;
  if (format != image::Format::kExr) {
    const image::FormatInfo& info = image::info_of(format);
    return outputs.bits == 16 ? info.bytes_per_pixel_16 : info.bytes_per_pixel;
  }
  if (is_shard)
    return kShardBytes + (size.half_planes + size.float_planes > 0 ? kShardLayerBytes : 0) +
           kShardLightGroupBytes * static_cast<double>(size.light_groups);
  return static_cast<double>(4 + size.half_planes) * (exr.as_float ? 4 : 2) *
             compressed_fraction(exr.compression, exr.as_float) +
         static_cast<double>(size.float_planes) * 4 * compressed_fraction(exr.compression, true);
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

}  // namespace

ImageSize image_size(int width_px, int height_px, const film::LayerRequest& layers) {
  ImageSize size;
  size.width_px = width_px;
  size.height_px = height_px;
  for (const film::Plane& plane : film::planes_of(layers))
    ++(plane.kind == film::PlaneKind::kData ? size.float_planes : size.half_planes);
  size.light_groups = layers.light_groups ? layers.groups.size() : 0;
  return size;
}

std::map<std::filesystem::path, double> estimate_disk_space(const Outputs& outputs, bool is_shard,
                                                            const ImageSize& size) {
  const double pixels = static_cast<double>(size.width_px) * size.height_px;
  std::map<std::filesystem::path, double> needed;
  for (const auto& [file, format] : outputs.images)
    needed[folder_of(file)] += pixels * bytes_per_pixel(outputs, is_shard, format, size);
  if (!outputs.deep.empty()) needed[folder_of(outputs.deep)] += pixels * kDeepBytes;
  return needed;
}

void require_disk_space(const Outputs& outputs, bool is_shard, const ImageSize& size, std::uint64_t limit) {
  for (const auto& [folder, bytes] : estimate_disk_space(outputs, is_shard, size)) {
    std::error_code failed;
    const std::filesystem::space_info space = std::filesystem::space(folder, failed);
    const std::uint64_t allowed = limit > 0 ? limit : space.available;
    if ((failed && limit == 0) || static_cast<double>(allowed) >= bytes) continue;
    const std::string need = base::bytes_text(static_cast<std::uint64_t>(bytes));
    throw base::Error(
        base::ErrorKind::kCannotCreate,
        limit > 0
            ? fmt::format("the images need about {}, but --disk-limit allows only {}; raise the limit", need,
                          base::bytes_text(allowed))
            : fmt::format("the images need about {}, and {} has {} free; free some, or override with --disk-limit",
                          need, folder.string(), base::bytes_text(allowed)));
  }
}

}  // namespace orrery::job
