// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "support/mentions.h"
#include "support/scene_files.h"

namespace orrery::load {
namespace {

using support::SceneFiles;
using test::mentions;

constexpr const char* kSpheres =
    "[material.m]\ntype = \"metal\"\nalbedo = [1, 1, 1]\n"
    "[[sphere]]\nname = \"a\"\nmaterial = \"m\"\ncenter = [0, 0, 0]\nradius = 1\n"
    "[[sphere]]\nmaterial = \"m\"\ncenter = [9, 0, 0]\nradius = 1\n";

std::string faults(const std::string& keys) {
  SceneFiles files;
  return files.diagnostics(kSpheres + keys);
}

TEST(LoadReadTracks, ATrackHasATargetFramesAndValues) {
  SceneFiles files;
  const auto scene = files
                         .read(std::string(kSpheres) +
                               "[[key]]\ntarget = \"sphere.a.center\"\nframes = [1, 3]\nvalues = [[0, 0, 0], [4, 0, "
                               "2]]\ninterpolation = \"linear\"\n")
                         .scene;
  ASSERT_EQ(scene.tracks.size(), 1u);
  EXPECT_EQ(scene.tracks[0].frames, (std::vector<double>{1, 3}));
  EXPECT_EQ(scene.tracks[0].values.at(1), (math::Vec3d{4, 0, 2}));
  EXPECT_EQ(scene.tracks[0].interpolation, scene::Interpolation::kLinear);
}

TEST(LoadReadTracks, UnsuitableTargetsAreNamedWithARemedy) {
  EXPECT_TRUE(mentions(faults("[[key]]\nframes = [1]\nvalues = [1]\n"), {"needs `target`"}));
  EXPECT_TRUE(mentions(faults("[[key]]\ntarget = \"camera.vfof\"\nframes = [1]\nvalues = [1]\n"), {"camera.vfov"}));
  EXPECT_TRUE(mentions(faults("[[key]]\ntarget = \"sphere[2].radius\"\nframes = [1]\nvalues = [1]\n"),
                       {"sphere[2].radius", "not a number", "animated"}));
}

TEST(LoadReadTracks, FramesAscendAndEachHasAValue) {
  const std::string target = "[[key]]\ntarget = \"camera.vfov\"\n";
  EXPECT_EQ(faults(target + "frames = [1, 2]\nvalues = [10, 20]\n"), "");
  EXPECT_TRUE(mentions(faults(target + "frames = [2, 2]\nvalues = [10, 20]\n"), {"must ascend", "2 follows 2"}));
  EXPECT_TRUE(mentions(faults(target + "frames = [1, 2]\nvalues = [10]\n"), {"2 frames", "1 values"}));
  EXPECT_TRUE(mentions(faults(target + "frames = [1]\nvalues = [180]\n"), {"180", "below 180"}));
  EXPECT_TRUE(mentions(faults(target + "frames = []\nvalues = [1]\n"), {"frames", "non-empty"}));
}

TEST(LoadReadTracks, ATargetHasOneTrack) {
  const std::string track = "[[key]]\ntarget = \"camera.vfov\"\nframes = [1]\nvalues = [10]\n";
  EXPECT_TRUE(mentions(faults(track + track), {"camera.vfov already has"}));
}

}  // namespace
}  // namespace orrery::load
