// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace orrery::cli {

/// Flags that choose how a display format looks. Settings is display::Settings, which this room gets through app.
template <class Settings>
void add_display_options(CLI::App& command, Settings& settings, int& bits) {
  command.add_option("--ocio", settings.config, "OCIO config; default: $OCIO, and without it the built-in one")->type_name("FILE");
  command.add_option("--display", settings.display, "Display of the OCIO config, such as \"sRGB\"")->type_name("NAME");
  command.add_option("--view", settings.view, "View of that display, such as \"Un-tone-mapped\"")->type_name("NAME");
  command.add_option("--look", settings.look, "Look of the OCIO config to apply before the view")->type_name("NAME");
  command.add_option("--exposure", settings.exposure, "Stops to brighten by")->type_name("STOPS")->check(CLI::Range(-100.0, 100.0));
  command.add_option("--bits", bits, "Bits in a channel of display formats: 8 or 16")->check(CLI::IsMember({8, 16}))->type_name("8|16");
}

}  // namespace orrery::cli
