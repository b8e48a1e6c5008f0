// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <string>
#include <vector>

namespace orrery::image {

/// One picture of a file, which may hold several of one size.
struct WholePart {
  OIIO::ImageSpec spec;
  const void* pixels = nullptr;          ///< spec's width x height x channels values, rows from the top
  const OIIO::DeepData* deep = nullptr;  ///< in place of pixels, where the spec says so
};

/// Writes pictures through OpenImageIO: under a temporary name, every byte checked, read back, synced, renamed.
///
/// Domain     format is OpenImageIO's own name of it; `type` is that of the pixels; one part, or a format that has more
/// Errors     base::Error: kCannotCreate, kIo; what stood under the name before stands there still
void write_whole(const std::filesystem::path& file, const std::string& format, OIIO::TypeDesc type,
                 const std::vector<WholePart>& parts);

/// Keeps OpenImageIO from writing the time of day into a file.
void leave_out_date(OIIO::ImageSpec& spec);

}  // namespace orrery::image
