// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "image/header.h"
#include "job/matte_names.h"

namespace orrery::job {

struct Outputs;

/// Maximum number of names in a manifest in the header. A larger manifest is written to a separate file next to the
/// image, since every reader loads the whole header.
inline constexpr std::size_t kMaxNamesInHeader = 10000;

/// The header attributes of Cryptomattes: layer name, hash, conversion, and the manifest or the name of its file.
///
/// Cost       proportional to the number of names
/// Reference  cryptomatte-1.2
std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes,
                                               const std::filesystem::path& picture);

/// The files that write_manifests writes for the EXR files among the outputs.
std::vector<std::filesystem::path> manifest_files(const std::vector<MatteNames>& mattes, const Outputs& outputs);

/// The files that write_manifests may write for the EXR files among the outputs, whatever the scene requests.
std::vector<std::filesystem::path> possible_manifest_files(const Outputs& outputs);

/// Writes the manifest files that the header names, IMAGE.CryptoObject.json. Small manifests have no such file.
///
/// Errors     base::Error: kCannotCreate, kIo
void write_manifests(const std::vector<MatteNames>& mattes, const std::filesystem::path& picture);

}  // namespace orrery::job
