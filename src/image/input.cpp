// SPDX-License-Identifier: Apache-2.0
#include "image/input.h"

#include <fmt/core.h>

#include "base/error.h"
#include "base/image_limits.h"
#include "base/input_file.h"
#include "image/damage.h"
#include "image/format.h"
#include "image/library.h"

namespace orrery::image {
namespace {

/// Rows decoded at a time: a multiple of the block height of every EXR compression except dwab.
constexpr int kRowsAtATime = 64;

}  // namespace

void fail_to_read(const std::filesystem::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kBadData, fmt::format("cannot read image {}: {}", file.string(), reason));
}

void fail_for_memory(const std::filesystem::path& file) {
  throw base::Error(base::ErrorKind::kNoMemory,
                    fmt::format("cannot read image {}: there is not enough memory for its pixels", file.string()));
}

void check_spec(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
  const auto too_large = [](int side) { return side < 1 || side > base::kLargestSide; };
  if (too_large(spec.width) || too_large(spec.height) || too_large(spec.full_width) || too_large(spec.full_height))
    fail_to_read(file, fmt::format("its header says {} x {} pixels; a side must be 1 to {}", spec.full_width,
                                   spec.full_height, base::kLargestSide));
  if (spec.deep) fail_to_read(file, "its pixels are deep; flatten them first");
}

int row_step(const OIIO::ImageSpec& spec) { return spec.tile_width == 0 ? kRowsAtATime : spec.tile_height; }

bool Input::decode(int begin, int end, int first_channel, int end_channel, OIIO::TypeDesc type, void* out) const {
  if (spec.tile_width == 0) return in->read_scanlines(part, 0, begin, end, 0, first_channel, end_channel, type, out);
  return in->read_tiles(part, 0, spec.x, spec.x + spec.width, begin, end, 0, 1, first_channel, end_channel, type, out);
}

std::string first_message(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string Input::error_message() const {
  const std::string text = first_message(in->geterror());
  return text.empty() ? "its pixels cannot be decoded" : text;
}

Input open_input(const std::filesystem::path& file, Alpha alpha) {
  prepare_library();
  const Format format = format_of(file);
  base::require_readable(file);
  if (const std::string damage = damage_of(file, format); !damage.empty()) fail_to_read(file, damage);
  Input out{OIIO::ImageInput::create(info_of(format).library_name), {}, 0};
  if (!out.in)
    throw base::Error(base::ErrorKind::kInternal,
                      fmt::format("this OpenImageIO cannot read {}{}", file.string(), OIIO::geterror()));
  OIIO::ImageSpec settings;
  if (alpha == Alpha::kAsInFile) settings.attribute("oiio:UnassociatedAlpha", 1);
  if (!out.in->open(file.string(), out.spec, settings)) fail_to_read(file, first_message(out.in->geterror()));
  check_spec(file, out.spec);
  return out;
}

}  // namespace orrery::image
