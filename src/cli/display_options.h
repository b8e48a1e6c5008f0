// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/option_checks.h"

namespace orrery::cli {

/// More stops than any scene has: 2^100 would only be infinity by another name.
inline constexpr double kMaxStops = 100;

/// Flags that choose how light is shown. Settings is display::Settings, which this room gets through app.
template <class Settings>
void add_view_options(Command& command, Settings& settings) {
  command.add_option("--ocio", settings.config, "OCIO config; default: $OCIO, and without it the built-in one")
      ->type_name("FILE");
  command.add_option("--display", settings.display, "Display of the OCIO config, such as \"sRGB\"")->type_name("NAME");
  command.add_option("--view", settings.view, "View of that display, such as \"Un-tone-mapped\"")->type_name("NAME");
  command.add_option("--look", settings.look, "Look of the OCIO config to apply before the view")->type_name("NAME");
  command.add_option("--exposure", settings.exposure, "Stops to brighten by")
      ->check(real_number(-kMaxStops, kMaxStops))
      ->type_name("STOPS");
}

/// The same for display formats.
template <class Settings>
void add_display_options(Command& command, Settings& settings, int& bits) {
  add_view_options(command, settings);
  command
      .add_option("--bits", bits,
                  "Bits in a channel of PNG and TIFF; default 8, and 16 for a display of high dynamic range")
      ->check(one_of({"8", "16"}))
      ->type_name("8|16");
}

}  // namespace orrery::cli
