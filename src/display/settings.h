// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "math/vec3.h"

namespace orrery::display {

/// Settings of the display transform of scene-linear images.
struct Settings {
  std::string config;                        ///< OCIO config file; empty: $OCIO, or the built-in config if unset
  std::string working_space = "lin_rec709";  ///< the image's colour space: a name, alias or role of the config
  std::string display;                       ///< empty: the config's default
  std::string view;                          ///< empty: the display's default
  std::string look;                          ///< look applied before the view; empty: only the view's own
  std::optional<double> exposure;            ///< stops; empty: none
  /// The page behind the objects, scene-linear: looks of the view do not apply to it. Empty: there is none.
  std::optional<math::Vec3d> backdrop = {};

  double stops() const { return exposure.value_or(0); }
  /// Takes what is empty from others, and their working space and backdrop.
  void complete(const Settings& others);
};

/// The resolved display transform.
struct Choice {
  std::string config;        ///< "built-in", or the config file
  std::string config_id;     ///< OCIO's digest of the text of the config
  std::string transform_id;  ///< OCIO's digest of the display transform, including the contents of LUT files
  std::string display, view;
  std::string working_space;  ///< canonical name in the config
  bool is_hdr = false;        ///< the display is high dynamic range
  bool has_looks = false;     ///< the view has looks, which do not apply to a backdrop

  /// Default bits per channel. With 8 bits, banding is visible on high dynamic range displays.
  int default_bits() const { return is_hdr ? 16 : 8; }
  std::vector<std::string> warnings;  ///< messages of OCIO about the config
};

/// Resolves the settings against the config.
///
/// Errors     base::Error: kMissingInput for a config (or a LUT file of it) that cannot be opened, kBadData for an
///            invalid config, kUsage for an unknown display, view, look or colour space (the message suggests similar
///            names), and for an exposure that is not finite
Choice choose(const Settings& settings);

/// A setting that could not be resolved, and why.
struct NameFault {
  std::string name;  ///< "config", "space", "working", "display", "view" or "look"
  base::Error error;
};

/// Result of look_up().
struct LookUp {
  std::vector<NameFault> faults;
  std::optional<Choice> choice;  ///< set if there are no faults
};

/// Resolves the settings as choose() does, but reports all unknown names instead of only the first.
///
/// Domain     `space` is the space of the scene's colours; it and the working space must be scene-linear
/// Errors     base::Error(kUsage) for an exposure that is not finite; errors of the config and its names become faults
LookUp look_up(const Settings& settings, const std::string& space);

/// Returns `preferred` if the display has a view of this name, else the display's default view.
///
/// Domain     the view of the settings is ignored
/// Result     `preferred` also if the config or the display is not found, which look_up() reports
std::string view_or_default(const Settings& settings, const std::string& preferred);

/// The files that load_config() may open: the given config and the one in $OCIO, if they are files.
std::vector<std::filesystem::path> config_files(const std::string& config);

/// Properties of an image that is about to be rendered.
struct PictureInfo {
  int width = 0, height = 0;  ///< px
  Settings display;           ///< from the command line and the scene
};

}  // namespace orrery::display
