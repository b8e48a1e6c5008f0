// SPDX-License-Identifier: Apache-2.0
#include "image/read.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "image/format.h"
#include "image/input.h"

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
  const std::size_t pixels = static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(spec.width);
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

/// Whether alpha differs from 1 in any pixel.
bool has_holes(const film::Picture& picture) {
  const film::Plane* const alpha = picture.find("A");
  return alpha != nullptr && std::any_of(alpha->values.begin(), alpha->values.end(), [](float a) { return a != 1.0f; });
}

std::uint64_t plane_bytes(const ImageSpec& spec) {
  return sizeof(float) * static_cast<std::uint64_t>(spec.full_width) * static_cast<std::uint64_t>(spec.full_height) *
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
  for (const std::string& name : spec.channelnames) picture.planes.push_back({name, {}});
  const auto append_empty = [&](int rows) {
    const std::size_t more = static_cast<std::size_t>(std::max(rows, 0)) * static_cast<std::size_t>(picture.width);
    for (film::Plane& plane : picture.planes) plane.values.resize(plane.values.size() + more);
  };
  const int full_end = spec.full_y + spec.full_height, data_end = spec.y + spec.height;
  append_empty(std::min(spec.y, full_end) - spec.full_y);
  const int step = input.row_step();
  const std::size_t row_values = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels);
  std::vector<float> rows;
  for (int begin = spec.y; begin < std::min(data_end, full_end); begin += step) {
    const int end = std::min(begin + step, data_end);
    if (const std::string wrong = decode_rows(input, begin, end, rows); !wrong.empty()) fail_to_read(file, wrong);
    for (int y = std::max(begin, spec.full_y); y < std::min(end, full_end); ++y)
      append_row(spec, &rows[static_cast<std::size_t>(y - begin) * row_values], picture);
  }
  append_empty(full_end - std::max(data_end, spec.full_y));
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

}  // namespace orrery::image
