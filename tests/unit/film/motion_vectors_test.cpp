// SPDX-License-Identifier: Apache-2.0
#include "film/motion_vectors.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "film/sums.h"
#include "kernel/scene_view.h"

namespace orrery::film {
namespace {

using math::Vec3d;

/// A sphere and a rod before a camera at the origin that looks along -z, and an image of 3 x 1 pixels, of which the
/// second is in the middle.
class FilmMotionVectors : public testing::Test {
 protected:
  FilmMotionVectors() {
    request_.vector = true;
    view_.spheres = &sphere_;
    view_.sphere_count = 1;
    view_.rods = {&rod_, 1, nullptr, 0, 1};
    view_.camera.half_width = 1.5;
    view_.camera.half_height = 0.5;
    for (NeighborFrame& frame : frames_) frame.camera = view_.camera;
  }

  using Vector = std::array<float, 4>;

  /// The vector of a pixel whose nearest hit is a point of an object, or that sees the background.
  Vector vector(std::uint32_t id, Vec3d at, std::size_t pixel = 1) const {
    NeighborFrames neighbors;
    for (std::size_t i = 0; i < 2; ++i)
      if (exists_[i]) neighbors[i] = std::make_shared<const NeighborFrame>(frames_[i]);
    Sums sums(3, 1, request_);
    sums.layers.hit[pixel] = id == kernel::kNone ? 0 : id + 1;
    sums.layers.position[pixel] = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
    Vector out;
    write_motion_vector(neighbors, view_, sums, pixel, out.data());
    return out;
  }
  Vector background(std::size_t pixel) const { return vector(kernel::kNone, {}, pixel); }

  static void expect_near(const Vector& found, const Vector& expected) {
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], 1e-6) << k;
  }

  kernel::Sphere sphere_{0, 0, -4, 2};
  kernel::Rod rod_{{0, 0, -4}, 0.5, {2, 0, -4}, 0};
  kernel::SceneView view_;
  LayerRequest request_;
  std::array<NeighborFrame, 2> frames_;  ///< the frames before and after
  std::array<bool, 2> exists_ = {true, true};
};

TEST_F(FilmMotionVectors, WhatRestsHasNone) {
  for (NeighborFrame& frame : frames_) {
    frame.sphere_motion = {{0, 0, 0, 0}};
    frame.rod_motion = {{{0, 0, 0}, 0, {0, 0, 0}, 0}};
  }
  for (const std::uint32_t id : {0u, 1u, 2u, kernel::kNone})
    EXPECT_EQ(vector(id, {0.3, 0.1, -2.1}), (Vector{0, 0, 0, 0})) << id;
}

/// A sphere that moves to the right and down has come from the left and above: X is negative, Y positive.
TEST_F(FilmMotionVectors, SignsAreThoseOfBlender) {
  frames_[0].sphere_motion = {{-4, 2, 0, 0}};
  frames_[1].sphere_motion = {{8, -6, 0, 0}};
  expect_near(vector(0, {0, 0, -2}), {-2, 1, -4, 3});
  exists_ = {true, false};
  expect_near(vector(0, {0, 0, -2}), {-2, 1, 0, 0});
  exists_ = {false, true};
  expect_near(vector(0, {0, 0, -2}), {0, 0, -4, 3});
}

/// The right limb of a sphere that doubles its radius.
TEST_F(FilmMotionVectors, PointsMoveWithTheRadius) {
  frames_[1].sphere_motion = {{0, 0, 0, 2}};
  expect_near(vector(0, {2, 0, -4}), {0, 0, -0.5, 0});
}

TEST_F(FilmMotionVectors, PointsOfARodKeepTheirPlaceAlongIt) {
  frames_[1].rod_motion = {{{0, 0, 0}, 0, {2, 0, 0}, 0}};  // twice the length
  expect_near(vector(1, {0.5, 0.5, -4}), {0, 0, -0.125, 0});
  expect_near(vector(2, {1.5, 0.5, -4}), {0, 0, -0.375, 0});
  frames_[1].rod_motion = {{{0, 0, 0}, 0.5, {0, 0, 0}, 0}};  // twice the radius
  expect_near(vector(1, {0.5, 0.5, -4}), {0, 0, 0, -0.125});
}

/// A rod along x turns to y: what was above it is on its left, what was at its end is above.
TEST_F(FilmMotionVectors, PointsOfARodTurnWithIt) {
  frames_[1].rod_motion = {{{0, 0, 0}, 0, {-2, 2, 0}, 0}};
  expect_near(vector(1, {1, 0.5, -4}), {0, 0, 0.25F + 0.125F, 0.125F - 0.25F});
  expect_near(vector(2, {2.5, 0, -4}), {0, 0, 0.625F, -0.625F});
  frames_[1].rod_motion = {{{2, 0, 0}, 0, {-2, 0, 0}, 0}};  // its ends change places, which says nothing of its sides
  expect_near(vector(1, {0.5, 0.5, -4}), {0, 0, 0.125F - 0.375F, 0});
}

TEST_F(FilmMotionVectors, TheBackgroundTurnsWithTheCamera) {
  frames_[0].camera.origin = {5, 6, 7};
  const double sine = 0.6, cosine = 0.8;
  frames_[1].camera.forward = {sine, 0, -cosine};  // to the right: the background moves to the left
  frames_[1].camera.right = {cosine, 0, sine};
  expect_near(background(1), {0, 0, 0.75F, 0});
  expect_near(background(2), {0, 0, static_cast<float>(1 - (cosine - sine) / (sine + cosine)), 0});
  frames_[1].camera.forward = {0, 0, 1};
  expect_near(background(1), {0, 0, 0, 0});  // behind the camera
  view_.camera.is_orthographic = frames_[1].camera.is_orthographic = true;
  frames_[1].camera.forward = {sine, 0, -cosine};
  expect_near(background(1), {0, 0, 0, 0});
}

TEST_F(FilmMotionVectors, TheCameraMovesThePoints) {
  frames_[0].camera.origin = {-1, 0, 2};
  expect_near(vector(0, {0, 0, -2}), {0.25F, 0, 0, 0});
  frames_[0].camera.origin = {0, 0, -3};
  expect_near(vector(0, {1, 0, -2}), {0, 0, 0, 0});  // behind it
  frames_[1].camera.origin = view_.camera.origin = {0, 0, 5};
  frames_[0].camera.origin = {0, 0, 1e-60};
  expect_near(vector(0, {1, 0, 0}), {0, 0, 0, 0});  // too large for a float
  frames_[1].camera.origin = view_.camera.origin = {0, 0, 0};
  view_.camera.is_orthographic = frames_[0].camera.is_orthographic = true;
  frames_[0].camera.origin = {-1, 0, 2};
  expect_near(vector(0, {0, 0, -2}), {1, 0, 0, 0});
}

}  // namespace
}  // namespace orrery::film
