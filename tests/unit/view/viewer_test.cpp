// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/stop_point.h"
#include "film/picture.h"
#include "image/read.h"
#include "job/run_job.h"
#include "support/peak_memory.h"
#include "support/temp_dir.h"

namespace orrery::view {
namespace {

using namespace std::chrono_literals;

constexpr const char* kScene = R"(
[image]
width = 64
height = 48
[render]
samples = 4
[camera]
look_from = [0, 0, 3]
look_at = [0, 0, 0]
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "grey"
)";

/// The words are --set KEY=VALUE and --samples N.
Subject subject_of(const std::vector<std::string>& words) {
  Subject out;
  out.job.scene.file = "scene.toml";
  out.job.scene.text = std::make_shared<const std::string>(kScene);
  out.job.scene.has_file = false;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    if (words[i] == "--set")
      out.job.scene.overrides.add(words[i + 1]);
    else if (words[i] == "--samples")
      out.job.scene.overrides.add_option("--samples", "render.samples", words[i + 1]);
    else
      base::refuse("unknown option " + words[i]);
  }
  return out;
}

scene::Camera camera_at(double x) {
  scene::Camera out;
  out.look_from = {x, 0, 3};
  out.look_at = {0, 0, 0};
  return out;
}

/// Waits for the finished image of the last wish, which differs from that of number `after`.
Frame finished(Viewer& viewer, std::uint64_t after = 0) {
  for (;;) {
    Frame frame = viewer.frame(after, 60s);
    if (frame.number <= after) throw std::runtime_error("no image within a minute; " + viewer.state().problem);
    if (frame.is_finished) return frame;
    after = frame.number;
  }
}

film::Picture rendered(const std::vector<std::string>& words) {
  return job::render_in_memory(subject_of(words).job).picture;
}

void expect_same(const film::Picture& a, const film::Picture& b) {
  ASSERT_EQ(a.planes.size(), b.planes.size());
  for (std::size_t i = 0; i < a.planes.size(); ++i) EXPECT_EQ(a.planes[i].values, b.planes[i].values);
}

TEST(ViewViewer, TheFinishedImageIsThatOfTheCommand) {
  Viewer viewer(subject_of, {"--set", "render.seed=5"}, {});
  const Frame first = finished(viewer);
  EXPECT_EQ(first.type, "image/png");
  expect_same(viewer.finished()->picture, rendered(viewer.state().words));
  Wish wish;
  wish.options["--samples"] = {"9"};
  wish.camera = camera_at(1.0 / 3);
  wish.moves = true;
  viewer.ask(wish);
  wish.moves = false;
  viewer.ask(wish);
  finished(viewer, first.number);
  const std::vector<std::string> words = viewer.state().words;
  EXPECT_EQ(words[0], "--set");
  EXPECT_EQ(words[1], "render.seed=5");
  EXPECT_EQ(words[3], "9");
  expect_same(viewer.finished()->picture, rendered(words));
}

TEST(ViewViewer, AMovingImageIsShownBeforeTheNextWish) {
  Viewer viewer(subject_of, {}, {});
  Frame frame = finished(viewer);
  for (int i = 1; i < 20; ++i) {
    Wish wish;
    wish.camera = camera_at(0.1 * i);
    wish.moves = true;
    viewer.ask(wish);
    const Frame next = viewer.frame(frame.number, 60s);
    EXPECT_GT(next.number, frame.number);
    EXPECT_FALSE(next.is_finished);
    EXPECT_EQ(next.samples, 1);
    frame = next;
  }
  EXPECT_FALSE(viewer.finished()) << "there is no finished image of a scene that moves";
}

/// The width of an image, px, and the darkest value in its upper left `width` x `height` pixels.
struct Darkest {
  int width;
  float value = 1;

  explicit Darkest(const Frame& frame, int part_width = 1 << 20, int part_height = 1 << 20) {
    const support::TempDir folder;
    const std::filesystem::path file = folder / (frame.type == "image/png" ? "frame.png" : "frame.jpg");
    support::write_bytes(file, *frame.bytes);
    width = image::read_map_header(file, image::MapFormats::kAll).width;
    image::read_map(
        file,
        [&](int row, const float* rgb) {
          if (row < part_height) value = std::min(value, *std::min_element(rgb, rgb + 3 * std::min(width, part_width)));
        },
        image::MapFormats::kAll);
  }
};

TEST(ViewViewer, NothingIsBlackBetweenTwoImages) {
  const Wish large{{{"--set", {"image.width=1600", "image.height=1200"}}, {"--samples", {"100000000"}}}};
  Viewer viewer(subject_of, {}, large);
  Frame frame = viewer.frame(0, 60s);
  Wish moved = large;
  moved.camera = camera_at(0.5);
  moved.moves = true;
  viewer.ask(moved);
  moved.moves = false;
  const std::uint64_t number = viewer.ask(moved);
  for (int live = 0; live < 4 || frame.wish != number;) {
    frame = viewer.frame(frame.number, 60s);
    const Darkest darkest(frame);
    ASSERT_GT(darkest.value, 0.1f) << frame.samples << " samples";
    if (frame.wish == number && darkest.width == 1600) ++live;
  }
}

TEST(ViewViewer, ACameraOfAnotherKindThanTheScenesIsIgnored) {
  Viewer viewer(subject_of, {}, {});
  Wish wish;
  wish.camera = camera_at(1);
  wish.camera->projection = scene::Projection::kOrthographic;
  wish.camera->width = 5;
  const std::uint64_t number = viewer.ask(wish);
  while (viewer.state().served < number) viewer.frame(1000000, 10ms);
  EXPECT_FALSE(viewer.state().wish.camera);
  EXPECT_EQ(viewer.state().words, std::vector<std::string>());
  EXPECT_EQ(viewer.state().camera->look_from, scene::Camera(camera_at(0)).look_from);
}

TEST(ViewViewer, AReadThatIsNotWantedAnyMoreStops) {
  const auto make = [](const std::vector<std::string>& words) {
    if (words.empty()) return subject_of(words);
    const base::StopPoint point;
    for (;;) point.check();  // a file without end
  };
  Viewer viewer(make, {}, {});
  for (int i = 0; i < 20; ++i) {
    viewer.ask(Wish{{{"--samples", {"1"}}}});
    const std::uint64_t number = viewer.ask({});
    while (viewer.state().served < number) viewer.frame(1000000, 1ms, viewer.state().number);
  }
}

TEST(ViewViewer, TheRangeOfAllFramesReplacesTheControl) {
  const auto make = [](const std::vector<std::string>& words) {
    Subject out = subject_of({});
    if (words == std::vector<std::string>{"--frames", "all"}) out.chosen["--range"] = "1:2";
    return out;
  };
  Viewer viewer(make, {}, {});
  const std::uint64_t number = viewer.ask({{{"--frame", {"2"}}, {kAllFrames, {"all"}}}});
  while (viewer.state().served < number) viewer.frame(1000000, 10ms);
  EXPECT_EQ(viewer.state().words, (std::vector<std::string>{"--frame", "2", "--range", "1:2"}));
}

TEST(ViewViewer, AFaultyWishLeavesTheImageAndSaysWhy) {
  Viewer viewer(subject_of, {}, {});
  const Frame before = finished(viewer);
  Wish wish;
  wish.options["--set"] = {"camera.vfov=500"};
  viewer.ask(wish);
  while (viewer.state().problem.empty()) viewer.frame(before.number, 10ms);
  EXPECT_NE(viewer.state().problem.find("camera.vfov"), std::string::npos) << viewer.state().problem;
  EXPECT_EQ(viewer.frame(0, 0ms).number, before.number);
  wish.options = {{"--nothing", {"1"}}};
  viewer.ask(wish);
  while (viewer.state().problem.find("--nothing") == std::string::npos) viewer.frame(before.number, 10ms);
  const std::uint64_t number = viewer.ask({});
  EXPECT_EQ(finished(viewer, before.number).wish, number);
  while (viewer.state().served < number) viewer.frame(1000000, 10ms);
  EXPECT_EQ(viewer.state().problem, "");
}

TEST(ViewViewer, WarningsAreThoseOfTheImage) {
  Viewer viewer(subject_of, {}, {{{"--set", {"camera.width=3"}}}});
  finished(viewer);
  ASSERT_EQ(viewer.state().warnings.size(), 1u);
  EXPECT_NE(viewer.state().warnings[0].find("camera.width"), std::string::npos) << viewer.state().warnings[0];
  const std::uint64_t number = viewer.ask({});
  while (viewer.state().served < number) viewer.frame(1000000, 10ms);
  EXPECT_EQ(viewer.state().warnings, std::vector<std::string>());
}

TEST(ViewViewer, AnImageBelongsToTheClientThatAsked) {
  Viewer viewer(subject_of, {}, {});
  std::uint64_t after = finished(viewer).number;
  for (const char* const client : {"a", "b", "a"}) {
    Wish wish;
    wish.client = client;
    viewer.ask(wish);
    EXPECT_FALSE(viewer.finished()) << "it is that of another wish";
    const Frame frame = finished(viewer, after);
    after = frame.number;
    EXPECT_EQ(frame.client, client);
    EXPECT_EQ(viewer.state().wish.client, client);
  }
}

TEST(ViewViewer, AWishIsStoppedOnRequest) {
  Viewer viewer(subject_of, {}, {});
  const std::uint64_t before = finished(viewer).number;
  const std::uint64_t number = viewer.ask({{{"--samples", {"100000000"}}}});
  Frame live = viewer.frame(before, 60s);
  while (live.samples < 2) live = viewer.frame(live.number, 60s);  // it has begun
  while (viewer.state().served < number) {
    viewer.cancel();
    viewer.frame(1000000, 10ms);
  }
  EXPECT_EQ(viewer.state().problem, "stopped");
  viewer.ask({});
  finished(viewer, live.number);
  EXPECT_EQ(viewer.state().problem, "");
}

TEST(ViewViewer, TheBoundsAreThoseOfTheCenters) {
  Viewer viewer(subject_of, {}, {{{"--set", {"sphere[0].center=[1, 2, 3]"}}}});
  finished(viewer);
  const auto bounds = viewer.state().bounds;
  ASSERT_TRUE(bounds);
  EXPECT_EQ((*bounds)[0], (math::Vec3d{1, 2, 3}));
  EXPECT_EQ((*bounds)[1], (math::Vec3d{1, 2, 3}));
}

TEST(ViewViewer, ASphereIsPicked) {
  Viewer viewer(subject_of, {}, {});
  finished(viewer);
  const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->title, "sphere[0]");
  EXPECT_EQ(picked->center, (math::Vec3d{0, 0, 0}));
  EXPECT_EQ(picked->radius, 1);
  EXPECT_EQ(picked->values, (std::vector<std::pair<std::string, std::string>>{{"material", "grey"}}));
  EXPECT_FALSE(viewer.pick(0, 0)) << "the background";
}

TEST(ViewViewer, PicksMayComeAtAnyTime) {
  Viewer viewer(subject_of, {}, {});
  std::atomic<bool> ends{false};
  std::thread client([&] {
    while (!ends) {
      const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
      EXPECT_EQ(picked ? picked->title : "sphere[0]", "sphere[0]");
    }
  });
  for (int i = 0; i < 30; ++i) {  // other spheres, thus another BVH
    Wish wish;
    wish.options["--set"] = {"sphere[0].radius=" + std::to_string(1 + 0.01 * i)};
    const std::uint64_t number = viewer.ask(wish);
    while (viewer.state().served < number) viewer.frame(1000000, 1ms);
    EXPECT_EQ(viewer.state().problem, "");
  }
  ends = true;
  client.join();
}

TEST(ViewViewer, ARodIsPicked) {
  const auto make = [](const std::vector<std::string>& words) {
    Subject out = subject_of(words);
    out.job.scene.text = std::make_shared<const std::string>(
        std::string(kScene) +
        "[[rod]]\nfrom = [-1, 0, 1.5]\nto = [1, 1, 1.5]\nradius = 0.3\nmaterial = \"grey\"\nname = \"bond\"\n");
    return out;
  };
  Viewer viewer(make, {}, {});
  finished(viewer);
  ASSERT_EQ(viewer.state().problem, "");
  const std::optional<Picked> picked = viewer.pick(0.5, 0.4);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->title, "rod[0]");
  EXPECT_EQ(picked->center, (math::Vec3d{0, 0.5, 1.5}));
  EXPECT_EQ(picked->radius, 0.3);
  const std::vector<std::pair<std::string, std::string>> values = {{"name", "bond"},
                                                                   {"ends", "[-1, 0, 1.5], [1, 1, 1.5]"}};
  EXPECT_EQ(picked->values, values);
}

TEST(ViewViewer, APickedBondTellsItsTwoParticles) {
  const std::filesystem::path file = testing::TempDir() + "view_bonds.xyz";
  std::ofstream(file) << "4\n\nHe 9 9 0\nC -2 0 0\nC 2 0 0\nO 2 3 0\n";
  const auto make = [&](const std::vector<std::string>& words) {
    Subject out = subject_of(words);
    out.job.scene.file = file.parent_path() / "scene.toml";
    out.job.scene.text = std::make_shared<const std::string>(
        std::string(kScene).substr(0, std::string(kScene).find("[[sphere]]")) +
        "[[rod]]\nfrom = [9, 9, 9]\nto = [9, 9, 9]\nradius = 1\nmaterial = \"grey\"\n[[points]]\nfile = \"" +
        file.filename().string() +
        "\"\nmaterial = \"grey\"\nradius = 0.5\nbonds = { length = 4.5, radius = 0.3 }\nselect = \"element != "
        "'He'\"\n");
    return out;
  };
  Viewer viewer(make, {}, {});
  finished(viewer);
  const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
  ASSERT_TRUE(picked) << viewer.state().problem;
  EXPECT_EQ(picked->title, "bond of rows 2 and 3 of view_bonds.xyz");
  EXPECT_EQ(picked->radius, 0.3);
  ASSERT_GE(picked->values.size(), 2u);
  EXPECT_EQ(picked->values[0], (std::pair<std::string, std::string>{"element", "C, C"}));
  EXPECT_EQ(picked->values[1], (std::pair<std::string, std::string>{"x", "-2, 2"}));
}

TEST(ViewViewer, APickedParticleHasTheColumnsOfItsRow) {
  const std::filesystem::path file = testing::TempDir() + "view_particles.xyz";
  std::ofstream(file) << "3\nProperties=species:S:1:pos:R:3:charge:R:1\n"
                         "He -2 0 0 0.1\nNe 0 0 0 -0.25\nAr 2 0 0 0.3\n";
  const auto make = [&](const std::vector<std::string>& words) {
    Subject out = subject_of(words);
    out.job.scene.file = file.parent_path() / "scene.toml";
    out.job.scene.text = std::make_shared<const std::string>(
        std::string(kScene).substr(0, std::string(kScene).find("[[sphere]]")) + "[[points]]\nfile = \"" +
        file.filename().string() + "\"\nmaterial = \"grey\"\nradius = 0.5\nselect = \"species != 'He'\"\n");
    return out;
  };
  Viewer viewer(make, {}, {});
  finished(viewer);
  const std::optional<Picked> picked = viewer.pick(0.5, 0.5);
  ASSERT_TRUE(picked) << viewer.state().problem;
  EXPECT_EQ(picked->title, "row 2 of view_particles.xyz");
  EXPECT_EQ(picked->center, (math::Vec3d{0, 0, 0}));
  const std::vector<std::pair<std::string, std::string>> values = {
      {"species", "Ne"}, {"x", "0"}, {"y", "0"}, {"z", "0"}, {"charge", "-0.25"}};
  EXPECT_EQ(picked->values, values);
  // The file is not needed again while nothing but the camera changes.
  std::filesystem::remove(file);
  EXPECT_TRUE(viewer.pick(0.5, 0.5));
}

TEST(ViewViewer, ARenderThatIsNotWantedAnyMoreStops) {
  Viewer viewer(subject_of, {}, Wish{{{"--samples", {"100000000"}}}});
  const Frame live = viewer.frame(0, 60s);
  viewer.ask({});
  finished(viewer, live.number);
  EXPECT_EQ(viewer.state().problem, "");
  viewer.ask(Wish{{{"--samples", {"100000000"}}}});
  viewer.frame(viewer.frame(0, 0ms).number, 60s);
  // The destructor also stops it.
}

/// The darkest value at the upper left of an image, where only the sky is, and the title.
float darkest_at_title(const Frame& frame) { return Darkest(frame, 24, 12).value; }

TEST(ViewViewer, TextIsDrawnOverEveryImage) {
  const Wish plain{{{"--samples", {"100000000"}}}};
  Wish titled = plain;
  titled.options["--set"] = {"annotation.title=MMMM"};
  Viewer viewer(subject_of, {}, titled);
  const Frame live = viewer.frame(0, 60s);
  EXPECT_FALSE(live.is_finished);
  EXPECT_LT(darkest_at_title(live), 0.3f);
  titled.camera = camera_at(0.1);
  titled.moves = true;
  const auto first_of = [&](const Wish& wish) {
    const std::uint64_t number = viewer.ask(wish);
    Frame frame = viewer.frame(live.number, 60s);
    while (frame.wish != number) frame = viewer.frame(frame.number, 60s);
    return frame;
  };
  EXPECT_LT(darkest_at_title(first_of(titled)), 0.3f);
  EXPECT_GT(darkest_at_title(first_of(plain)), 0.4f);
}

TEST(ViewViewerMemory, DoesNotGrowWithMoves) {
  Viewer viewer(subject_of, {}, {});
  Frame frame = finished(viewer);
  const auto move = [&](int count) {
    for (int i = 0; i < count; ++i) {
      Wish wish;
      wish.camera = camera_at(0.001 * i);
      wish.moves = i % 100 != 99;
      viewer.ask(wish);
      if (i % 10 == 0) frame = viewer.frame(frame.number, 60s);
    }
  };
  // The allocator keeps freed memory, on a busy machine of more threads.
  const auto used = [] {
    malloc_trim(0);
    return support::resident_memory();
  };
  move(1000);
  const std::uint64_t before = used();
  move(10000);
  EXPECT_LT(used(), before + (8u << 20));
}

}  // namespace
}  // namespace orrery::view
