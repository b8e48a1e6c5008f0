// SPDX-License-Identifier: Apache-2.0
#include "image/exr_spec.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "base/error.h"
#include "image/header.h"
#include "math/pixels.h"

namespace orrery::image {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

std::vector<float> interleaved(const film::Picture& picture, const std::vector<const film::Plane*>& planes,
                               const std::vector<Range>& ranges, WriteReport& report) {
  const std::size_t pixels = math::pixel_count(picture.width, picture.height);
  std::vector<float> out(pixels * planes.size());
  for (std::size_t c = 0; c < planes.size(); ++c) {
    if (planes[c]->values.size() != pixels)
      throw base::Error(base::ErrorKind::kInternal,
                        fmt::format("plane {} does not have the image's size", planes[c]->name));
    const bool may_be_nan = film::is_half(planes[c]->name);
    for (std::size_t i = 0; i < pixels; ++i) {
      float v = planes[c]->values[i];
      if (may_be_nan && std::isnan(v)) {
        // NaN is kept, because 0 would be a valid measurement.
      } else if (!std::isfinite(v)) {
        v = 0;
        ++report.not_finite;
      } else if (v < ranges[c].smallest || v > ranges[c].largest) {
        v = std::clamp(v, ranges[c].smallest, ranges[c].largest);
        ++report.clamped;
      }
      out[i * planes.size() + c] = v;
    }
  }
  return out;
}

void add_attributes(ImageSpec& spec, const std::vector<Attribute>& attributes) {
  for (const Attribute& a : attributes) {
    if (const auto* text = std::get_if<std::string>(&a.value)) spec.attribute(a.name, *text);
    if (const int* whole = std::get_if<int>(&a.value)) spec.attribute(a.name, *whole);
    if (const float* number = std::get_if<float>(&a.value)) spec.attribute(a.name, *number);
  }
}

void add_header(ImageSpec& spec, const Header& header) {
  const TypeDesc matrix(TypeDesc::FLOAT, TypeDesc::MATRIX44);
  const TypeDesc rational(TypeDesc::INT, TypeDesc::VEC2, TypeDesc::RATIONAL);
  if (!header.software.empty()) spec.attribute("software", header.software);
  if (!header.capture_date.empty()) {
    spec.attribute("DateTime", header.capture_date);  // written as capDate
    spec.attribute("utcOffset", header.utc_offset_s);
  }
  if (header.frames_per_second) spec.attribute("framesPerSecond", rational, header.frames_per_second->data());
  // OpenImageIO translates the lower-case name worldtocamera into OpenEXR's spelling, but not that of worldToNDC.
  if (header.world_to_camera) spec.attribute("worldtocamera", matrix, header.world_to_camera->data());
  if (header.world_to_ndc) spec.attribute("worldToNDC", matrix, header.world_to_ndc->data());
  if (header.focus) spec.attribute("focus", *header.focus);
  if (header.chromaticities)
    spec.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), header.chromaticities->data());
  if (!header.color_interop_id.empty()) spec.attribute("colorInteropID", header.color_interop_id);
  if (!header.stamp.empty()) spec.attribute(kStampName, header.stamp);
  add_attributes(spec, header.attributes);
}

void add_windows(ImageSpec& spec, const film::Picture& picture) {
  spec.x = picture.x;
  spec.y = picture.y;
  if (picture.frame_width > 0) {
    spec.full_width = picture.frame_width;
    spec.full_height = picture.frame_height;
  }
  if (picture.pixel_aspect != 1) spec.attribute("PixelAspectRatio", static_cast<float>(picture.pixel_aspect));
}

}  // namespace orrery::image
