// SPDX-License-Identifier: Apache-2.0
#include "image/rewrite.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "image/exr_spec.h"
#include "image/format.h"
#include "image/header.h"
#include "image/input.h"
#include "image/sums_file.h"
#include "image/whole_file.h"

namespace orrery::image {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// A part of the input with its undecoded values, pixel by pixel.
struct NativePart {
  ImageSpec spec;
  std::vector<unsigned char> bytes;
};

/// Where a plane is stored.
struct Place {
  std::size_t part;
  int channel;
};

/// Decodes the part of an input in its own types. Memory grows with the decoded rows, so that a damaged header cannot
/// exhaust it.
NativePart read_part(const std::filesystem::path& file, const Input& input) {
  NativePart out{input.spec, {}};
  const ImageSpec& spec = out.spec;
  const std::size_t row_bytes = spec.scanline_bytes(true);
  const int last = spec.y + spec.height;
  for (int y = spec.y; y < last; y += input.row_step()) {
    const int end = std::min(y + input.row_step(), last);
    const std::size_t at = out.bytes.size();
    out.bytes.resize(at + row_bytes * static_cast<std::size_t>(end - y));
    if (!input.decode(y, end, 0, spec.nchannels, TypeDesc::UNKNOWN, &out.bytes[at]))
      fail_to_read(file, input.error_message());
  }
  return out;
}

std::vector<NativePart> read_parts(const std::filesystem::path& file) {
  Input input = open_input(file);
  std::vector<NativePart> parts;
  for (; input.in->seek_subimage(input.part, 0); ++input.part) {
    input.spec = input.in->spec();
    check_spec(file, input.spec);
    for (const OIIO::ParamValue& attribute : input.spec.extra_attribs)
      if (std::string(attribute.name()).starts_with(kSumsPrefix))
        fail_to_read(file, "it is a shard or a checkpoint; merge the shards first");
    parts.push_back(read_part(file, input));
  }
  input.in->geterror();  // of the part after the last
  return parts;
}

std::vector<float> values_of(const NativePart& part, int channel) {
  const ImageSpec& spec = part.spec;
  std::vector<float> out(spec.image_pixels());
  OIIO::convert_image(1, spec.width, spec.height, 1, &part.bytes[spec.pixel_bytes(0, channel, true)],
                      spec.channelformat(channel), static_cast<OIIO::stride_t>(spec.pixel_bytes(true)),
                      OIIO::AutoStride, OIIO::AutoStride, out.data(), TypeDesc::FLOAT, OIIO::AutoStride,
                      OIIO::AutoStride, OIIO::AutoStride);
  return out;
}

void set_values(NativePart& part, int channel, std::vector<float>& values, RewriteReport& report) {
  const ImageSpec& spec = part.spec;
  if (spec.channelformat(channel) == TypeDesc::HALF) {
    for (float& v : values) {
      if (!std::isfinite(v) || std::abs(v) <= film::kLargestHalf) continue;
      v = std::clamp(v, -film::kLargestHalf, film::kLargestHalf);
      ++report.clamped;
    }
  }
  OIIO::convert_image(1, spec.width, spec.height, 1, values.data(), TypeDesc::FLOAT, OIIO::AutoStride, OIIO::AutoStride,
                      OIIO::AutoStride, &part.bytes[spec.pixel_bytes(0, channel, true)], spec.channelformat(channel),
                      static_cast<OIIO::stride_t>(spec.pixel_bytes(true)), OIIO::AutoStride, OIIO::AutoStride);
}

std::string name_of(const NativePart& part) { return std::string(part.spec.get_string_attribute("oiio:subimagename")); }

bool have_same_window(const ImageSpec& a, const ImageSpec& b) {
  return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
}

/// Parts with other colours than the beauty: views, or images with another data window.
std::vector<std::string> parts_with_own_colors(const std::vector<NativePart>& parts) {
  std::vector<std::string> out;
  bool is_first = true;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!base::contains(parts[p].spec.channelnames, "R")) continue;
    if (is_first && have_same_window(parts[p].spec, parts.front().spec)) {
      is_first = false;
    } else {
      out.push_back(name_of(parts[p]).empty() ? std::to_string(p + 1) : name_of(parts[p]));
    }
  }
  return out;
}

/// The planes of the parts, and where each is stored.
std::pair<film::Picture, std::vector<Place>> planes_of_parts(const std::vector<NativePart>& parts) {
  const ImageSpec& first = parts.front().spec;
  film::Picture picture;
  picture.width = first.width;
  picture.height = first.height;
  std::vector<Place> places;
  std::set<std::string> names;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const ImageSpec& spec = parts[p].spec;
    if (!have_same_window(spec, first)) continue;
    for (int c = 0; c < spec.nchannels; ++c) {
      const TypeDesc type = spec.channelformat(c);
      if (type != TypeDesc::HALF && type != TypeDesc::FLOAT) continue;
      std::string name = spec.channelnames[static_cast<std::size_t>(c)];
      if (names.count(name) > 0) name = fmt::format("{}.{}", name_of(parts[p]), name);
      if (!names.insert(name).second) continue;
      picture.planes.push_back({name, values_of(parts[p], c)});
      places.push_back({p, c});
    }
  }
  return {std::move(picture), std::move(places)};
}

}  // namespace

RewriteReport rewrite_exr(const std::filesystem::path& input, const std::filesystem::path& output,
                          const EditPlanes& edit) {
  for (const std::filesystem::path& file : {input, output})
    if (format_of(file) != Format::kExr) base::refuse(file.string() + " is not an EXR file");
  std::vector<NativePart> parts;
  std::pair<film::Picture, std::vector<Place>> planes;
  try {
    parts = read_parts(input);
    planes = planes_of_parts(parts);
  } catch (const std::bad_alloc&) {
    fail_for_memory(input);
  } catch (const std::length_error&) {
    fail_for_memory(input);
  }
  auto& [picture, places] = planes;
  const std::vector<Attribute> attributes = edit(picture);
  RewriteReport report;
  report.other_parts = parts_with_own_colors(parts);
  for (std::size_t i = 0; i < places.size(); ++i)
    set_values(parts[places[i].part], places[i].channel, picture.planes[i].values, report);
  std::vector<WholePart> whole;
  for (NativePart& part : parts) {
    part.spec.erase_attribute(kStampName);
    for (const Attribute& attribute : attributes)
      report.had_attributes = report.had_attributes || part.spec.find_attribute(attribute.name) != nullptr;
    add_attributes(part.spec, attributes);
    whole.push_back({part.spec, part.bytes.data()});
  }
  write_whole(output, "openexr", TypeDesc::UNKNOWN, whole);
  return report;
}

}  // namespace orrery::image
