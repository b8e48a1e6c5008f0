// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "preview/graphics.h"

namespace orrery::preview {

/// The value of an environment variable; empty if it is not set.
using Environment = std::function<std::string(const char* name)>;

/// The environment of the process.
std::string environment(const char* name);

/// Returns why a terminal shows no colours, according to $TERM and $NO_COLOR; empty if it does.
std::string missing_colors(const Environment& environment);

/// Returns queries for the graphics capabilities of a terminal: kitty graphics, the cell size, and the device
/// attributes, which come last because every terminal answers them. Empty for a terminal that would print the queries.
std::string queries(const Environment& environment);

/// Reply of a terminal to queries().
struct TerminalReply {
  bool kitty = false, sixel = false;
  int cell_width = 0, cell_height = 0;  ///< px; 0: unknown
  bool is_complete = false;             ///< the device attributes have arrived
};

/// Parses a reply, which may still be incomplete.
///
/// Reference  kitty graphics; xterm control sequences
TerminalReply parse_reply(std::string_view bytes);

/// The best way to draw.
Graphics best_graphics(const Environment& environment, const TerminalReply& reply);

}  // namespace orrery::preview
