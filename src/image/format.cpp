// SPDX-License-Identifier: Apache-2.0
#include "image/format.h"

#include <algorithm>
#include <cctype>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"

namespace orrery::image {
namespace {

struct Extension {
  const char* name;
  Format format;
};
constexpr Extension kExtensions[] = {{"exr", Format::kExr},   {"hdr", Format::kHdr},   {"png", Format::kPng},
                                     {"tif", Format::kTiff},  {"tiff", Format::kTiff}, {"jpg", Format::kJpeg},
                                     {"jpeg", Format::kJpeg}, {"ppm", Format::kPpm}};

/// The maximum side that an encoder accepts, px. OpenImageIO 2.5 limits PNG, Radiance and PPM to 65535; earlier
/// releases accept more. A TIFF of more than 4 GB becomes a BigTIFF.
int largest_side(Format format) {
  switch (format) {
    case Format::kJpeg: return 65500;  // libjpeg's JPEG_MAX_DIMENSION
    case Format::kPng:
    case Format::kHdr:
    case Format::kPpm: return 65535;
    case Format::kTiff: return 1 << 20;
    case Format::kExr: return (1 << 30) - 1;  // keeps window coordinates within 32 bits
  }
  return 0;
}

}  // namespace

Format format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::vector<std::string> known;
  for (const Extension& e : kExtensions) {
    if (extension == e.name) return e.format;
    known.emplace_back(e.name);
  }
  const std::string near = base::did_you_mean(extension, known);
  throw base::Error(base::ErrorKind::kUsage, fmt::format("{}; {}known formats are {}",
                                                         extension.empty() ? file.string() + " has no extension"
                                                                           : "unknown image format ." + extension,
                                                         near.empty() ? "" : near + " ", base::joined(known)));
}

bool is_display_format(Format format) { return format != Format::kExr && format != Format::kHdr; }

bool holds_alpha(Format format) { return format == Format::kPng || format == Format::kTiff; }

void check_size(const std::filesystem::path& file, int width_px, int height_px) {
  const int largest = largest_side(format_of(file));
  if (width_px <= largest && height_px <= largest) return;
  throw base::Error(
      base::ErrorKind::kUsage,
      fmt::format(
          "{} cannot hold {} x {} pixels: the maximum side of its format is {}; use TIFF or EXR for larger images",
          file.string(), width_px, height_px, largest));
}

int max_bits(Format format) { return format == Format::kPng || format == Format::kTiff ? 16 : 8; }

}  // namespace orrery::image
