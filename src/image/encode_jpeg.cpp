// SPDX-License-Identifier: Apache-2.0

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>  // jpeglib.h needs its types
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <jpeglib.h>
// After jpeglib.h:
#include <jerror.h>

#include "base/error.h"
#include "image/checked_file.h"
#include "image/whole_file.h"
#include "image/write.h"

// Declared in OpenImageIO/tiffutils.h, which includes a libtiff header that the OpenImageIO package does not depend on.
OIIO_NAMESPACE_BEGIN
OIIO_API void encode_exif(const ImageSpec& spec, std::vector<char>& blob);
OIIO_API void encode_iptc_iim(const ImageSpec& spec, std::vector<char>& iptc);
OIIO_API std::string encode_xmp(const ImageSpec& spec, bool minimal);
OIIO_NAMESPACE_END

namespace orrery::image {
namespace {

/// libjpeg error handler that leaves libjpeg by longjmp. It skips only C frames and frames without destructors.
struct ErrorManager {
  jpeg_error_mgr base;  // must be the first member: libjpeg holds a pointer to it
  std::jmp_buf jump;
  char text[JMSG_LENGTH_MAX];
};

[[noreturn]] void on_error(j_common_ptr info) {
  auto* const errors = reinterpret_cast<ErrorManager*>(info->err);
  (*info->err->format_message)(info, errors->text);
  std::longjmp(errors->jump, 1);
}

void on_message(j_common_ptr) {}  // libjpeg would print warnings

/// Takes encoded bytes. Returns false if it fails.
using Write = std::function<bool(const JOCTET* bytes, std::size_t count)>;

/// libjpeg destination that passes the bytes on.
struct Destination {
  jpeg_destination_mgr base;  // must be the first member, as above
  Write write;
  std::array<JOCTET, std::size_t{1} << 16> buffer;
};

Destination& destination_of(j_compress_ptr info) { return *reinterpret_cast<Destination*>(info->dest); }

void begin_buffer(j_compress_ptr info) {
  Destination& out = destination_of(info);
  out.base.next_output_byte = out.buffer.data();
  out.base.free_in_buffer = out.buffer.size();
}

/// Errors     libjpeg's, through on_error. A result of FALSE would not be one: it suspends the encoder, whose caller
///            then offers the same row for ever.
boolean empty_buffer(j_compress_ptr info) {
  Destination& out = destination_of(info);
  if (!out.write(out.buffer.data(), out.buffer.size())) ERREXIT(info, JERR_FILE_WRITE);
  begin_buffer(info);
  return TRUE;
}

void end_buffer(j_compress_ptr info) {
  Destination& out = destination_of(info);
  out.write(out.buffer.data(), out.buffer.size() - out.base.free_in_buffer);
}

struct Encoder {
  jpeg_compress_struct info{};
  ErrorManager errors{};
  Destination destination{};
};

/// A JPEG marker segment.
struct Marker {
  int number;
  std::string bytes;
};

/// The comment, EXIF, IPTC and XMP markers as OpenImageIO writes them.
std::vector<Marker> markers_of(const OIIO::ImageSpec& spec) {
  using namespace std::string_literals;  // of texts with zeros
  constexpr int kComment = 0xFE, kExif = 0xE1, kPhotoshop = 0xED;
  std::vector<Marker> out;
  if (const std::string comment = spec.get_string_attribute("ImageDescription"); !comment.empty())
    out.push_back({kComment, comment + '\0'});
  std::vector<char> exif = {'E', 'x', 'i', 'f', 0, 0}, iptc;
  OIIO::encode_exif(spec, exif);
  out.push_back({kExif, {exif.begin(), exif.end()}});
  OIIO::encode_iptc_iim(spec, iptc);
  if (!iptc.empty()) {
    const char size[] = {static_cast<char>(iptc.size() >> 8), static_cast<char>(iptc.size() & 0xff)};
    const std::string begin = "Photoshop 3.0\0"s + "8BIM\4\4\0\0\0\0"s + std::string(size, 2);
    out.push_back({kPhotoshop, begin + std::string(iptc.begin(), iptc.end())});
  }
  if (const std::string xmp = OIIO::encode_xmp(spec, true); !xmp.empty())
    out.push_back({kExif, "http://ns.adobe.com/xap/1.0/\0"s + xmp});
  return out;
}

struct Pixels {
  int width, height;  ///< px
  const std::uint8_t* codes;
  int quality;  ///< 1 to 100; below kJpegQuality, colour has half the resolution
};

/// Runs libjpeg. Must not have local objects with destructors, since errors longjmp over this frame.
void compress(jpeg_compress_struct& info, const Pixels& pixels, const std::vector<Marker>& markers) {
  info.image_width = static_cast<JDIMENSION>(pixels.width);
  info.image_height = static_cast<JDIMENSION>(pixels.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, pixels.quality, TRUE);
  if (pixels.quality >= kJpegQuality)
    for (int c = 0; c < 3; ++c) info.comp_info[c].h_samp_factor = info.comp_info[c].v_samp_factor = 1;
  jpeg_start_compress(&info, TRUE);
  for (const Marker& marker : markers)
    jpeg_write_marker(&info, marker.number, reinterpret_cast<const JOCTET*>(marker.bytes.data()),
                      static_cast<unsigned>(marker.bytes.size()));
  const std::size_t row_bytes = static_cast<std::size_t>(pixels.width) * 3;
  while (info.next_scanline < info.image_height) {
    auto* row = const_cast<JSAMPROW>(pixels.codes + info.next_scanline * row_bytes);  // libjpeg only reads it
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
}

/// Returns libjpeg's error message, or an empty string.
std::string encode(const Pixels& pixels, const std::vector<Marker>& markers, Write write) {
  // On the heap: local variables modified between setjmp and longjmp would be indeterminate.
  const auto state = std::make_unique<Encoder>();
  state->info.err = jpeg_std_error(&state->errors.base);
  state->errors.base.error_exit = on_error;
  state->errors.base.output_message = on_message;
  state->destination.base.init_destination = begin_buffer;
  state->destination.base.empty_output_buffer = empty_buffer;
  state->destination.base.term_destination = end_buffer;
  state->destination.write = std::move(write);
  if (setjmp(state->errors.jump) == 0) {
    jpeg_create_compress(&state->info);
    state->info.dest = &state->destination.base;
    compress(state->info, pixels, markers);
  }
  jpeg_destroy_compress(&state->info);
  return state->errors.text;
}

}  // namespace

std::string encode_jpeg(const OIIO::ImageSpec& spec, const std::uint8_t* pixels, CheckedFile& file) {
  OIIO::ImageSpec described = spec;
  if (spec.get_string_attribute("oiio:ColorSpace") == "sRGB") described.attribute("Exif:ColorSpace", 1);
  // CheckedFile also keeps a failure until finish().
  return encode({spec.width, spec.height, pixels, kJpegQuality}, markers_of(described),
                [&file](const JOCTET* bytes, std::size_t count) { return file.write(bytes, count) == count; });
}

std::string jpeg_bytes(int width_px, int height_px, const std::uint8_t* codes, int quality) {
  std::string out;
  const std::string error =
      encode({width_px, height_px, codes, quality}, {}, [&out](const JOCTET* bytes, std::size_t count) {
        out.append(reinterpret_cast<const char*>(bytes), count);
        return true;
      });
  if (!error.empty()) throw base::Error(base::ErrorKind::kInternal, "cannot encode JPEG: " + error);
  return out;
}

}  // namespace orrery::image
