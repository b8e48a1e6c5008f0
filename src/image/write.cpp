// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "base/suggestion.h"
#include "image/whole_file.h"

namespace orrery::image {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// What the numbers of a file can hold.
struct Range {
  float smallest, largest;
};

constexpr Range kHalfRange{-film::kLargestHalf, film::kLargestHalf};
constexpr Range kFloatRange{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max()};
/// A Radiance pixel's exponent ends at 2^127, its mantissa has eight bits.
constexpr Range kRadianceRange{0, 0x1.fep126f};

/// Planes side by side, pixel by pixel, fit for the file.
std::vector<float> interleaved(const film::Picture& picture, const std::vector<const film::Plane*>& planes, Range range,
                               WriteReport& report) {
  const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  std::vector<float> out(pixels * planes.size());
  for (std::size_t c = 0; c < planes.size(); ++c) {
    if (planes[c]->values.size() != pixels)
      throw base::Error(base::ErrorKind::kInternal, "plane " + planes[c]->name + " is not of the picture's size");
    for (std::size_t i = 0; i < pixels; ++i) {
      float v = planes[c]->values[i];
      if (!std::isfinite(v)) {
        v = 0;
        ++report.not_finite;
      } else if (v < range.smallest || v > range.largest) {
        v = std::clamp(v, range.smallest, range.largest);
        ++report.clamped;
      }
      out[i * planes.size() + c] = v;
    }
  }
  return out;
}

void add_header(ImageSpec& spec, const Header& header) {
  const TypeDesc matrix(TypeDesc::FLOAT, TypeDesc::MATRIX44);
  const TypeDesc rational(TypeDesc::INT, TypeDesc::VEC2, TypeDesc::RATIONAL);
  if (!header.software.empty()) spec.attribute("software", header.software);
  if (header.capture_date.empty()) {
    leave_out_date(spec);
  } else {
    spec.attribute("DateTime", header.capture_date);  // capDate, once it is in the file
  }
  if (header.frames_per_second) spec.attribute("framesPerSecond", rational, header.frames_per_second->data());
  // OpenImageIO translates some lower-case names into OpenEXR's own, but not that of the second.
  if (header.world_to_camera) spec.attribute("worldtocamera", matrix, header.world_to_camera->data());
  if (header.world_to_ndc) spec.attribute("worldToNDC", matrix, header.world_to_ndc->data());
  if (header.chromaticities)
    spec.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), header.chromaticities->data());
  if (!header.color_interop_id.empty()) spec.attribute("colorInteropID", header.color_interop_id);
  for (const Attribute& a : header.attributes) {
    if (const auto* text = std::get_if<std::string>(&a.value)) spec.attribute(a.name, *text);
    if (const int* whole = std::get_if<int>(&a.value)) spec.attribute(a.name, *whole);
    if (const float* number = std::get_if<float>(&a.value)) spec.attribute(a.name, *number);
  }
}

bool is_level(std::string_view text) {
  float level = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), level);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(level) && level >= 0;
}

}  // namespace

void check_compression(const std::string& name) {
  static const std::vector<std::string> plain = {"none", "rle", "zip", "zips", "piz", "dwaa", "dwab"};
  if (std::find(plain.begin(), plain.end(), name) != plain.end()) return;
  const std::size_t colon = name.find(':');
  const std::string word = name.substr(0, colon);
  if ((word == "dwaa" || word == "dwab") && is_level(std::string_view(name).substr(colon + 1))) return;
  const std::string near = base::did_you_mean(word, plain);
  throw base::Error(base::ErrorKind::kUsage, "unknown EXR compression " + name + "; " +
                                                 (near.empty() ? "" : near + " ") + "known are " + base::joined(plain) +
                                                 ", the last two also with a level, as in dwaa:45");
}

WriteReport write_exr(const std::filesystem::path& file, const film::Picture& picture, const Header& header,
                      const ExrOptions& options) {
  check_compression(options.compression);
  ImageSpec spec(picture.width, picture.height, static_cast<int>(picture.planes.size()),
                 options.as_float ? TypeDesc::FLOAT : TypeDesc::HALF);
  std::vector<const film::Plane*> planes;
  spec.channelnames.clear();
  for (const film::Plane& plane : picture.planes) {
    if (plane.name == "A") spec.alpha_channel = static_cast<int>(planes.size());
    planes.push_back(&plane);
    spec.channelnames.push_back(plane.name);
  }
  spec.attribute("compression", options.compression);
  add_header(spec, header);
  WriteReport report;
  write_whole(file, "openexr", spec, TypeDesc::FLOAT,
              interleaved(picture, planes, options.as_float ? kFloatRange : kHalfRange, report).data());
  return report;
}

WriteReport write_hdr(const std::filesystem::path& file, const film::Picture& picture) {
  std::vector<const film::Plane*> planes;
  for (const char* name : {"R", "G", "B"}) {
    planes.push_back(picture.find(name));
    if (planes.back() == nullptr)
      throw base::Error(base::ErrorKind::kBadData, std::string("the picture has no channel ") + name);
  }
  WriteReport report;
  const ImageSpec spec(picture.width, picture.height, 3, TypeDesc::FLOAT);
  write_whole(file, "hdr", spec, TypeDesc::FLOAT, interleaved(picture, planes, kRadianceRange, report).data());
  return report;
}

}  // namespace orrery::image
