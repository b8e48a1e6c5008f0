// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec3.h"

namespace orrery::film {

/// Kind of values in a plane; determines the storage type and which values are invalid.
enum class PlaneKind : std::uint8_t {
  kLight,   ///< colours: half precision, negative values are invalid
  kVector,  ///< vectors: half precision, any sign
  kData,    ///< distances, ids, counts: single precision, stored losslessly
};

/// Returns whether a channel belongs to the layer `halves`. Its values are NaN where a half has no samples.
inline bool is_half(std::string_view channel) {
  return channel.starts_with("half_a.") || channel.starts_with("half_b.");
}

/// One channel of an image.
struct Plane {
  std::string name;           ///< EXR channel name: "R", "G", "B", "A", "variance.R"
  std::vector<float> values;  ///< width * height, row by row from the top left
  PlaneKind kind = PlaneKind::kLight;

  /// The layer name: the part of `name` before the last dot; empty for R, G, B, A and Z.
  std::string layer() const { return name.substr(0, name.rfind('.') == std::string::npos ? 0 : name.rfind('.')); }
};

/// A finished image: scene-linear planes of one size.
struct Picture {
  int width = 0;   ///< px
  int height = 0;  ///< px
  std::vector<Plane> planes;
  std::vector<float> coverage = {};          ///< of each pixel by what is not background; empty: unknown
  std::optional<math::Vec3d> backdrop = {};  ///< radiance of the background, of images from a file that has it
  int x = 0, y = 0;                          ///< px, position of the upper left pixel in the frame
  int frame_width = 0, frame_height = 0;     ///< px; 0: the image is the whole frame
  std::string color_interop_id = {};         ///< colour space, "lin_rec709_scene"; empty: unknown
  bool is_transparent = false;               ///< A is coverage, even if it is 1 in all pixels
  double pixel_aspect = 1;                   ///< pixel width / height

  const Plane* find(const std::string& name) const {
    for (const Plane& plane : planes)
      if (plane.name == name) return &plane;
    return nullptr;
  }
  /// The plane of this name.
  ///
  /// Errors     base::Error(kBadData) if there is none
  const Plane& at(const std::string& name) const;
};

/// The channel of files that holds Picture::coverage.
inline constexpr const char* kCoverageChannel = "coverage.A";

/// The largest finite half.
inline constexpr float kLargestHalf = 65504.0f;

/// Numbers of invalid values, counted before any display transform.
struct BadValues {
  std::uint64_t nan = 0;
  std::uint64_t infinite = 0;
  std::uint64_t negative = 0;
  std::uint64_t above_half = 0;  ///< finite, but larger in magnitude than kLargestHalf

  bool any() const { return nan + infinite + negative + above_half > 0; }
  BadValues& operator+=(const BadValues& other);
};

/// Counts the invalid values of a plane. Data planes are checked for NaN and infinity only; vectors may be negative.
BadValues count_bad_values(const Plane& plane);

/// A display-encoded image with integer channels, ready for PNG, TIFF, JPEG or PPM.
struct EncodedPicture {
  int width = 0;                      ///< px
  int height = 0;                     ///< px
  int bits = 8;                       ///< 8 or 16; the largest value is 2^bits - 1
  bool is_srgb = false;               ///< the values are sRGB codes
  std::vector<std::uint16_t> values;  ///< width * height * channels, row by row from the top, R G B or R G B A
  int channels = 3;                   ///< 3, or 4 with straight (unpremultiplied) alpha
  double dpi = 0;                     ///< px per inch in print; 0: not known
};

/// Radiance and coverage of one sphere, or of the background, in a pixel.
struct DeepSample {
  float front, back;  ///< range along the view axis, scene units
  float rgb[3];       ///< premultiplied by alpha
  float alpha;        ///< opacity of this sample alone
};

/// A deep image: each pixel holds its samples, nearest first. Compositing them gives the flat image.
struct DeepPicture {
  int width = 0, height = 0;                    ///< px
  std::vector<std::vector<DeepSample>> pixels;  ///< rows from the top
};

}  // namespace orrery::film
