// SPDX-License-Identifier: Apache-2.0
#include "job/prepare_job.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/core.h>

#include "base/error.h"
#include "image/format.h"
#include "image/read.h"
#include "job/run_job.h"
#include "unit/job/job_fixture.h"

namespace orrery::job {
namespace {

class JobPrepareJob : public JobTest {};

TEST_F(JobPrepareJob, LooksUpADisplayOnlyForDisplayFormats) {
  job_.outputs.images = {folder_ / "a.exr"};
  ::setenv("OCIO", (folder_ / "nowhere.ocio").c_str(), 1);
  const JobReport report = run_job(job_);
  ::unsetenv("OCIO");
  EXPECT_EQ(report.display.display, "");
  job_.scene.overrides = {"color.config=nowhere.ocio"};
  EXPECT_EQ(error().kind(), base::ErrorKind::kMissingInput) << "named explicitly";
}

/// While spheres of two files are compiled, they are in memory twice. With the list, the render needs less than that.
TEST_F(JobPrepareJob, SpheresThatDoNotFitTwiceAreNotCompiled) {
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 1000; ++i) rows += std::to_string(i) + ",0.5,0.25\n";
  support::write_bytes(folder_ / "a.csv", rows);
  const std::string points = "[[points]]\nfile = \"a.csv\"\nradius = 0.01\nmaterial = \"grey\"\n";
  support::write_bytes(folder_ / "scene.toml",
                       std::string(kSmallScene) + points + points + "transform = { translate = [0, 1, 0] }\n");
  for (const char* text : {"image.width=1", "image.height=1", "render.accelerator=\"list\""})
    job_.scene.overrides.add(text);
  job_.outputs.images = {folder_ / "a.exr"};
  // The 2,000 spheres take 12 bytes each, and need 24 while they are read.
  job_.resources.memory_limit = 49'000;
  EXPECT_NO_THROW(run_job(job_));
  job_.resources.memory_limit = 47'000;
  const base::Error refused = error();
  EXPECT_EQ(refused.kind(), base::ErrorKind::kNoMemory);
  EXPECT_NE(std::string(refused.what()).find("the spheres need about 46.9 KiB while they are compiled"),
            std::string::npos)
      << refused.what();
}

TEST_F(JobPrepareJob, OverridesReplaceTheDisplayOfTheScene) {
  support::write_bytes(folder_ / "scene.toml",
                       std::string(kSmallScene) + "[color]\ndisplay = \"Gamma 2.0 Rec.709\"\nexposure = -2\n");
  job_.outputs.images = {folder_ / "a.png"};
  EXPECT_EQ(run_job(job_).display.display, "Gamma 2.0 Rec.709");
  const float dark = image::read(folder_ / "a.png").planes[0].values[0];
  job_.scene.overrides = {"color.exposure=0"};
  run_job(job_);
  EXPECT_NEAR(image::read(folder_ / "a.png").planes[0].values[0], 2 * dark, 0.01);
  job_.scene.overrides.add("color.display=sRGB");
  EXPECT_EQ(run_job(job_).display.display, "sRGB");
}

TEST_F(JobPrepareJob, AConfigPathIsRelativeToTheScene) {
  support::write_bytes(folder_ / "scene.toml", std::string(kSmallScene) + "[color]\nconfig = \"none.ocio\"\n");
  job_.outputs.images = {folder_ / "a.png"};
  const base::Error missing = error();
  EXPECT_EQ(missing.kind(), base::ErrorKind::kMissingInput);
  ASSERT_EQ(missing.diagnostics().size(), 1u);
  EXPECT_NE(missing.diagnostics()[0].text.find((folder_ / "none.ocio").string()), std::string::npos);
  EXPECT_FALSE(rendered_);
}

TEST_F(JobPrepareJob, AnHdrDisplayHasSixteenBits) {
  job_.scene.overrides = {"color.display=Rec.2100-PQ"};
  job_.outputs.images = {folder_ / "a.png"};
  run_job(job_);
  bool between = false;  // two 8-bit levels
  for (const float v : image::read(folder_ / "a.png").planes[0].values)
    between = between || std::abs(v * 255 - std::round(v * 255)) > 0.01f;
  EXPECT_TRUE(between);
  job_.outputs.images = {folder_ / "a.jpg"};
  EXPECT_EQ(error().kind(), base::ErrorKind::kUsage);
}

/// A scene in which everything moves, and where a point of each object is in its own coordinates.
constexpr const char* kMovingScene = R"(
[image]
width = 160
height = 120
[camera]
vfov = 40
look_at = [0, 0, 0]
[render]
samples = 32
shading = "flat"
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, -101, 0]
radius = 100
material = "grey"
[[sphere]]
name = "ball"
center = [0, 0, 0]
radius = 1
material = "grey"
[[rod]]
name = "bar"
from = [0, 0, 0]
to = [0, 1, 0]
radius = 0.4
material = "grey"
[[key]]
target = "camera.look_from"
frames = [1, 9]
values = [[0, 1, 8], [2, 1.6, 7]]
[[key]]
target = "sphere.ball.center"
frames = [1, 9]
values = [[-1.5, 0, 0], [0, 1, 1]]
[[key]]
target = "sphere.ball.radius"
frames = [1, 9]
values = [0.8, 1.2]
[[key]]
target = "rod.bar.from"
frames = [1, 9]
values = [[1, -0.5, 0], [0.5, 0, -1]]
[[key]]
target = "rod.bar.to"
frames = [1, 9]
values = [[2, 1, 0.5], [1.5, 1.5, -0.5]]
)";

/// Frames of kMovingScene, with the points that are visible in them.
class MovingFrame {
 public:
  virtual ~MovingFrame() = default;
  MovingFrame(Job job, int frame) : share_((frame - 1) / 8.0) {
    job.scene.frame = frame;
    job.scene.overrides.add("output.layers=[\"P\", \"object_id\", \"Vector\"]");
    picture_ = render_in_memory(job).picture;
  }

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }
  float value(const char* plane, int x, int y) const {
    return picture_.find(plane)->values[static_cast<std::size_t>(y * width() + x)];
  }
  int object(int x, int y) const { return static_cast<int>(value("object_id.X", x, y)); }
  /// The nearest hit of a pixel, relative to its object.
  virtual math::Vec3d local(int x, int y) const {
    const math::Vec3d p{value("P.X", x, y), value("P.Y", x, y), value("P.Z", x, y)};
    const double t = share_;
    switch (object(x, y)) {
      case 2: return (p - math::Vec3d{-1.5 + 1.5 * t, t, t}) / (0.8 + 0.4 * t);
      case 3: return p - math::Vec3d{1 - 0.5 * t, -0.5 + 0.5 * t, -t};
      default: return p;
    }
  }

 private:
  double share_;
  film::Picture picture_;
};

/// The mean distance, px, between the points of a frame and the places in another to which vectors lead.
///
/// `x_plane`, `y_plane`  the vectors to the other frame, times `sign`
double mean_error(const MovingFrame& from, const MovingFrame& to, const char* x_plane, const char* y_plane,
                  double sign) {
  double sum = 0;
  int count = 0;
  std::array<int, 4> of_objects{};
  for (int y = 0; y < from.height(); ++y)
    for (int x = 0; x < from.width(); ++x) {
      const double at_x = x + sign * static_cast<double>(from.value(x_plane, x, y)),
                   at_y = y - sign * static_cast<double>(from.value(y_plane, x, y));
      const int u = static_cast<int>(std::floor(at_x)), v = static_cast<int>(std::floor(at_y));
      const int object = from.object(x, y);
      if (object == 0 || u < 0 || v < 0 || u + 1 >= to.width() || v + 1 >= to.height()) continue;
      if (to.object(u, v) != object || to.object(u + 1, v) != object || to.object(u, v + 1) != object ||
          to.object(u + 1, v + 1) != object)
        continue;
      // The point at the place in the other frame, and how it changes from pixel to pixel.
      const math::Vec3d corner = to.local(u, v), right = to.local(u + 1, v) - corner,
                        down = to.local(u, v + 1) - corner;
      const math::Vec3d miss = from.local(x, y) - corner - right * (at_x - u) - down * (at_y - v);
      const double a = dot(right, right), b = dot(right, down), c = dot(down, down), det = a * c - b * b;
      if (!(det > 0.01 * a * c)) continue;  // grazing
      const double along = dot(miss, right), across = dot(miss, down);
      sum += std::hypot((c * along - b * across) / det, (a * across - b * along) / det);
      ++count;
      ++of_objects[static_cast<std::size_t>(object)];
    }
  for (std::size_t object = 1; object < of_objects.size(); ++object) EXPECT_GT(of_objects[object], 200) << object;
  return sum / count;
}

TEST_F(JobPrepareJob, MotionVectorsLeadToTheSamePointsOfTheNeighbouringFrames) {
  support::write_bytes(folder_ / "scene.toml", kMovingScene);
  job_.outputs = {};
  const MovingFrame before(job_, 4), frame(job_, 5), after(job_, 6);
  EXPECT_LT(mean_error(frame, after, "Vector.Z", "Vector.W", -1), 0.5);
  EXPECT_LT(mean_error(frame, before, "Vector.X", "Vector.Y", 1), 0.5);
  EXPECT_GT(mean_error(frame, after, "Vector.X", "Vector.Y", 1), 1) << "the motion is larger than the error";
  const MovingFrame first(job_, 1), last(job_, 9);
  for (const char* plane : {"Vector.X", "Vector.Y"}) EXPECT_EQ(first.value(plane, 80, 100), 0);
  for (const char* plane : {"Vector.Z", "Vector.W"}) EXPECT_EQ(last.value(plane, 80, 100), 0);
}

/// Particles of a trajectory in frames 1 to 3.
class TrajectoryFrame : public MovingFrame {
 public:
  TrajectoryFrame(const Job& job, int frame) : MovingFrame(job, frame), frame_(frame) {}

  static math::Vec3d place(int particle, int frame) {
    const double t = frame - 2;
    return particle == 0   ? math::Vec3d{-1.5 + 0.3 * t, 0.2 * t * t, 0}
           : particle == 1 ? math::Vec3d{1, 0.5 - 0.2 * t, 0.3 * t}
                           : math::Vec3d{0.2 * t, -1.2, 0.1 * t * t};
  }
  math::Vec3d local(int x, int y) const override {
    const math::Vec3d p{value("P.X", x, y), value("P.Y", x, y), value("P.Z", x, y)};
    return p - place(object(x, y) - 1, frame_);
  }

 private:
  int frame_;
};

TEST_F(JobPrepareJob, MotionVectorsOfDataLeadToTheirPlacesInTheFramesOfTheFile) {
  std::string text;
  for (int frame = 1; frame <= 3; ++frame) {
    text += "3\nProperties=id:I:1:pos:R:3\n";
    for (int i = 0; i < 3; ++i) {
      const int particle = (i + frame) % 3;  // in another order in each frame
      const math::Vec3d p = TrajectoryFrame::place(particle, frame);
      text += fmt::format("{} {} {} {}\n", particle + 1, p.x, p.y, p.z);
    }
  }
  support::write_bytes(folder_ / "three.xyz", text);
  support::write_bytes(
      folder_ / "scene.toml",
      "[image]\nwidth = 160\nheight = 120\n[camera]\nvfov = 40\nlook_from = [0, 0, 7]\n"
      "look_at = [0, 0, 0]\n[render]\nsamples = 32\nshading = \"flat\"\n[material.grey]\n"
      "type = \"lambertian\"\nalbedo = [0.5, 0.5, 0.5]\n[[points]]\nfile = \"three.xyz\"\nradius = 0.7\nmaterial = "
      "\"grey\"\nmotion.next_frame = true\n");
  job_.outputs = {};
  const TrajectoryFrame before(job_, 1), frame(job_, 2), after(job_, 3);
  EXPECT_LT(mean_error(frame, after, "Vector.Z", "Vector.W", -1), 0.5);
  EXPECT_LT(mean_error(frame, before, "Vector.X", "Vector.Y", 1), 0.5);
  EXPECT_GT(mean_error(frame, after, "Vector.X", "Vector.Y", 1), 1) << "the motion is not uniform";
}

}  // namespace
}  // namespace orrery::job
