// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "preview/sink.h"

namespace orrery::preview {

class Screen;

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

/// Makes the sink of a target; null without a preview.
///
/// `screen`   of the terminal, for that target; else null
/// Domain     `screen` outlives the result
/// Errors     those of the sinks
std::unique_ptr<Sink> make_sink(const Target& target, Screen* screen, const OnNote& note);

}  // namespace orrery::preview
