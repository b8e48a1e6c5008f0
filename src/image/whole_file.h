// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace orrery::image {

/// One picture of a file, which may hold several of one size.
struct WholePart {
  OIIO::ImageSpec spec;
  const void* pixels = nullptr;             ///< spec's width x height x channels values, rows from the top
  const OIIO::DeepData* deep = nullptr;     ///< in place of pixels, where the spec says so
  std::optional<OIIO::TypeDesc> type = {};  ///< of the pixels, where it is not that of the other parts
};

/// Writes pictures through OpenImageIO: under a temporary name, every byte checked, read back, synced, renamed.
///
/// `sealed`   with a digest behind its end, as image/seal.h has it
/// Domain     format is OpenImageIO's own name of it; `type` is that of the pixels; one part, or a format that has more
/// Errors     base::Error: kCannotCreate, kIo; what stood under the name before stands there still
void write_whole(const std::filesystem::path& file, const std::string& format, OIIO::TypeDesc type,
                 const std::vector<WholePart>& parts, bool sealed = false);

/// Keeps OpenImageIO from writing the time of day into a file.
void leave_out_date(OIIO::ImageSpec& spec);

}  // namespace orrery::image
