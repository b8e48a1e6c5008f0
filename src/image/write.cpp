// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include "base/error.h"
#include "film/picture.h"
#include "image/exr_spec.h"
#include "image/format.h"
#include "image/header.h"
#include "image/library.h"
#include "image/whole_file.h"
#include "math/pixels.h"

namespace orrery::image {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

bool is_matte(const std::string& layer) { return layer.starts_with("Crypto"); }

/// Name and channels of one part.
struct Part {
  std::string name;
  std::vector<const film::Plane*> planes;
};

/// Groups the planes into one part, or into one part per layer. The layers of a matte share a part.
std::vector<Part> make_parts(const film::Picture& picture, bool multipart) {
  std::vector<Part> parts;
  for (const film::Plane& plane : picture.planes) {
    std::string name = plane.layer();
    if (is_matte(name)) name.resize(name.size() - 2);
    if (name.empty()) name = plane.name == "Z" ? "Z" : "rgba";
    if (parts.empty() || (multipart && parts.back().name != name)) parts.push_back({name, {}});
    parts.back().planes.push_back(&plane);
  }
  return parts;
}

ImageSpec spec_of(const film::Picture& picture, const Part& part, const ExrOptions& options) {
  ImageSpec spec(picture.width, picture.height, static_cast<int>(part.planes.size()), TypeDesc::HALF);
  add_windows(spec, picture);
  spec.channelnames.clear();
  bool has_data = false;
  for (const film::Plane* plane : part.planes) {
    if (plane->name == "A") spec.alpha_channel = static_cast<int>(spec.channelnames.size());
    if (plane->name == "Z") spec.z_channel = static_cast<int>(spec.channelnames.size());
    const bool is_data = plane->kind == film::PlaneKind::kData;
    has_data = has_data || is_data;
    spec.channelnames.push_back(plane->name);
    spec.channelformats.push_back(is_data || options.as_float ? TypeDesc::FLOAT : TypeDesc::HALF);
  }
  const bool keep_data = has_data && options.multipart && is_lossy(options.compression);
  spec.attribute("compression", keep_data ? "zips" : options.compression);
  if (options.multipart) spec.attribute("oiio:subimagename", part.name);
  return spec;
}

/// The layout and attributes of a display-encoded image.
ImageSpec encoded_spec(const film::EncodedPicture& picture, const std::string& software, const std::string& stamp) {
  ImageSpec spec(picture.width, picture.height, picture.channels,
                 picture.bits == 8 ? TypeDesc::UINT8 : TypeDesc::UINT16);
  if (!software.empty()) spec.attribute("Software", software);
  if (!stamp.empty()) spec.attribute("ImageDescription", fmt::format("{} {}", kStampName, stamp));
  if (picture.channels > 3) spec.attribute("oiio:UnassociatedAlpha", 1);  // else OpenImageIO divides by alpha
  if (picture.is_srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  if (picture.dpi > 0) {
    spec.attribute("XResolution", static_cast<float>(picture.dpi));
    spec.attribute("YResolution", static_cast<float>(picture.dpi));
    spec.attribute("ResolutionUnit", "in");
  }
  return spec;
}

}  // namespace

WriteReport write_exr(const std::filesystem::path& file, const film::Picture& picture, const Header& header,
                      const ExrOptions& options) {
  check_compression(options.compression);
  check_lossless(picture.planes, options);
  WriteReport report;
  std::vector<WholePart> parts;
  std::vector<std::vector<float>> pixels;
  for (const Part& part : make_parts(picture, options.multipart)) {
    ImageSpec spec = spec_of(picture, part, options);
    add_header(spec, header);
    if (parts.empty() || is_matte(part.name)) add_attributes(spec, header.matte_attributes);
    std::vector<Range> ranges;
    for (const TypeDesc& type : spec.channelformats)
      ranges.push_back(type == TypeDesc::HALF ? kHalfRange : kFloatRange);
    pixels.push_back(interleaved(picture, part.planes, ranges, report));
    parts.push_back({std::move(spec), nullptr});
  }
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].pixels = pixels[i].data();
  write_whole(file, "openexr", TypeDesc::FLOAT, parts);
  return report;
}

void write_deep(const std::filesystem::path& file, const film::DeepPicture& deep, const film::Picture& flat,
                const Header& header) {
  ImageSpec spec(deep.width, deep.height, 6, TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z", "ZBack"};
  spec.alpha_channel = 3;
  spec.z_channel = 4;
  spec.deep = true;
  add_windows(spec, flat);
  spec.attribute("compression", "zips");
  add_header(spec, header);
  OIIO::DeepData data(spec);
  for (std::size_t i = 0; i < deep.pixels.size(); ++i)
    data.set_samples(static_cast<std::int64_t>(i), static_cast<int>(deep.pixels[i].size()));
  for (std::size_t i = 0; i < deep.pixels.size(); ++i) {
    int s = 0;
    for (const film::DeepSample& sample : deep.pixels[i]) {
      int channel = 0;
      for (const float v : {sample.rgb[0], sample.rgb[1], sample.rgb[2], sample.alpha, sample.front, sample.back})
        data.set_deep_value(static_cast<std::int64_t>(i), channel++, s, v);
      ++s;
    }
  }
  WholePart part;
  part.spec = spec;
  part.deep = &data;
  write_whole(file, "openexr", TypeDesc::FLOAT, {part});
}

WriteReport write_hdr(const std::filesystem::path& file, const film::Picture& picture) {
  std::vector<const film::Plane*> planes;
  for (const char* name : {"R", "G", "B"}) planes.push_back(&picture.at(name));
  WriteReport report;
  const ImageSpec spec(picture.width, picture.height, 3, TypeDesc::FLOAT);
  const std::vector<float> pixels = interleaved(picture, planes, {3, kRadianceRange}, report);
  write_whole(file, "hdr", TypeDesc::FLOAT, {{spec, pixels.data()}});
  return report;
}

void write_encoded(const std::filesystem::path& file, const film::EncodedPicture& picture, const std::string& software,
                   const std::string& stamp) {
  const Format format = format_of(file);
  if (!is_display_format(format)) throw base::Error(base::ErrorKind::kInternal, "EXR and HDR hold scene-linear light");
  if (picture.bits > max_bits(format)) base::refuse(file.string() + " holds 8 bits per channel; PNG and TIFF hold 16");
  check_size(file, picture.width, picture.height);
  if (picture.channels > 3 && !holds_alpha(format))
    throw base::Error(base::ErrorKind::kInternal, file.string() + " cannot hold alpha");
  if (picture.values.size() !=
      math::pixel_count(picture.width, picture.height) * static_cast<std::size_t>(picture.channels))
    throw base::Error(base::ErrorKind::kInternal,
                      fmt::format("the values of {} do not have the image's size", file.string()));
  ImageSpec spec = encoded_spec(picture, software, stamp);
  if (format == Format::kTiff) {
    spec.attribute("compression", "zip");
    // To write EXIF data OpenImageIO reads back the unfinished file. That fails and loses the image's own directory.
    spec.attribute("tiff:write_exif", 0);
  }
  const char* const name = info_of(format).library_name;
  if (picture.bits == 8) {
    const std::vector<std::uint8_t> bytes(picture.values.begin(), picture.values.end());
    write_whole(file, name, TypeDesc::UINT8, {{spec, bytes.data()}});
  } else {
    write_whole(file, name, TypeDesc::UINT16, {{spec, picture.values.data()}});
  }
}

std::string png_bytes(const film::EncodedPicture& picture, int compression) {
  prepare_library();
  ImageSpec spec = encoded_spec(picture, "", "");
  spec.attribute("png:compressionLevel", compression);
  const std::vector<std::uint8_t> codes(picture.values.begin(), picture.values.end());
  OIIO::Filesystem::IOVecOutput out;
  const auto encoder = OIIO::ImageOutput::create("png");
  if (!encoder || !encoder->set_ioproxy(&out) || !encoder->open("image.png", spec) ||
      !encoder->write_image(TypeDesc::UINT8, codes.data()) || !encoder->close())
    throw base::Error(base::ErrorKind::kInternal,
                      "cannot encode a PNG: " + (encoder ? encoder->geterror() : OIIO::geterror()));
  return {out.buffer().begin(), out.buffer().end()};
}

}  // namespace orrery::image
