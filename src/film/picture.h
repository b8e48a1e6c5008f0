// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace orrery::film {

/// What the numbers of a plane are good for.
enum class PlaneKind : std::uint8_t {
  kLight,   ///< colours: half is enough, below 0 is wrong
  kVector,  ///< half is enough, any sign
  kData,    ///< distances, ids, counts: every bit counts
};

/// One channel of a picture.
struct Plane {
  std::string name;           ///< as in the EXR header: "R", "G", "B", "A", "variance.R"
  std::vector<float> values;  ///< width * height, rows from the top, left to right
  PlaneKind kind = PlaneKind::kLight;

  /// What stands before the last dot of its name; empty for R, G, B, A and Z.
  std::string layer() const { return name.substr(0, name.rfind('.') == std::string::npos ? 0 : name.rfind('.')); }
};

/// A finished picture: scene-linear planes of one size.
struct Picture {
  int width = 0;   ///< px
  int height = 0;  ///< px
  std::vector<Plane> planes;
  int x = 0, y = 0;                       ///< px, where its upper left pixel stands within the frame
  int frame_width = 0, frame_height = 0;  ///< px; 0: the picture is the frame
  std::string color_interop_id = {};      ///< the space of its light, "lin_rec709_scene"; empty: not told
  bool is_transparent = false;            ///< A is coverage, also where it is 1 in all pixels
  double pixel_aspect = 1;                ///< a pixel's width by its height

  const Plane* find(const std::string& name) const {
    for (const Plane& plane : planes)
      if (plane.name == name) return &plane;
    return nullptr;
  }
};

/// The largest finite half.
inline constexpr float kLargestHalf = 65504.0f;

/// Values that a display or a file cannot show as they are; counted before any display transform.
struct BadValues {
  std::uint64_t nan = 0;
  std::uint64_t infinite = 0;
  std::uint64_t negative = 0;
  std::uint64_t above_half = 0;  ///< finite but beyond the largest half

  bool any() const { return nan + infinite + negative + above_half > 0; }
  BadValues& operator+=(const BadValues& other);
};

/// Counts what is not fit to be shown in a plane: of data only what is no finite number, of vectors no sign.
BadValues count_bad_values(const Plane& plane);

}  // namespace orrery::film
