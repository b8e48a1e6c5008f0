// SPDX-License-Identifier: Apache-2.0
#include "image/format.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/suggestion.h"

namespace orrery::image {
namespace {

struct Extension {
  const char* name;
  Format format;
};
constexpr Extension kExtensions[] = {{"exr", Format::kExr},   {"hdr", Format::kHdr},   {"png", Format::kPng},
                                     {"tif", Format::kTiff},  {"tiff", Format::kTiff}, {"jpg", Format::kJpeg},
                                     {"jpeg", Format::kJpeg}, {"ppm", Format::kPpm}};

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
  throw base::Error(
      base::ErrorKind::kUsage,
      (extension.empty() ? file.string() + " has no extension" : "." + extension + " is no picture format known here") +
          "; " + (near.empty() ? "" : near + " ") + "known are " + base::joined(known));
}

bool is_display_format(Format format) { return format != Format::kExr && format != Format::kHdr; }

int most_bits(Format format) { return format == Format::kPng || format == Format::kTiff ? 16 : 8; }

}  // namespace orrery::image
