// SPDX-License-Identifier: Apache-2.0
#include "image/format.h"

#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_name.h"
#include "base/text.h"
#include "film/picture.h"

namespace orrery::image {
namespace {

/// All formats, in the order of Format.
///
/// OpenImageIO 2.5 limits PNG, Radiance and PPM to 65535 pixels; earlier releases accept more. A TIFF of more than 4 GB
/// becomes a BigTIFF.
const std::vector<FormatInfo>& formats() {
  constexpr int kLargestExr = (1 << 30) - 1;  // keeps window coordinates within 32 bits
  constexpr int kLargestJpeg = 65500;         // libjpeg's JPEG_MAX_DIMENSION
  static const std::vector<FormatInfo> all = {
      {Format::kExr, {"exr"}, "openexr", kLargestExr, false, 0, false, 0, 0},
      {Format::kHdr, {"hdr"}, "hdr", 65535, false, 0, false, 3, 3},
      {Format::kPng, {"png"}, "png", 65535, true, 16, true, 1.8, 4.8},
      {Format::kTiff, {"tif", "tiff"}, "tiff", 1 << 20, true, 16, true, 1.8, 4.8},
      {Format::kJpeg, {"jpg", "jpeg"}, "jpeg", kLargestJpeg, true, 8, false, 0.8, 0.8},
      {Format::kPpm, {"ppm"}, "pnm", 65535, true, 8, false, 3, 3},
      {Format::kSvg, {"svg"}, "", 65535, true, 8, true, 2.4, 2.4}};
  return all;
}

}  // namespace

const FormatInfo& info_of(Format format) { return formats().at(static_cast<std::size_t>(format)); }

Format format_of(const std::filesystem::path& file) {
  std::string extension = base::extension(file);
  if (!extension.empty()) extension.erase(0, 1);
  std::vector<std::string> known;
  for (const FormatInfo& info : formats()) {
    for (const char* name : info.extensions) {
      if (extension == name) return info.format;
      known.emplace_back(name);
    }
  }
  const std::string near = base::did_you_mean(extension, known);
  base::refuse(
      fmt::format("{}; {}known formats are {}",
                  extension.empty() ? file.string() + " has no extension" : "unknown image format ." + extension,
                  near.empty() ? "" : near + " ", base::joined(known)));
}

void check_size(const std::filesystem::path& file, int width_px, int height_px) {
  const int largest = info_of(format_of(file)).largest_side;
  if (width_px <= largest && height_px <= largest) return;
  base::refuse(fmt::format(
      "{} cannot hold {} x {} pixels: the maximum side of its format is {}; use TIFF or EXR for larger images",
      file.string(), width_px, height_px, largest));
}

bool is_lossy(const std::string& compression) { return compression.starts_with("dwa"); }

void check_compression(const std::string& name) {
  static const std::vector<std::string> plain = {"none", "rle", "zip", "zips", "piz", "dwaa", "dwab"};
  if (base::contains(plain, name)) return;
  const std::size_t colon = name.find(':');
  const std::string word = name.substr(0, colon);
  if (word == "dwaa" || word == "dwab") {
    const auto level = base::number_of<float>(std::string_view(name).substr(colon + 1));
    if (level && std::isfinite(*level) && *level >= 0) return;
  }
  const std::string near = base::did_you_mean(word, plain);
  base::refuse(fmt::format("unknown EXR compression {}; {}known names are {}; dwaa and dwab take a level, e.g. dwaa:45",
                           name, near.empty() ? "" : near + " ", base::joined(plain)));
}

void check_lossless(const std::vector<film::Plane>& planes, const ExrOptions& options) {
  if (options.multipart || !is_lossy(options.compression)) return;
  for (const film::Plane& plane : planes) {
    // The compression takes these channels for colours, by the last component of their names.
    const char last = plane.name.back();
    if (plane.kind == film::PlaneKind::kData && (last == 'R' || last == 'G' || last == 'B'))
      base::refuse(
          fmt::format("compression {} would damage layer {}; use zip, zips or piz, or --multipart, which "
                      "stores data layers without loss",
                      options.compression, plane.layer()));
  }
}

}  // namespace orrery::image
