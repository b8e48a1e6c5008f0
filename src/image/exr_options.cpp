// SPDX-License-Identifier: Apache-2.0
#include "image/exr_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "film/picture.h"

namespace orrery::image {
namespace {

bool is_level(std::string_view text) {
  float level = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), level);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(level) && level >= 0;
}

}  // namespace

bool is_lossy(const std::string& compression) { return compression.rfind("dwa", 0) == 0; }

void check_compression(const std::string& name) {
  static const std::vector<std::string> plain = {"none", "rle", "zip", "zips", "piz", "dwaa", "dwab"};
  if (std::find(plain.begin(), plain.end(), name) != plain.end()) return;
  const std::size_t colon = name.find(':');
  const std::string word = name.substr(0, colon);
  if ((word == "dwaa" || word == "dwab") && is_level(std::string_view(name).substr(colon + 1))) return;
  const std::string near = base::did_you_mean(word, plain);
  throw base::Error(
      base::ErrorKind::kUsage,
      fmt::format("unknown EXR compression {}; {}known names are {}; dwaa and dwab take a level, e.g. dwaa:45", name,
                  near.empty() ? "" : near + " ", base::joined(plain)));
}

void check_lossless(const std::vector<film::Plane>& planes, const ExrOptions& options) {
  if (options.multipart || !is_lossy(options.compression)) return;
  for (const film::Plane& plane : planes) {
    // The compression takes these channels for colours, by the last component of their names.
    const char last = plane.name.back();
    if (plane.kind == film::PlaneKind::kData && (last == 'R' || last == 'G' || last == 'B'))
      throw base::Error(base::ErrorKind::kUsage,
                        fmt::format("compression {} would damage layer {}; use zip, zips or piz, or --multipart, which "
                                    "stores data layers without loss",
                                    options.compression, plane.layer()));
  }
}

}  // namespace orrery::image
