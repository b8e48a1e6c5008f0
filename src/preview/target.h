// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::preview {

enum class TargetKind { kNone, kTev, kTerminal, kFile };

/// Where a preview is shown.
struct Target {
  TargetKind kind = TargetKind::kNone;
  std::string host, port;      ///< address of tev
  std::filesystem::path file;  ///< PNG

  /// True if the preview applies the display transform.
  bool is_developed() const { return kind == TargetKind::kTerminal || kind == TargetKind::kFile; }
};

/// Address on which tev listens unless it is started with --hostname.
inline constexpr const char* kTevHost = "127.0.0.1";
inline constexpr const char* kTevPort = "14158";

/// Parses the value of --preview: tev, tev:HOST, tev:HOST:PORT, tev:[IPV6]:PORT, terminal, or the name of a PNG.
///
/// Errors     base::Error(kUsage)
Target parse_target(const std::string& text);

}  // namespace orrery::preview
