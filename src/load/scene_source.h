// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "format/overrides.h"
#include "points/open_data.h"

namespace orrery::load {

/// A scene as specified on the command line: file, overrides, and a frame of its animation.
struct SceneSource {
  std::filesystem::path file;
  format::Overrides overrides;
  int frame = 1;
  std::shared_ptr<const std::string> text = {};  ///< text of the scene; null: read the file
  bool has_file = true;                          ///< false: `file` is only a name
  points::OpenData open_data = {};               ///< see points::LoadRequest
  /// Identifies the contents of a data file; empty: base::file_version.
  std::function<std::string(const std::filesystem::path&)> data_version = {};
  std::optional<int> typed_lines = {};  ///< see format::ReadOptions
};

}  // namespace orrery::load
