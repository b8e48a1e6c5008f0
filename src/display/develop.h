// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "film/encoded_picture.h"
#include "film/picture.h"

namespace orrery::display {

/// How scene-linear light becomes what a display shows.
struct Settings {
  std::string config;                       ///< file of an OCIO config; empty: $OCIO, and without it the built-in one
  std::string working_space = "lin_rec709";  ///< of the picture: a colour space, role or alias of the config
  std::string display;                      ///< empty: the config's default
  std::string view;                         ///< empty: the display's default
  std::string look;                         ///< empty: none but the view's own
  double exposure = 0;                      ///< stops
};

/// What was chosen, by name.
struct Choice {
  std::string config;  ///< "built-in", or the config's file
  std::string display, view;
};

/// Finds out what `settings` come to.
///
/// Errors     base::Error: kMissingInput for a config that cannot be opened, kBadData for one that cannot be
///            understood, kUsage for a display, view, look or colour space that it lacks, with near names
Choice choose(const Settings& settings);

/// Develops planes R, G, B: exposure, look, the display's view; rounded to the nearest of 2^bits values.
///
/// Alpha does not count: what is there is shown as over black. Values outside of the display are clamped.
///
/// Domain     bits 8 or 16
/// Errors     as choose; kBadData where a plane is missing
film::EncodedPicture develop(const film::Picture& picture, const Settings& settings, int bits);

/// The version of OpenColorIO that is loaded.
std::string ocio_version();

}  // namespace orrery::display
