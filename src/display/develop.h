// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/encoded_picture.h"
#include "film/picture.h"

namespace orrery::display {

/// How scene-linear light becomes what a display shows.
struct Settings {
  std::string config;                        ///< file of an OCIO config; empty: $OCIO, and without it the built-in one
  std::string working_space = "lin_rec709";  ///< of the picture: a colour space, role or alias of the config
  std::string display;                       ///< empty: the config's default
  std::string view;                          ///< empty: the display's default
  std::string look;                          ///< empty: none but the view's own
  std::optional<double> exposure;            ///< stops; empty: none

  double stops() const { return exposure.value_or(0); }
};

/// What was chosen, by name.
struct Choice {
  std::string config;     ///< "built-in", or the config's file
  std::string config_id;  ///< OCIO's own digest of the config: another text gives another id
  std::string display, view;
  std::string working_space;       ///< the config's own name of it
  std::vector<std::string> files;  ///< tables that the config's transforms read
  bool is_hdr = false;             ///< what comes out is for a display of high dynamic range

  /// Bits in a channel where nobody asked: steps of 8 are seen on a display of high dynamic range.
  int default_bits() const { return is_hdr ? 16 : 8; }
  std::vector<std::string> warnings;  ///< what OCIO remarked about the config
};

/// Finds out what `settings` come to.
///
/// Errors     base::Error: kMissingInput for a config (or a table that it names) that cannot be opened, kBadData for
/// one
///            that cannot be understood, kUsage for a display, view, look or colour space that it lacks, with near
///            names, and for an exposure that is no finite number
Choice choose(const Settings& settings);

/// What becomes of a picture's alpha.
enum class Alpha {
  kOverBlack,  ///< what is there is shown as over black
  kStraight,   ///< a channel of its own; colours are divided by it before the view is applied
};

/// Develops planes R, G, B: exposure, look, the display's view; rounded to the nearest of 2^bits values.
///
/// NaN and infinities, which whoever calls has counted,
/// become 0 as in files; light beyond the largest half after exposure becomes that. Values outside of the display are
/// clamped. With dither, the fraction that rounding would lose decides how often the higher value is taken, in a
/// pattern that depends on the pixel alone.
///
/// Domain     bits 8 or 16
/// Errors     as choose; kBadData where a plane is missing
/// Cost       40 ns a pixel in the built-in config, 160 through an ACES view
film::EncodedPicture develop(const film::Picture& picture, const Settings& settings, int bits, bool dither = false,
                             Alpha alpha = Alpha::kOverBlack);

/// The version of OpenColorIO that is loaded.
std::string ocio_version();

}  // namespace orrery::display
