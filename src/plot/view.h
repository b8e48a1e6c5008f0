// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/vec3.h"
#include "scene/forward.h"

namespace orrery::plot {

using math::Vec3d;

/// Axes of an orthographic view: unit vectors to the right, up, and towards the camera.
struct ViewAxes {
  Vec3d right, up, back;
};

/// Returns the axes of a view.
///
/// `look_from`  "iso": azimuth 45 degrees to the right of the front, elevation 35.26; "+x" .. "-z"; or
///              "azimuth,elevation" in degrees: from the front, to the right and upwards; kDefaultView is one
/// `up`         "x", "y" or "z"
/// Errors       base::Error(kUsage)
ViewAxes view_axes(const std::string& look_from, const std::string& up);

/// A view that shows three faces of a box, none of whose corners is in front of another.
inline constexpr const char* kDefaultView = "30,20";

/// The view of unit cells: a points towards the viewer and somewhat to the left, b to the right, c up.
inline constexpr const char* kCellView = "115,15";
/// The same from further above, for flat data.
inline constexpr const char* kFlatView = "30,40";

/// Whether points lie in a layer perpendicular to the up axis, of less than a quarter of its extent.
///
/// `count`    the number of points to use, from the first
bool are_flat(const scene::PointArray& points, std::size_t count, Vec3d up);

/// Returns the axes of a view along the direction in which points are least extended, with the one in which they are
/// most extended along the longer side of the image. Of the four such views, the one that is closest to `near`.
/// Directions in which the standard deviations differ by less than a tenth are alike: those of `near` are kept among
/// them, so that noise does not turn the view. A ball of points, and a single one, are seen from `near`.
///
/// `count`    the number of points to use, from the first
/// `is_tall`  the image is higher than wide
ViewAxes principal_axes(const scene::PointArray& points, std::size_t count, const ViewAxes& near, bool is_tall);

/// Removes the spheres on the camera's side of a plane, given by axis 0, 1 or 2, and position: narrows their clip.
void slice(std::pair<int, double> plane, const ViewAxes& axes, scene::PointsKeys& points);

/// A rectangle of an image that spheres shall not reach. Spheres around the centre of the image do not reach it if they
/// extend to less than `beside` to each side, or to less than `above` upwards and downwards.
struct Reserved {
  double beside = 0;  ///< in widths of the image
  double above = 0;   ///< in heights of the image
};

/// Extent of spheres along the axes of a view.
class ViewExtent {
 public:
  explicit ViewExtent(const ViewAxes& axes) : axes_(axes) {}

  void add(const scene::Points& points);
  void add(Vec3d center, double radius);
  /// Adds the space that the spheres pass through when they, or the camera, turn about an axis, a unit vector, through
  /// a point, which stays the centre.
  void add_orbits(const scene::Points& points, Vec3d pivot, Vec3d axis);
  bool is_empty() const { return is_empty_; }

  /// Returns the extent if all radii were larger by a length. An empty extent stays empty.
  ViewExtent grown(double length) const;

  /// Returns a camera that sees all spheres, with a margin of 5 % of the image on each side.
  ///
  /// `aspect`   image width divided by its height, as displayed
  /// `vfov_deg` vertical field of view of a perspective camera; none: orthographic
  /// `reserved` rectangles that the spheres shall not reach; one that would halve the image is ignored
  scene::Camera camera(double aspect, std::optional<double> vfov_deg = {},
                       const std::vector<Reserved>& reserved = {}) const;

  /// Distances along the view axis, of the back and of the front, from the origin.
  std::pair<double, double> depth() const { return {low_[2], high_[2]}; }
  /// Depths along the view axis of a camera that the spheres reach, as distances from it.
  scene::Interval depths(const scene::Camera& camera) const;

  /// Returns the point at a distance to the left of the lower left corner, in the middle of the depth.
  Vec3d beside(double gap) const;
  Vec3d center() const;   ///< centre of the box along the axes
  double radius() const;  ///< radius of a sphere around center() that contains all spheres, scene units

 private:
  /// The width of the image in front of the spheres.
  double image_width(double aspect, const std::vector<Reserved>& reserved) const;
  /// Adds an interval along axis `k`.
  void add(int k, double at, double reach);

  ViewAxes axes_;
  double low_[3] = {0, 0, 0}, high_[3] = {0, 0, 0};  ///< along right, up, back
  bool is_empty_ = true;
};

/// A sphere so large that it looks flat.
struct Ground {
  Vec3d center;
  double radius = 0;
};

/// Returns a ground below the lowest point of the spheres, at the height `lowest` along `up`, a unit vector.
Ground ground_below(double lowest, Vec3d up, const ViewExtent& extent);

/// Returns whether a ground hides spheres or part of the background from a camera of ViewExtent, because camera rays
/// start below it. That is the case if an orthographic camera looks horizontally or upwards.
bool hides_view(const Ground& ground, const scene::Camera& camera, double aspect);

/// Moves the camera, in the plane of its image, so that a point is at the centre of the image, and makes that point the
/// centre of orbits.
void look_at(Vec3d target, const ViewAxes& axes, scene::Camera& camera);

/// Narrows what the camera sees by a factor.
void magnify(scene::Camera& camera, double zoom);

/// The unit vector of the axis "x", "y" or "z".
Vec3d axis_of(const std::string& name);

}  // namespace orrery::plot
