// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/option_checks.h"

namespace orrery::cli {

/// More stops than the dynamic range of any scene.
inline constexpr double kMaxStops = 100;

/// Heading of these options in the help.
inline constexpr const char* kDisplayOptions = "Display options";

/// Adds the options of a display transform. `Settings` is display::Settings.
template <class Settings>
void add_view_options(Command& command, Settings& settings) {
  const OptionGroup group(command, kDisplayOptions);
  command.add_option("--ocio", settings.config, "OCIO config; default: the scene's, $OCIO, or the built-in one")
      ->type_name("FILE");
  command.add_option("--display", settings.display, "Display of the OCIO config, e.g. \"sRGB\"")->type_name("NAME");
  command.add_option("--view", settings.view, "View of the display, e.g. \"Un-tone-mapped\"")->type_name("NAME");
  command.add_option("--look", settings.look, "Look of the OCIO config, applied before the view")->type_name("NAME");
  command.add_option("--exposure", settings.exposure, "Exposure in stops; default: the scene's, or 0")
      ->check(real_number(-kMaxStops, kMaxStops))
      ->type_name("STOPS");
}

/// Adds the options of display formats.
template <class Settings>
void add_display_options(Command& command, Settings& settings, int& bits) {
  add_view_options(command, settings);
  const OptionGroup group(command, kDisplayOptions);
  command.add_option("--bits", bits, "Bits per channel of PNG and TIFF; default: 8, or 16 for an HDR display")
      ->check(one_of({"8", "16"}))
      ->type_name("8|16");
}

}  // namespace orrery::cli
