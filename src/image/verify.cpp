// SPDX-License-Identifier: Apache-2.0
#include "image/verify.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <new>
#include <vector>

#include "image/damage.h"
#include "image/format.h"
#include "image/header.h"
#include "image/input.h"
#include "image/library.h"
#include "image/write.h"

namespace orrery::image {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;

bool decodes(ImageInput& in, int part, const ImageSpec& spec) {
  std::vector<float> rows;
  for (int y = spec.y; y < spec.y + spec.height; y += row_step(spec)) {
    const int end = std::min(y + row_step(spec), spec.y + spec.height);
    if (spec.deep) {
      OIIO::DeepData deep;
      if (!in.read_native_deep_scanlines(part, 0, y, end, 0, 0, spec.nchannels, deep)) return false;
      continue;
    }
    rows.resize(static_cast<std::size_t>(end - y) * static_cast<std::size_t>(spec.width) *
                static_cast<std::size_t>(spec.nchannels));
    if (!in.read_scanlines(part, 0, y, end, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, rows.data())) return false;
  }
  return true;
}

/// The stamp in a file's attributes; formats without custom attributes have it in their description.
std::string stamp_in(const ImageSpec& spec) {
  const std::string own = spec.get_string_attribute(kStampName);
  if (!own.empty()) return own;
  const std::string text = spec.get_string_attribute("ImageDescription"), begin = std::string(kStampName) + " ";
  return text.rfind(begin, 0) == 0 ? text.substr(begin.size()) : "";
}

}  // namespace

std::string verified_stamp(const std::filesystem::path& file) {
  prepare_library();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return {};
  if (!damage_of(file, format_of(file)).empty()) return {};
  const auto in = ImageInput::open(file.string());
  if (!in) {
    OIIO::geterror();  // OpenImageIO prints messages that are not fetched
    return {};
  }
  std::string stamp = stamp_in(in->spec());
  try {
    for (int part = 0; in->seek_subimage(part, 0) && !stamp.empty(); ++part)
      if (in->spec().tile_width != 0 || !decodes(*in, part, in->spec())) stamp.clear();
  } catch (const std::bad_alloc&) {
    stamp.clear();
  }
  in->geterror();
  return stamp;
}

}  // namespace orrery::image
