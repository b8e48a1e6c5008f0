// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "film/picture.h"

namespace orrery::display {

/// Settings of the display transform of scene-linear images.
struct Settings {
  std::string config;                        ///< OCIO config file; empty: $OCIO, or the built-in config if unset
  std::string working_space = "lin_rec709";  ///< the image's colour space: a name, alias or role of the config
  std::string display;                       ///< empty: the config's default
  std::string view;                          ///< empty: the display's default
  std::string look;                          ///< look applied before the view; empty: only the view's own
  std::optional<double> exposure;            ///< stops; empty: none

  double stops() const { return exposure.value_or(0); }
};

/// The resolved display transform.
struct Choice {
  std::string config;        ///< "built-in", or the config file
  std::string config_id;     ///< OCIO's digest of the config; it changes with the text of the config
  std::string transform_id;  ///< OCIO's digest of the display transform; it changes with the contents of LUT files
  std::string display, view;
  std::string working_space;  ///< canonical name in the config
  bool is_hdr = false;        ///< the result is for a high dynamic range display

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

/// Treatment of an image's alpha.
enum class Alpha {
  kOverBlack,  ///< dropped: the image is shown over black
  kStraight,   ///< kept as a fourth channel; colours are divided by it before the view is applied
};

/// Develops planes R, G, B for a display: applies exposure, look and view, and rounds to `bits` bits.
///
/// NaN and infinities become 0; the caller has counted them. After exposure, values are clamped to the range of half,
/// and after the view to the range of the display. Dither adds noise before rounding, in a pattern that depends on the
/// pixel alone.
///
/// Domain     bits 8 or 16
/// Errors     those of choose; base::Error(kBadData) if a plane is missing
/// Cost       40 ns per pixel with the default view of the built-in config, 160 ns with an ACES view
film::EncodedPicture develop(const film::Picture& picture, const Settings& settings, int bits, bool dither = false,
                             Alpha alpha = Alpha::kOverBlack);

/// A display transform that is set up once and develops pixels in small groups, to 8 bits and without dither. The
/// values are those of develop().
class PixelDeveloper {
 public:
  /// Sets up the display transform.
  ///
  /// Errors     those of choose
  explicit PixelDeveloper(const Settings& settings);
  ~PixelDeveloper();
  PixelDeveloper(const PixelDeveloper&) = delete;
  PixelDeveloper& operator=(const PixelDeveloper&) = delete;

  /// Develops pixels.
  ///
  /// `rgb`      3 * pixels scene-linear values; overwritten
  /// `codes`    3 * pixels
  void operator()(float* rgb, std::size_t pixels, std::uint8_t* codes) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The version of the loaded OpenColorIO library.
std::string ocio_version();

}  // namespace orrery::display
