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

/// Why a terminal cannot show colours, by $TERM and $NO_COLOR; empty if it can.
std::string missing_colors(const Environment& environment);

/// The queries to which a terminal answers what it can draw: kitty's graphics, the size of a cell, and the device
/// attributes, which every terminal answers and which therefore come last. Empty for a terminal that would print them.
std::string queries(const Environment& environment);

/// What a terminal has answered.
struct Answers {
  bool kitty = false, sixel = false;
  int cell_width = 0, cell_height = 0;  ///< px; 0: unknown
  bool is_complete = false;             ///< the device attributes have arrived
};

/// Parses answers, of which the rest may not have arrived yet.
///
/// Reference  kitty graphics; xterm control sequences
Answers parse_answers(std::string_view bytes);

/// The best way to draw.
Graphics best_graphics(const Environment& environment, const Answers& answers);

}  // namespace orrery::preview
