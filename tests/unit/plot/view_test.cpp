// SPDX-License-Identifier: Apache-2.0
#include "plot/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "base/error.h"
#include "scene/scene.h"

namespace orrery::plot {
namespace {

constexpr const char* kUps[] = {"x", "y", "z"};
constexpr const char* kViews[] = {"iso", "+x",  "-x",    "+y",       "-y",    "+z",
                                  "-z",  "0,0", "30,20", "-120,-70", "45,90", "1e3,-90"};

double difference(Vec3d a, Vec3d b) { return math::length(a - b); }

TEST(PlotView, AxesAreRightHandedUnitVectors) {
  for (const char* up : kUps)
    for (const char* view : kViews) {
      const ViewAxes axes = view_axes(view, up);
      for (const Vec3d& axis : {axes.right, axes.up, axes.back})
        EXPECT_NEAR(math::length(axis), 1, 1e-14) << view << ' ' << up;
      EXPECT_LT(difference(math::cross(axes.right, axes.up), axes.back), 1e-14) << view << ' ' << up;
    }
}

TEST(PlotView, UpIsUpwards) {
  for (const char* up : kUps)
    for (const char* view : kViews) {
      const ViewAxes axes = view_axes(view, up);
      const double rise = math::dot(axes.up, axis_of(up));
      const bool is_vertical = std::abs(math::dot(axes.back, axis_of(up))) > 1 - 1e-9;
      if (is_vertical)
        EXPECT_NEAR(rise, 0, 1e-9) << view << ' ' << up;
      else
        EXPECT_GT(rise, 0.3) << view << ' ' << up;
      EXPECT_NEAR(math::dot(axes.right, axis_of(up)), 0, 1e-14) << "level, " << view << ' ' << up;
    }
}

TEST(PlotView, NamedViewsLookFromTheirAxis) {
  for (const char* up : kUps)
    for (const char* axis : {"x", "y", "z"}) {
      EXPECT_EQ(view_axes(std::string("+") + axis, up).back, axis_of(axis));
      EXPECT_EQ(view_axes(std::string("-") + axis, up).back, axis_of(axis) * -1.0);
    }
}

TEST(PlotView, ViewsWithZUp) {
  const ViewAxes front = view_axes("0,0", "z");
  EXPECT_EQ(front.back, (Vec3d{0, -1, 0}));
  EXPECT_EQ(front.right, (Vec3d{1, 0, 0}));
  EXPECT_EQ(front.up, (Vec3d{0, 0, 1}));
  EXPECT_EQ(view_axes("-y", "z").right, front.right) << "the same as the named view";
  EXPECT_LT(difference(view_axes("90,0", "z").back, {1, 0, 0}), 1e-14) << "azimuth turns to the right";
  const ViewAxes above = view_axes("+z", "z"), below = view_axes("-z", "z");
  EXPECT_EQ(above.up, (Vec3d{0, 1, 0})) << "a map: y is up";
  EXPECT_EQ(above.right, (Vec3d{1, 0, 0}));
  EXPECT_EQ(below.right, (Vec3d{1, 0, 0}));
  EXPECT_LT(difference(view_axes("0,90", "z").up, above.up), 1e-14);
}

TEST(PlotView, IsoShowsThreeFacesEqually) {
  for (const char* up : kUps) {
    const Vec3d back = view_axes("iso", up).back;
    for (const double part : {back.x, back.y, back.z}) EXPECT_NEAR(std::abs(part), std::sqrt(1.0 / 3), 1e-14);
  }
  EXPECT_LT(difference(view_axes("iso", "z").back, Vec3d{1, -1, 1} / std::sqrt(3.0)), 1e-14);
  EXPECT_LT(difference(view_axes("iso", "y").back, Vec3d{1, 1, 1} / std::sqrt(3.0)), 1e-14);
}

TEST(PlotView, PerspectiveCamerasSeeTheBoxWithAMargin) {
  for (const double aspect : {0.2, 1.0, 1.78})
    for (const double vfov : {1.0, 30.0, 120.0, 179.0}) {
      const ViewAxes axes = view_axes("30,20", "z");
      ViewExtent extent(axes);
      for (const Vec3d center : {Vec3d{0, 0, 0}, Vec3d{7, 1, -2}, Vec3d{-1, 3, 2}}) extent.add(center, 0.5);
      const scene::Camera camera = extent.camera(aspect, vfov);
      EXPECT_EQ(camera.projection, scene::Projection::kPerspective);
      EXPECT_EQ(camera.vfov, vfov);
      EXPECT_LT(difference(math::normalized(camera.look_from - camera.look_at), axes.back), 1e-12);
      // The corners of the box that the orthographic camera shows, on its face in front.
      const double tangent = std::tan(vfov / 360 * 3.14159265358979);
      double widest = 0;
      for (const Vec3d center : {Vec3d{0, 0, 0}, Vec3d{7, 1, -2}, Vec3d{-1, 3, 2}})
        for (const Vec3d to : {axes.right, axes.right * -1.0, axes.up, axes.up * -1.0}) {
          const Vec3d p = center + to * 0.5 - camera.look_from;
          const double distance = -math::dot(p, axes.back);
          EXPECT_GT(distance, 0);
          widest = std::max(widest, std::abs(math::dot(p, axes.right)) / (distance * tangent * aspect));
          widest = std::max(widest, std::abs(math::dot(p, axes.up)) / (distance * tangent));
        }
      EXPECT_LE(widest, 0.9 + 1e-9) << "5 % on each side";
    }
  EXPECT_GT(math::length(ViewExtent(view_axes("iso", "z")).camera(1, 30).look_from), 0);
}

TEST(PlotView, GrownExtentsAreThoseOfLargerSpheres) {
  ViewExtent points(view_axes("iso", "z")), spheres = points;
  EXPECT_TRUE(points.grown(1).is_empty());
  for (const Vec3d center : {Vec3d{0, 0, 0}, Vec3d{7, 1, -2}}) {
    points.add(center, 0);
    spheres.add(center, 1.5);
  }
  const scene::Camera grown = points.grown(1.5).camera(1.78), camera = spheres.camera(1.78);
  EXPECT_NEAR(*grown.width, *camera.width, 1e-12);
  EXPECT_LT(difference(grown.look_from, camera.look_from), 1e-12);
}

TEST(PlotView, MalformedViewsAreUsageErrors) {
  for (const char* view : {"", "isometric", "x", "+w", "+X", "30", "30,", ",20", "30,20,10", "30, 20", "30,91",
                           "30,-90.5", "nan,0", "inf,0", "30,nan"}) {
    try {
      view_axes(view, "z");
      ADD_FAILURE() << view;
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
      EXPECT_NE(std::string(error.what()).find(std::string("`") + view + "` is not a view"), std::string::npos);
    }
  }
}

/// Spheres of different sizes away from the origin.
scene::Points cloud() {
  std::mt19937 random(5);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  scene::Points out;
  for (int i = 0; i < 50; ++i) {
    out.centers.push_back({100 + 8 * unit(), -50 + 3 * unit(), 5 * unit()});
    out.radii.push_back((i % 7 == 0 ? -1 : 1) * (0.1 + 0.9 * unit()));  // negative: hollow glass
  }
  return out;
}

/// The largest extent of spheres from the centre of the image, in half widths and half heights of the image.
struct Reach {
  double left = -2, right = -2, bottom = -2, top = -2;
};
Reach reach_of(const scene::Points& points, const scene::Camera& camera, double aspect) {
  const Vec3d back = math::normalized(camera.look_from - camera.look_at);
  const Vec3d right = math::cross(camera.up, back);
  const double half = *camera.width / 2;
  Reach out;
  for (std::size_t i = 0; i < points.centers.size(); ++i) {
    const Vec3d at = points.centers[i] - camera.look_at;
    const double r = std::abs(points.radii[i]), x = math::dot(at, right), y = math::dot(at, camera.up);
    out.left = std::max(out.left, (r - x) / half);
    out.right = std::max(out.right, (r + x) / half);
    out.bottom = std::max(out.bottom, (r - y) / half * aspect);
    out.top = std::max(out.top, (r + y) / half * aspect);
    EXPECT_GT(math::dot(camera.look_from - points.centers[i], back), r) << "in front of the camera";
  }
  return out;
}

TEST(PlotView, TheCameraFitsTheSpheresWithAMargin) {
  const scene::Points points = cloud();
  constexpr double kInside = 0.9;  // 5 % of the image on each side
  for (const double aspect : {16.0 / 9, 1.0, 0.2, 9.0})
    for (const char* view : kViews) {
      const ViewAxes axes = view_axes(view, "z");
      ViewExtent extent(axes);
      extent.add(points);
      const scene::Camera camera = extent.camera(aspect);
      EXPECT_EQ(camera.projection, scene::Projection::kOrthographic);
      const Reach reach = reach_of(points, camera, aspect);
      const double wide = std::max(reach.left, reach.right), high = std::max(reach.bottom, reach.top);
      EXPECT_NEAR(std::max(wide, high), kInside, 1e-12) << view << ' ' << aspect;
      // The spheres are in the middle of the image.
      EXPECT_NEAR(reach.left, reach.right, 1e-12);
      EXPECT_NEAR(reach.bottom, reach.top, 1e-12);
    }
}

TEST(PlotView, ReservedRectanglesStayFree) {
  const scene::Points points = cloud();
  const ViewAxes axes = view_axes("iso", "z");
  ViewExtent extent(axes);
  extent.add(points);
  constexpr double kRounding = 1e-12;
  for (const double aspect : {16.0 / 9, 1.0, 0.2}) {
    const double fitted = *extent.camera(aspect).width;
    bool is_smaller = false;
    for (const Reserved rectangle : {Reserved{0.3, -0.4}, {-0.4, 0.3}, {0.3, 0.4}, {0.4, 0.3}, {0.44, 0.25}}) {
      const scene::Camera camera = extent.camera(aspect, {}, {rectangle});
      const Reach reach = reach_of(points, camera, aspect);
      const double beside = reach.right / 2 / rectangle.beside, above = reach.top / 2 / rectangle.above;
      const bool is_beside = rectangle.beside > 0 && beside <= 1 + kRounding,
                 is_above = rectangle.above > 0 && above <= 1 + kRounding;
      EXPECT_TRUE(is_beside || is_above) << beside << ' ' << above;
      is_smaller |= *camera.width > fitted;
      if (*camera.width > fitted) {
        EXPECT_NEAR(std::max(is_beside ? beside : 0, is_above ? above : 0), 1, kRounding) << "as large as possible";
      }
      EXPECT_GE(*camera.width, fitted);
      const scene::Camera perspective = extent.camera(aspect, 30, {rectangle});
      EXPECT_EQ(math::length(perspective.look_from - perspective.look_at) >
                    math::length(extent.camera(aspect, 30).look_from - perspective.look_at),
                *camera.width > fitted);
    }
    EXPECT_TRUE(is_smaller);
    EXPECT_EQ(*extent.camera(aspect, {}, {{0.09, 0.05}, {-0.1, -0.1}}).width, fitted) << "would leave too little";
  }
}

TEST(PlotView, ExtentsOfFramesAreJoined) {
  const ViewAxes axes = view_axes("+z", "y");
  ViewExtent extent(axes);
  EXPECT_TRUE(extent.is_empty());
  extent.add({});
  EXPECT_TRUE(extent.is_empty());
  EXPECT_GT(*extent.camera(1).width, 0) << "a camera without spheres is valid";
  scene::Points points;
  points.centers = {{10, 0, 0}};
  points.radii = {1};
  extent.add(points);
  EXPECT_FALSE(extent.is_empty());
  EXPECT_EQ(extent.center(), (Vec3d{10, 0, 0}));
  EXPECT_NEAR(*extent.camera(1).width, 2 / 0.9, 1e-12);
  EXPECT_NEAR(extent.radius(), std::sqrt(3.0), 1e-12);
  points.centers = {{14, 0, 0}};
  extent.add(points);
  EXPECT_EQ(extent.center(), (Vec3d{12, 0, 0}));
  EXPECT_NEAR(*extent.camera(1).width, 6 / 0.9, 1e-12);
}

/// Points of a box with edges along three perpendicular directions, with noise of a size.
scene::PointArray box_of(const std::array<Vec3d, 3>& edges, double noise = 0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  scene::PointArray out;
  for (int i = 0; i < 729; ++i)
    out.push_back(edges[0] * (i % 9 / 4.0 - 1) + edges[1] * (i / 9 % 9 / 4.0 - 1) + edges[2] * (i / 81 / 4.0 - 1) +
                  Vec3d{share(random), share(random), share(random)} * noise);
  return out;
}

TEST(PlotView, PrincipalAxesShowTheLargestFace) {
  const Vec3d a = math::normalized(Vec3d{1, 2, -0.5}), b = math::normalized(math::cross(a, {0, 0, 1})),
              c = math::cross(a, b);
  const ViewAxes near = view_axes(kDefaultView, "y");
  for (const bool is_tall : {false, true}) {
    const ViewAxes axes = principal_axes(box_of({a * 9, b * 3, c}), 729, near, is_tall);
    EXPECT_NEAR(std::abs(math::dot(is_tall ? axes.up : axes.right, a)), 1, 1e-9);
    EXPECT_NEAR(std::abs(math::dot(axes.back, c)), 1, 1e-9);
    EXPECT_LT(difference(math::cross(axes.right, axes.up), axes.back), 1e-12) << "right-handed";
    for (const auto& [x, y] : {std::pair(-1.0, -1.0), std::pair(-1.0, 1.0), std::pair(1.0, -1.0)}) {
      const Vec3d right = axes.right * x, up = axes.up * y, back = math::cross(right, up);
      EXPECT_GT(math::dot(axes.right, near.right) + math::dot(axes.up, near.up) + math::dot(axes.back, near.back),
                math::dot(right, near.right) + math::dot(up, near.up) + math::dot(back, near.back))
          << "the closest to the default view";
    }
  }
}

TEST(PlotView, PrincipalAxesAreStableUnderNoise) {
  const ViewAxes near = view_axes(kDefaultView, "z");
  // A box, a plate, a rod and a cube along the axes of the file.
  for (const Vec3d& size :
       {Vec3d{9, 3, 1}, Vec3d{4, 4, 1}, Vec3d{9, 1, 1}, Vec3d{1, 1, 1}, Vec3d{9, 3, 0}, Vec3d{9, 0, 0}}) {
    const std::array<Vec3d, 3> edges = {Vec3d{size.x, 0, 0}, Vec3d{0, size.y, 0}, Vec3d{0, 0, size.z}};
    const ViewAxes axes = principal_axes(box_of(edges), 729, near, false);
    for (unsigned seed = 1; seed < 9; ++seed) {
      const ViewAxes noisy = principal_axes(box_of(edges, 0.05, seed), 729, near, false);
      EXPECT_LT(difference(axes.back, noisy.back), 0.05) << size.x << size.y << size.z;
      EXPECT_LT(difference(axes.up, noisy.up), 0.05) << size.x << size.y << size.z;
    }
  }
}

TEST(PlotView, LayersAreFlat) {
  EXPECT_TRUE(are_flat(box_of({Vec3d{9, 0, 0}, {0, 5, 0}, {0, 0, 1}}), 729, {0, 0, 1}));
  EXPECT_FALSE(are_flat(box_of({Vec3d{9, 0, 0}, {0, 5, 0}, {0, 0, 1}}), 729, {0, 1, 0})) << "upright";
  EXPECT_FALSE(are_flat(box_of({Vec3d{9, 0, 0}, {0, 5, 0}, {0, 0, 2}}), 729, {0, 0, 1}));
  EXPECT_FALSE(are_flat(box_of({Vec3d{9, 0, 0}, {0, 0, 0}, {0, 0, 0}}), 729, {0, 0, 1})) << "a row";
  EXPECT_FALSE(are_flat({}, 0, {0, 0, 1}));
}

TEST(PlotView, WithoutADirectionTheDefaultViewRemains) {
  const ViewAxes near = view_axes(kDefaultView, "z");
  scene::PointArray points;
  EXPECT_EQ(principal_axes(points, 0, near, false).back, near.back);
  points.push_back({1, 2, 3});
  EXPECT_EQ(principal_axes(points, 1, near, false).back, near.back);
  points.push_back({1, 2, 3});
  EXPECT_EQ(principal_axes(points, 2, near, false).back, near.back) << "two at one place";
  EXPECT_EQ(principal_axes(box_of({Vec3d{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}), 729, near, false).back, near.back);
  points.push_back({1, 2, 5});
  const ViewAxes two = principal_axes(points, 3, near, false);
  EXPECT_NEAR(std::abs(two.right.z), 1, 1e-9) << "two atoms are seen from the side";
  EXPECT_NEAR(math::length(two.up), 1, 1e-9);
}

}  // namespace
}  // namespace orrery::plot
