// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/huge_pages.h"
#include "compile/forward.h"
#include "film/layers.h"
#include "image/header.h"
#include "job/outputs.h"
#include "scene/forward.h"

namespace orrery::job {

/// The layers that are Cryptomattes.
inline constexpr std::array kMatteLayers = {"CryptoObject", "CryptoMaterial", "CryptoGroup"};

/// The names in a Cryptomatte, as stored in its EXR header.
struct MatteNames {
  std::string layer;                                          ///< "CryptoObject"
  std::vector<std::pair<std::string, std::uint32_t>> things;  ///< unique names and their ids
};

/// The layers that a scene requests.
struct Layers {
  film::LayerRequest request;
  std::vector<MatteNames> mattes;  ///< one for each matte of the request
};

/// Returns the layer request and the mattes for the names in [output]. CryptoGroup is empty for a scene without groups.
///
/// `may_have_looks`  the display transform may need the coverage of objects in front of a backdrop
/// Domain     the scene is valid; `compiled` was compiled from it
Layers choose_layers(const scene::Scene& scene, const compile::CompiledScene& compiled, bool may_have_looks = false);

/// The object of the CryptoObject matte that each sphere and each half of a rod belongs to, as a number.
///
/// Domain     as choose_layers()
base::PackedArray object_classes(const scene::Scene& scene, const compile::CompiledScene& compiled);

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
