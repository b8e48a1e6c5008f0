// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "preview/sink.h"

namespace orrery::preview {

enum class TargetKind { kNone, kTev, kFile };

/// Where a preview is shown.
struct Target {
  TargetKind kind = TargetKind::kNone;
  std::string host, port;      ///< address of tev
  std::filesystem::path file;  ///< PNG, for which the display transform is applied
};

/// Address on which tev listens unless it is started with --hostname.
inline constexpr const char* kTevHost = "127.0.0.1";
inline constexpr const char* kTevPort = "14158";

/// Parses the value of --preview: tev, tev:HOST, tev:HOST:PORT, tev:[IPV6]:PORT, or the name of a PNG.
///
/// Errors     base::Error(kUsage)
Target parse_target(const std::string& text);

/// Makes the sink of a target; null without a preview.
///
/// Errors     those of the sinks
std::unique_ptr<Sink> make_sink(const Target& target, const OnNote& note);

}  // namespace orrery::preview
