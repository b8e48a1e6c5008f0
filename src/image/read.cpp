// SPDX-License-Identifier: Apache-2.0
#include "image/read.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "image/format.h"
#include "image/header.h"
#include "image/input.h"
#include "image/library.h"
#include "math/pixels.h"

namespace orrery::image {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// The line in orrery/settings that marks A as coverage.
constexpr const char* kTransparent = "background.alpha = 0\n";

/// Decodes rows begin..end of all channels, pixel by pixel.
///
/// Result     what is wrong, or empty
std::string decode_rows(const Input& input, int begin, int end, std::vector<float>& out) {
  const ImageSpec& spec = input.spec;
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t pixels = math::pixel_count(spec.width, end - begin);
  out.resize(pixels * channels);
  if (!input.decode(begin, end, 0, spec.nchannels, TypeDesc::FLOAT, out.data())) return input.error_message();
  // Conversion to float would scale the maximum integer to 1, which is wrong for counts and ids.
  for (int c = 0; c < spec.nchannels; ++c) {
    if (spec.channelformat(c) != TypeDesc::UINT) continue;
    std::vector<std::uint32_t> whole(pixels);
    if (!input.decode(begin, end, c, c + 1, TypeDesc::UINT, whole.data())) return input.error_message();
    for (std::size_t i = 0; i < pixels; ++i)
      out[i * channels + static_cast<std::size_t>(c)] = static_cast<float>(whole[i]);
  }
  return {};
}

/// Decodes the rows of the display window from the top, a few at a time, and calls `take(y, row)` for each; the row is
/// null outside the data window.
///
/// `decode`   decodes rows begin..end of the data window, and returns a pointer to the first
template <class Decode, class Take>
void each_row(const Input& input, std::size_t values_per_row, Decode decode, Take take) {
  const ImageSpec& spec = input.spec;
  const int full_end = spec.full_y + spec.full_height, data_end = spec.y + spec.height;
  int y = spec.full_y;
  const auto take_empty = [&](int end) {
    for (; y < std::min(end, full_end); ++y) take(y, nullptr);
  };
  take_empty(spec.y);
  for (int begin = spec.y; begin < std::min(data_end, full_end); begin += input.row_step()) {
    const int end = std::min(begin + input.row_step(), data_end);
    const float* const rows = decode(begin, end);
    for (; y < std::min(end, full_end); ++y) take(y, rows + static_cast<std::size_t>(y - begin) * values_per_row);
  }
  take_empty(full_end);
}

/// Appends a row of the display window to every plane; without a row, zeros.
void append_row(const ImageSpec& spec, const float* row, film::Picture& picture) {
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const int begin = std::max(spec.x, spec.full_x);
  const int end = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<float>& values = picture.planes[c].values;
    const std::size_t start = values.size();
    values.resize(start + static_cast<std::size_t>(picture.width));
    for (int x = begin; x < end && row != nullptr; ++x)
      values[start + static_cast<std::size_t>(x - spec.full_x)] =
          row[static_cast<std::size_t>(x - spec.x) * channels + c];
  }
}

/// Whether alpha differs from 1 in any pixel.
bool has_holes(const film::Picture& picture) {
  const film::Plane* const alpha = picture.find("A");
  return alpha != nullptr && std::any_of(alpha->values.begin(), alpha->values.end(), [](float a) { return a != 1.0f; });
}

std::uint64_t plane_bytes(const ImageSpec& spec) {
  return sizeof(float) * math::pixel_count(spec.full_width, spec.full_height) *
         static_cast<std::uint64_t>(spec.nchannels);
}

/// Decodes all rows. Memory grows with the decoded rows, so that a truncated file does not need that of its header.
film::Picture decode_all(const std::filesystem::path& file, const Input& input, std::uint64_t memory_limit) {
  const ImageSpec& spec = input.spec;
  if (memory_limit > 0 && plane_bytes(spec) > memory_limit)
    throw base::Error(base::ErrorKind::kNoMemory,
                      fmt::format("cannot read image {}: {} x {} pixels of {} channels need {}, and {} is free",
                                  file.string(), spec.full_width, spec.full_height, spec.nchannels,
                                  base::bytes_text(plane_bytes(spec)), base::bytes_text(memory_limit)));
  film::Picture picture;
  picture.width = spec.full_width;
  picture.height = spec.full_height;
  picture.color_interop_id = std::string(spec.get_string_attribute("colorInteropID"));
  picture.is_transparent =
      std::string(spec.get_string_attribute("orrery/settings")).find(kTransparent) != std::string::npos;
  const std::vector<float> rgb =
      OIIO::Strutil::extract_from_list_string<float>(spec.get_string_attribute("orrery/backdrop"), 0, 0.0f, " ");
  if (rgb.size() == 3) picture.backdrop = math::Vec3d{double{rgb[0]}, double{rgb[1]}, double{rgb[2]}};
  for (const std::string& name : spec.channelnames) picture.planes.push_back({name, {}});
  std::vector<float> rows;
  const auto decode = [&](int begin, int end) {
    if (const std::string wrong = decode_rows(input, begin, end, rows); !wrong.empty()) fail_to_read(file, wrong);
    return rows.data();
  };
  each_row(input, static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels), decode,
           [&](int, const float* row) { append_row(spec, row, picture); });
  if (const film::Plane* const coverage = picture.find(film::kCoverageChannel)) picture.coverage = coverage->values;
  return picture;
}

/// Adds the planes of the parts after the first that have the same display window.
void add_other_parts(const std::filesystem::path& file, Input& input, std::uint64_t memory_limit,
                     film::Picture& picture) {
  for (input.part = 1;; ++input.part) {
    input.spec = input.in->spec(input.part);
    if (input.spec.format == TypeDesc::UNKNOWN) break;  // there is no such part
    const ImageSpec& spec = input.spec;
    if (spec.deep || spec.full_width != picture.width || spec.full_height != picture.height) continue;
    check_spec(file, spec);
    const std::string name = std::string(spec.get_string_attribute("oiio:subimagename"));
    for (film::Plane& plane : decode_all(file, input, memory_limit).planes) {
      if (picture.find(plane.name) != nullptr) plane.name = fmt::format("{}.{}", name, plane.name);
      if (picture.find(plane.name) == nullptr) picture.planes.push_back(std::move(plane));
    }
  }
}

/// Positions of R, G and B among the channels.
using Channels = std::array<int, 3>;

Channels channels_of(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
  const std::vector<std::string>& names = spec.channelnames;
  const auto index = [&](const char* name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
  };
  const Channels rgb = {index("R"), index("G"), index("B")};
  if (*std::min_element(rgb.begin(), rgb.end()) >= 0) return rgb;
  if (names.size() == 1) return {0, 0, 0};
  const int grey = index("Y");
  if (names.size() == 2 && grey >= 0 && index("A") >= 0) return {grey, grey, grey};
  fail_to_read(file, "it has no channels R, G and B; it has " + base::joined(names));
}

/// The format that the file's extension selects; empty if unknown.
std::optional<Format> known_format(const std::filesystem::path& file) {
  try {
    return format_of(file);
  } catch (const base::Error&) {
    return {};
  }
}

Input open_map(const std::filesystem::path& file, MapFormats formats) {
  base::require_readable(file);
  const std::optional<Format> format = known_format(file);
  if (formats == MapFormats::kSceneLinear && (!format || is_display_format(*format)))
    fail_to_read(file, "an environment map must be an exr or hdr file");
  if (!format) fail_to_read(file, "a texture must be an exr, hdr, png, tiff, jpeg or ppm file");
  return open_input(file, Alpha::kAsInFile);
}

/// The names with which OpenImageIO reports a file as scene-linear by assumption, without a declaration in the file.
bool is_assumed(const std::string& color_space) {
  return base::contains({"Linear", "linear", "scene_linear", "lin_srgb", "lin_rec709", "lin_rec709_scene"},
                        color_space);
}

/// Whether all pixels of a part can be decoded.
bool is_intact(const Input& input) {
  const int end = input.spec.y + input.spec.height;
  for (int y = input.spec.y; y < end; y += input.row_step())
    if (!input.can_decode(y, std::min(y + input.row_step(), end))) return false;
  return true;
}

/// The stamp in a file's attributes; formats without custom attributes have it in their description.
std::string stamp_in(const ImageSpec& spec) {
  const std::string own = spec.get_string_attribute(kStampName);
  if (!own.empty()) return own;
  const std::string text = spec.get_string_attribute("ImageDescription"), begin = std::string(kStampName) + " ";
  return text.starts_with(begin) ? text.substr(begin.size()) : "";
}

}  // namespace

film::Picture read(const std::filesystem::path& file, Parts parts, std::uint64_t memory_limit) {
  Input input = open_input(file);
  try {
    film::Picture picture = decode_all(file, input, memory_limit);
    // Further pages of a TIFF are other images.
    if (parts == Parts::kAll && format_of(file) == Format::kExr) add_other_parts(file, input, memory_limit, picture);
    picture.is_transparent = picture.is_transparent || has_holes(picture);
    input.in->geterror();  // OpenImageIO prints messages that are not fetched
    return picture;
  } catch (const std::bad_alloc&) {
    fail_for_memory(file);
  } catch (const std::length_error&) {
    fail_for_memory(file);
  }
}

MapHeader read_map_header(const std::filesystem::path& file, MapFormats formats) {
  const Input input = open_map(file, formats);
  const OIIO::ImageSpec& spec = input.spec;
  channels_of(file, spec);
  MapHeader out{spec.full_width, spec.full_height};
  out.is_padded = spec.x > spec.full_x || spec.x + spec.width < spec.full_x + spec.full_width || spec.y > spec.full_y ||
                  spec.y + spec.height < spec.full_y + spec.full_height;
  out.color_interop_id = std::string(spec.get_string_attribute("colorInteropID"));
  out.color_space = std::string(spec.get_string_attribute("oiio:ColorSpace"));
  out.is_half = spec.format == TypeDesc::HALF;
  out.is_encoded = is_display_format(*known_format(file)) && spec.format != TypeDesc::FLOAT;
  // For integers, the name that OpenImageIO reports is an assumption as well.
  if (out.is_encoded || is_assumed(out.color_space)) out.color_space.clear();
  std::array<float, 8> chromaticities;
  if (spec.getattribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), chromaticities.data()))
    out.chromaticities = chromaticities;
  return out;
}

void read_map(const std::filesystem::path& file, const std::function<void(int row, float* rgb)>& take,
              MapFormats formats) {
  const Input input = open_map(file, formats);
  const OIIO::ImageSpec& spec = input.spec;
  const Channels channels = channels_of(file, spec);
  const auto [first, last] = std::minmax_element(channels.begin(), channels.end());
  const auto stored = static_cast<std::size_t>(*last - *first + 1);
  const std::size_t row_values = static_cast<std::size_t>(spec.width) * stored;
  const int begin_x = std::max(spec.x, spec.full_x),
            end_x = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
  std::vector<float> rows, rgb(3 * static_cast<std::size_t>(spec.full_width));
  const auto decode = [&](int begin, int end) {
    rows.resize(static_cast<std::size_t>(end - begin) * row_values);
    if (!input.decode(begin, end, *first, *last + 1, TypeDesc::FLOAT, rows.data()))
      fail_to_read(file, input.error_message());
    return rows.data();
  };
  each_row(input, row_values, decode, [&](int y, const float* row) {
    std::fill(rgb.begin(), rgb.end(), 0.0F);
    for (int x = begin_x; x < end_x && row != nullptr; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        rgb[3 * static_cast<std::size_t>(x - spec.full_x) + c] =
            row[static_cast<std::size_t>(x - spec.x) * stored + static_cast<std::size_t>(channels[c] - *first)];
    take(y - spec.full_y, rgb.data());
  });
  input.in->geterror();  // OpenImageIO prints messages that are not fetched
}

std::string verified_stamp(const std::filesystem::path& file) {
  prepare_library();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return {};
  const Format format = format_of(file);
  if (!damage_of(file, format).empty()) return {};
  // OpenImageIO must not try all formats: stubs replace the libraries of some (docs/decisions/0021).
  Input input{OIIO::ImageInput::create(info_of(format).library_name), {}, 0};
  if (!input.in || !input.in->open(file.string(), input.spec)) {
    input.in ? input.in->geterror() : OIIO::geterror();  // OpenImageIO prints messages that are not fetched
    return {};
  }
  std::string stamp = stamp_in(input.in->spec());
  try {
    for (; input.in->seek_subimage(input.part, 0) && !stamp.empty(); ++input.part) {
      input.spec = input.in->spec();
      if (input.spec.tile_width != 0 || !is_intact(input)) stamp.clear();
    }
  } catch (const std::bad_alloc&) {
    stamp.clear();
  }
  input.in->geterror();
  return stamp;
}

}  // namespace orrery::image
