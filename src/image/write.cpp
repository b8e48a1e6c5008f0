// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <functional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/format.h"

namespace orrery::image {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

[[noreturn]] void io_failed(const std::filesystem::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kIo, "writing " + file.string() + " failed: " + reason);
}

/// Opens what was written and decodes its end: a full disk is not always reported by whoever writes.
void read_back(const std::filesystem::path& file, const std::filesystem::path& temporary, const std::string& format,
               const ImageSpec& written) {
  const auto in = OIIO::ImageInput::create(format);
  ImageSpec spec;
  if (!in || !in->open(temporary.string(), spec)) io_failed(file, "it cannot be read back");
  if (spec.width != written.width || spec.height != written.height || spec.nchannels != written.nchannels)
    io_failed(file, "it reads back as another picture");
  std::vector<float> row(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels));
  if (!in->read_scanline(spec.height - 1, 0, TypeDesc::FLOAT, row.data())) io_failed(file, "its end cannot be read back");
  in->close();
}

/// Writes through OpenImageIO under a temporary name, then renames.
void write_whole(const std::filesystem::path& file, const std::string& format, const ImageSpec& spec, TypeDesc type,
                 const void* pixels) {
  base::AtomicFile target(file);
  const auto out = OIIO::ImageOutput::create(format);
  if (!out) throw base::Error(base::ErrorKind::kInternal, "this OpenImageIO cannot write " + format + " files");
  if (!out->open(target.temporary().string(), spec)) io_failed(file, out->geterror());
  if (!out->write_image(type, pixels)) {
    const std::string reason = out->geterror();
    out->close();
    io_failed(file, reason);
  }
  if (!out->close()) io_failed(file, out->geterror());
  read_back(file, target.temporary(), format, spec);
  target.commit();
}

/// Planes side by side, pixel by pixel, fit for the file.
std::vector<float> interleaved(const film::Picture& picture, const std::vector<const film::Plane*>& planes, float largest,
                               WriteReport& report) {
  const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  std::vector<float> out(pixels * planes.size());
  for (std::size_t c = 0; c < planes.size(); ++c) {
    for (std::size_t i = 0; i < pixels; ++i) {
      float v = planes[c]->values[i];
      if (!std::isfinite(v)) {
        v = 0;
        ++report.not_finite;
      } else if (std::abs(v) > largest) {
        v = std::copysign(largest, v);
        ++report.clamped;
      }
      out[i * planes.size() + c] = v;
    }
  }
  return out;
}

void add_header(ImageSpec& spec, const Header& header) {
  const TypeDesc matrix(TypeDesc::FLOAT, TypeDesc::MATRIX44);
  if (!header.software.empty()) spec.attribute("Software", header.software);
  if (!header.capture_date.empty()) spec.attribute("DateTime", header.capture_date);
  // OpenImageIO translates the lower-case names of the first, but not of the second, into OpenEXR's own.
  if (header.world_to_camera) spec.attribute("worldtocamera", matrix, header.world_to_camera->data());
  if (header.world_to_ndc) spec.attribute("worldToNDC", matrix, header.world_to_ndc->data());
  if (header.chromaticities) spec.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), header.chromaticities->data());
  if (!header.color_interop_id.empty()) spec.attribute("colorInteropID", header.color_interop_id);
  for (const Attribute& a : header.attributes) {
    if (const auto* text = std::get_if<std::string>(&a.value)) spec.attribute(a.name, *text);
    if (const int* whole = std::get_if<int>(&a.value)) spec.attribute(a.name, *whole);
    if (const float* number = std::get_if<float>(&a.value)) spec.attribute(a.name, *number);
  }
}

void check_compression(const std::string& name) {
  const std::string word = name.substr(0, name.find(':'));
  for (const char* known : {"none", "zip", "zips", "piz", "dwaa", "dwab", "rle"})
    if (word == known) return;
  throw base::Error(base::ErrorKind::kUsage,
                    "unknown compression " + name + "; known are none, rle, zip, zips, piz, dwaa:LEVEL, dwab:LEVEL");
}

template <class Narrow>
void write_values(const std::filesystem::path& file, const std::string& format, const ImageSpec& spec, TypeDesc type,
                  const film::EncodedPicture& picture) {
  const std::vector<Narrow> values(picture.values.begin(), picture.values.end());
  write_whole(file, format, spec, type, values.data());
}

}  // namespace

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
  const float largest = options.as_float ? std::numeric_limits<float>::max() : film::kLargestHalf;
  write_whole(file, "openexr", spec, TypeDesc::FLOAT, interleaved(picture, planes, largest, report).data());
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
  write_whole(file, "hdr", spec, TypeDesc::FLOAT,
              interleaved(picture, planes, std::numeric_limits<float>::max(), report).data());
  return report;
}

void write_encoded(const std::filesystem::path& file, const film::EncodedPicture& picture, const std::string& software) {
  const Format format = format_of(file);
  if (picture.bits > most_bits(format))
    throw base::Error(base::ErrorKind::kUsage, file.string() + " holds 8 bits in a channel; PNG and TIFF hold 16");
  ImageSpec spec(picture.width, picture.height, 3, picture.bits == 8 ? TypeDesc::UINT8 : TypeDesc::UINT16);
  if (!software.empty()) spec.attribute("Software", software);
  if (picture.is_srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  std::string name;
  switch (format) {
    case Format::kPng: name = "png"; break;
    case Format::kTiff:
      name = "tiff";
      spec.attribute("compression", "zip");
      break;
    case Format::kJpeg:
      name = "jpeg";
      spec.attribute("compression", "jpeg:95");
      spec.attribute("jpeg:subsampling", "4:4:4");
      break;
    case Format::kPpm: name = "pnm"; break;
    case Format::kExr:
    case Format::kHdr: throw base::Error(base::ErrorKind::kInternal, "EXR and HDR hold scene-linear light");
  }
  if (picture.bits == 8) {
    write_values<std::uint8_t>(file, name, spec, TypeDesc::UINT8, picture);
  } else {
    write_values<std::uint16_t>(file, name, spec, TypeDesc::UINT16, picture);
  }
}

std::string oiio_version() {
  const int v = OIIO::openimageio_version();
  return std::to_string(v / 10000) + "." + std::to_string(v / 100 % 100) + "." + std::to_string(v % 100);
}

}  // namespace orrery::image
