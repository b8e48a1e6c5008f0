// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "job/layers.h"
#include "job/outputs.h"
#include "image/write.h"

namespace orrery::job {

/// More names than this stand in a file of their own, beside the picture: headers are read whole by everybody.
inline constexpr std::size_t kMostNamesInHeader = 10000;

/// What a Cryptomatte's header says: its name, how names became numbers, and the names, or the file that has them.
///
/// Cost       proportional to the number of names
/// Reference  cryptomatte-1.2
std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes,
                                               const std::filesystem::path& picture);

/// The files that write_manifests will write for the EXR files among the outputs.
std::vector<std::filesystem::path> manifest_files(const std::vector<MatteNames>& mattes, const Outputs& outputs);

/// Writes the files that the header names, PICTURE.CryptoObject.json; none for few names.
///
/// Errors     base::Error: kCannotCreate, kIo
void write_manifests(const std::vector<MatteNames>& mattes, const std::filesystem::path& picture);

}  // namespace orrery::job
