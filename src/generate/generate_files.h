// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "scene/scene.h"

namespace orrery::generate {

struct Cloud;
struct FinalScene;

/// Writes a generated scene: TOML to `file`, points to a file of the same name with the extension .ply.
///
/// A comment at the top describes the scene and gives the command that reproduces it, byte for byte. An existing points
/// file is replaced only if orrery wrote it.
///
/// `force`    replace a scene file that orrery did not write, or that was edited since
/// Errors     base::Error: kUsage for options out of range and for a `file` that ends in .ply; kCannotCreate, before
///            anything is generated, including for files that must not be replaced; kIo
void generate_final(const FinalScene& options, const std::filesystem::path& file, bool force = false);
void generate_cloud(const Cloud& options, const std::filesystem::path& file, bool force = false);

/// Writes a generated environment to an EXR file with float channels, or a planet with half channels. Its attribute
/// `orrery/command` is the command that reproduces the file.
///
/// Errors     base::Error: kUsage for options out of range and for a `file` that is not an EXR; kCannotCreate, before
///            anything is generated; kIo
void generate_studio(int width, const std::filesystem::path& file);
void generate_planet(std::uint64_t seed, int width, const std::filesystem::path& file);
void generate_sky(const scene::Background& sky, int width, const std::filesystem::path& file);

}  // namespace orrery::generate
