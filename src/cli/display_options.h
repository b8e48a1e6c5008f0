// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/option_checks.h"
#include "scene/limits.h"

namespace orrery::cli {

/// Heading of these options in the help.
inline constexpr const char* kDisplayOptions = "Display options";

/// Origin of the default display settings in the help.
enum class DisplayDefaults { kOfScene, kOfConfig };

/// Adds the options of the display transform. `Settings` is display::Settings.
template <class Settings>
void add_view_options(Command& command, Settings& settings, DisplayDefaults defaults) {
  const std::string scene = defaults == DisplayDefaults::kOfScene ? "the scene's, or " : "";
  const OptionGroup group(command, kDisplayOptions);
  command
      .add_option("--ocio", settings.config,
                  std::string("OCIO config; default: ") + (defaults == DisplayDefaults::kOfScene
                                                               ? "the scene's, $OCIO, or the built-in config"
                                                               : "$OCIO, or the built-in config"))
      ->type_name("FILE");
  command
      .add_option("--display", settings.display,
                  "Display of the OCIO config, e.g. \"sRGB\"; default: " + scene + "the config's")
      ->type_name("NAME");
  command
      .add_option("--view", settings.view,
                  "View of the display, e.g. \"Un-tone-mapped\"; default: " + scene + "the display's")
      ->type_name("NAME");
  command.add_option("--look", settings.look, "Look of the OCIO config, applied before the view")->type_name("NAME");
  command.add_option("--exposure", settings.exposure, "Exposure in stops; default: " + scene + "0")
      ->check(real_number(-scene::kMaxStops, scene::kMaxStops))
      ->type_name("STOPS");
}

/// Adds the options of display formats.
template <class Settings>
void add_display_options(Command& command, Settings& settings, int& bits, DisplayDefaults defaults) {
  add_view_options(command, settings, defaults);
  const OptionGroup group(command, kDisplayOptions);
  command.add_option("--bits", bits, "Bits per channel of PNG and TIFF; default: 8, or 16 for an HDR display")
      ->check(one_of({"8", "16"}))
      ->type_name("8|16");
}

}  // namespace orrery::cli
