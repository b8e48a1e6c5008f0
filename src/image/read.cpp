// SPDX-License-Identifier: Apache-2.0
#include "image/read.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "base/error.h"
#include "base/input_file.h"
#include "image/format.h"
#include "image/library.h"

namespace orrery::image {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Maximum side of an image, as in scenes, px. A header with a larger one is rejected as damaged.
constexpr int kLargestSide = 65536;

/// Rows decoded at a time: a multiple of the block height of every EXR compression except dwab.
constexpr int kRowsAtATime = 64;

/// The line in orrery/settings by which A is coverage.
constexpr const char* kTransparent = "background.alpha = 0\n";

const char* library_name(Format format) {
  switch (format) {
    case Format::kExr: return "openexr";
    case Format::kHdr: return "hdr";
    case Format::kPng: return "png";
    case Format::kTiff: return "tiff";
    case Format::kJpeg: return "jpeg";
    case Format::kPpm: return "pnm";
  }
  return "";
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kBadData, "cannot read image " + file.string() + ": " + reason);
}

/// Decodes rows begin..end of a channel range; false if that fails.
bool decode(ImageInput& in, const ImageSpec& spec, int begin, int end, int first_channel, int end_channel,
            TypeDesc type, void* out) {
  if (spec.tile_width == 0) return in.read_scanlines(0, 0, begin, end, 0, first_channel, end_channel, type, out);
  return in.read_tiles(0, 0, spec.x, spec.x + spec.width, begin, end, 0, 1, first_channel, end_channel, type, out);
}

/// Decodes rows begin..end of all channels, pixel by pixel.
///
/// Result     what is wrong, or empty
std::string decode_rows(ImageInput& in, const ImageSpec& spec, int begin, int end, std::vector<float>& out) {
  const auto complaint = [&] {
    const std::string text = in.geterror();
    return text.empty() ? "its pixels cannot be decoded" : text;
  };
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t pixels = static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(spec.width);
  out.resize(pixels * channels);
  if (!decode(in, spec, begin, end, 0, spec.nchannels, TypeDesc::FLOAT, out.data())) return complaint();
  // Conversion to float would scale the maximum integer to 1, which is wrong for counts and ids.
  for (int c = 0; c < spec.nchannels; ++c) {
    if (spec.channelformat(c) != TypeDesc::UINT) continue;
    std::vector<std::uint32_t> whole(pixels);
    if (!decode(in, spec, begin, end, c, c + 1, TypeDesc::UINT, whole.data())) return complaint();
    for (std::size_t i = 0; i < pixels; ++i)
      out[i * channels + static_cast<std::size_t>(c)] = static_cast<float>(whole[i]);
  }
  return {};
}

/// Appends a row of the display window to every plane.
void append_row(const ImageSpec& spec, const float* row, film::Picture& picture) {
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const int begin = std::max(spec.x, spec.full_x);
  const int end = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<float>& values = picture.planes[c].values;
    const std::size_t start = values.size();
    values.resize(start + static_cast<std::size_t>(picture.width));
    for (int x = begin; x < end; ++x)
      values[start + static_cast<std::size_t>(x - spec.full_x)] =
          row[static_cast<std::size_t>(x - spec.x) * channels + c];
  }
}

void check_spec(const std::filesystem::path& file, const ImageSpec& spec) {
  const auto too_large = [](int side) { return side < 1 || side > kLargestSide; };
  if (too_large(spec.width) || too_large(spec.height) || too_large(spec.full_width) || too_large(spec.full_height))
    fail(file, "its header says " + std::to_string(spec.full_width) + " x " + std::to_string(spec.full_height) +
                   " pixels; a side must be 1 to " + std::to_string(kLargestSide));
  if (spec.deep) fail(file, "its pixels are deep; flatten them first");
}

/// Whether alpha differs from 1 in any pixel.
bool has_holes(const film::Picture& picture) {
  const film::Plane* const alpha = picture.find("A");
  return alpha != nullptr && std::any_of(alpha->values.begin(), alpha->values.end(), [](float a) { return a != 1.0f; });
}

/// Decodes all rows. Memory grows with the decoded rows, so that a damaged header cannot exhaust it.
film::Picture decode_all(const std::filesystem::path& file, ImageInput& in, const ImageSpec& spec) {
  film::Picture picture;
  picture.width = spec.full_width;
  picture.height = spec.full_height;
  picture.color_interop_id = std::string(spec.get_string_attribute("colorInteropID"));
  picture.is_transparent =
      std::string(spec.get_string_attribute("orrery/settings")).find(kTransparent) != std::string::npos;
  for (const std::string& name : spec.channelnames) picture.planes.push_back({name, {}});
  const auto append_empty = [&](int rows) {
    const std::size_t more = static_cast<std::size_t>(std::max(rows, 0)) * static_cast<std::size_t>(picture.width);
    for (film::Plane& plane : picture.planes) plane.values.resize(plane.values.size() + more);
  };
  const int full_end = spec.full_y + spec.full_height, data_end = spec.y + spec.height;
  append_empty(std::min(spec.y, full_end) - spec.full_y);
  const int step = spec.tile_width == 0 ? kRowsAtATime : spec.tile_height;
  const std::size_t row_values = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels);
  std::vector<float> rows;
  for (int begin = spec.y; begin < std::min(data_end, full_end); begin += step) {
    const int end = std::min(begin + step, data_end);
    if (const std::string wrong = decode_rows(in, spec, begin, end, rows); !wrong.empty()) fail(file, wrong);
    for (int y = std::max(begin, spec.full_y); y < std::min(end, full_end); ++y)
      append_row(spec, &rows[static_cast<std::size_t>(y - begin) * row_values], picture);
  }
  append_empty(full_end - std::max(data_end, spec.full_y));
  return picture;
}

}  // namespace

film::Picture read(const std::filesystem::path& file) {
  prepare_library();
  const Format format = format_of(file);
  base::require_readable(file);
  const auto in = ImageInput::create(library_name(format));
  if (!in)
    throw base::Error(base::ErrorKind::kInternal, "this OpenImageIO cannot read " + file.string() + OIIO::geterror());
  ImageSpec spec;
  if (!in->open(file.string(), spec)) fail(file, in->geterror());
  check_spec(file, spec);
  try {
    film::Picture picture = decode_all(file, *in, spec);
    picture.is_transparent = picture.is_transparent || has_holes(picture);
    in->geterror();  // OpenImageIO prints messages that are not fetched
    return picture;
  } catch (const std::bad_alloc&) {
    fail(file, "there is not enough memory for its pixels");
  } catch (const std::length_error&) {
    fail(file, "there is not enough memory for its pixels");
  }
}

}  // namespace orrery::image
