// SPDX-License-Identifier: Apache-2.0
#include "image/read_map.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "image/format.h"
#include "image/input.h"

namespace orrery::image {
namespace {

using OIIO::TypeDesc;

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
  static const std::vector<std::string> names = {"Linear",   "linear",     "scene_linear",
                                                 "lin_srgb", "lin_rec709", "lin_rec709_scene"};
  return std::find(names.begin(), names.end(), color_space) != names.end();
}

}  // namespace

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
  const auto stored = static_cast<std::size_t>(*last - *first + 1), width = static_cast<std::size_t>(spec.width);
  const int full_end = spec.full_y + spec.full_height, data_end = spec.y + spec.height;
  const int begin_x = std::max(spec.x, spec.full_x),
            end_x = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
  std::vector<float> rows, rgb(3 * static_cast<std::size_t>(spec.full_width));
  int y = spec.full_y;
  const auto take_empty = [&](int end) {
    for (; y < std::min(end, full_end); ++y) {
      std::fill(rgb.begin(), rgb.end(), 0.0F);
      take(y - spec.full_y, rgb.data());
    }
  };
  take_empty(spec.y);
  for (int begin = spec.y; begin < std::min(data_end, full_end); begin += input.row_step()) {
    const int end = std::min(begin + input.row_step(), data_end);
    rows.resize(static_cast<std::size_t>(end - begin) * width * stored);
    if (!input.decode(begin, end, *first, *last + 1, TypeDesc::FLOAT, rows.data()))
      fail_to_read(file, input.error_message());
    for (; y < std::min(end, full_end); ++y) {
      const float* const row = &rows[static_cast<std::size_t>(y - begin) * width * stored];
      std::fill(rgb.begin(), rgb.end(), 0.0F);
      for (int x = begin_x; x < end_x; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          rgb[3 * static_cast<std::size_t>(x - spec.full_x) + c] =
              row[static_cast<std::size_t>(x - spec.x) * stored + static_cast<std::size_t>(channels[c] - *first)];
      take(y - spec.full_y, rgb.data());
    }
  }
  take_empty(full_end);
  input.in->geterror();  // OpenImageIO prints messages that are not fetched
}

}  // namespace orrery::image
