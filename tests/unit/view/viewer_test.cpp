// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "base/stop_point.h"
#include "data/byte_source.h"
#include "film/picture.h"
#include "image/read.h"
#include "job/run_job.h"
#include "support/peak_memory.h"
#include "support/small_view.h"
#include "support/temp_dir.h"

namespace orrery::view {
namespace {

using namespace std::chrono_literals;

std::vector<std::string> camera_at(double x) {
  return {"camera.look_from=[" + std::to_string(x) + ", 0, 3]", "camera.look_at=[0, 0, 0]"};
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
    EXPECT_EQ(next.samples, 0);
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
  wish.camera.push_back("camera.width=5");
  const std::uint64_t number = viewer.ask(wish);
  while (viewer.state().served < number) viewer.frame(1000000, 10ms);
  EXPECT_TRUE(viewer.state().wish.camera.empty());
  EXPECT_EQ(viewer.state().words, std::vector<std::string>());
  EXPECT_EQ(viewer.state().camera->look_from, (math::Vec3d{0, 0, 3}));
}

TEST(ViewViewer, AWishHasBeenReadOnceTheSubjectHasItsOptions) {
  std::atomic<bool> may_read = false;
  const auto make = [&](const std::vector<std::string>& words) {
    while (!words.empty() && !may_read) std::this_thread::sleep_for(1ms);
    return subject_of({});
  };
  Viewer viewer(make, {}, {});
  finished(viewer);
  EXPECT_EQ(viewer.state().read, viewer.state().asked);
  Wish wish{{{"--samples", {"1"}}}};
  std::uint64_t number = viewer.ask(wish);
  EXPECT_LT(viewer.state().read, number);
  may_read = true;
  while (viewer.state().served < number) viewer.frame(1000000, 1ms, viewer.state().number);
  EXPECT_EQ(viewer.state().read, number);
  wish.camera = camera_at(0.1);
  number = viewer.ask(wish);
  EXPECT_EQ(viewer.state().read, number) << "a moved camera needs no other subject";
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

TEST(ViewViewer, TheProgressOfAReadIsTheFractionOfTheFile) {
  const support::TempDir folder;
  support::write_bytes(folder / "file.txt", std::string(100, ' '));
  std::atomic<bool> goes_on{false};
  const auto make = [&](const std::vector<std::string>& words) {
    data::ByteSource::open(folder / "file.txt", 1000)->text(0, 25);
    goes_on.wait(false);
    return subject_of(words);
  };
  Viewer viewer(make, {}, {});
  while (viewer.state().progress == 0) viewer.frame(1000000, 60s, viewer.state().number);
  EXPECT_EQ(viewer.state().activity, "reading");
  EXPECT_EQ(viewer.state().progress, 0.25);
  goes_on = true;
  goes_on.notify_all();
  finished(viewer);
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
  const auto used = [] {
    malloc_trim(0);
    return support::resident_memory();
  };
  move(1000);
  // The allocator keeps freed memory for each thread, of which a busy machine has more. That ends; a leak does not.
  constexpr int kRounds = 8;
  std::vector<std::uint64_t> sizes = {used()};
  for (int round = 0; round < kRounds; ++round) {
    move(10000);
    sizes.push_back(used());
    if (sizes[sizes.size() - 1] < sizes[sizes.size() - 2] + (1u << 20)) return;
  }
  ADD_FAILURE() << "it grows in each of " << kRounds << " rounds, to " << testing::PrintToString(sizes) << " bytes";
}

}  // namespace
}  // namespace orrery::view
