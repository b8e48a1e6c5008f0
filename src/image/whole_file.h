// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <string>

namespace orrery::image {

/// Writes a picture through OpenImageIO: under a temporary name, every byte checked, read back, synced, renamed.
///
/// Shape      pixels: spec's width x height x channels values of `type`, rows from the top
/// Domain     format is OpenImageIO's own name of it
/// Errors     base::Error: kCannotCreate, kIo; what stood under the name before stands there still
void write_whole(const std::filesystem::path& file, const std::string& format, const OIIO::ImageSpec& spec,
                 OIIO::TypeDesc type, const void* pixels);

/// Keeps OpenImageIO from writing the time of day into a file.
void leave_out_date(OIIO::ImageSpec& spec);

}  // namespace orrery::image
