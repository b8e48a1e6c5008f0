// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "format/overrides.h"
#include "points/open_data.h"
#include "scene/forward.h"

namespace orrery::format {

struct ReadResult;

/// The frame that is read by default.
inline constexpr int kFirstFrame = 1;

/// An additional check of a scene, such as for names that the OCIO config does not define.
using SceneCheck = std::function<std::vector<scene::SceneDiagnostic>(const scene::Scene&)>;

struct ReadOptions {
  std::shared_ptr<const std::string> text = {};  ///< text of the scene; null: read the file
  int frame = kFirstFrame;          ///< selects the values of animated keys, and the files and frames of data
  SceneCheck also = {};             ///< called if [color] has no errors
  std::uint64_t memory_limit = 0;   ///< maximum memory for reading the spheres of a data file, bytes; 0: no limit
  points::OpenData open_data = {};  ///< see points::LoadRequest
  bool is_generated = false;        ///< `text` was written by a program: diagnostics omit its lines
};

/// Reads and checks a scene file, and the data files that it names.
///
/// Errors     base::Error: kMissingInput if the scene cannot be opened, or if the only errors are data files that
///            cannot be opened; kIo; kBadData with the diagnostics of the file, the overrides and the points files,
///            each with its location, the first kMaxErrors of them
/// Reference  docs/scene-format.md
ReadResult read_scene(const std::filesystem::path& file, const Overrides& overrides = {},
                      const ReadOptions& options = {});

/// Returns the version of toml++.
std::string toml_version();

}  // namespace orrery::format
