// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <fmt/core.h>
#include "base/error.h"
#include "film/picture.h"
#include "image/format.h"
#include "image/header.h"
#include "image/whole_file.h"
#include "image/write.h"

namespace orrery::image {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Sets the attributes of a format.
void add_attributes(Format format, ImageSpec& spec) {
  if (format != Format::kTiff) return;
  spec.attribute("compression", "zip");
  // To write EXIF data OpenImageIO reads back the unfinished file. That fails and loses the image's own directory.
  spec.attribute("tiff:write_exif", 0);
  leave_out_date(spec);
}

}  // namespace

void write_encoded(const std::filesystem::path& file, const film::EncodedPicture& picture, const std::string& software,
                   const std::string& stamp) {
  const Format format = format_of(file);
  if (!is_display_format(format)) throw base::Error(base::ErrorKind::kInternal, "EXR and HDR hold scene-linear light");
  if (picture.bits > max_bits(format))
    throw base::Error(base::ErrorKind::kUsage, file.string() + " holds 8 bits per channel; PNG and TIFF hold 16");
  check_size(file, picture.width, picture.height);
  if (picture.channels > 3 && !holds_alpha(format))
    throw base::Error(base::ErrorKind::kInternal, file.string() + " cannot hold alpha");
  if (picture.values.size() != static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) *
                                   static_cast<std::size_t>(picture.channels))
    throw base::Error(base::ErrorKind::kInternal,
                      fmt::format("the values of {} do not have the image's size", file.string()));
  ImageSpec spec(picture.width, picture.height, picture.channels,
                 picture.bits == 8 ? TypeDesc::UINT8 : TypeDesc::UINT16);
  if (!software.empty()) spec.attribute("Software", software);
  if (!stamp.empty()) spec.attribute("ImageDescription", fmt::format("{} {}", kStampName, stamp));
  if (picture.channels > 3) spec.attribute("oiio:UnassociatedAlpha", 1);  // else OpenImageIO divides by alpha
  if (picture.is_srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  add_attributes(format, spec);
  const char* const name = info_of(format).library_name;
  if (picture.bits == 8) {
    const std::vector<std::uint8_t> bytes(picture.values.begin(), picture.values.end());
    write_whole(file, name, TypeDesc::UINT8, {{spec, bytes.data()}});
  } else {
    write_whole(file, name, TypeDesc::UINT16, {{spec, picture.values.data()}});
  }
}

}  // namespace orrery::image
