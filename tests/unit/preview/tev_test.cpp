// SPDX-License-Identifier: Apache-2.0
#include "preview/tev.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>

#include "preview/preview.h"
#include "support/tev_server.h"
#include "unit/preview/pictures.h"

namespace orrery::preview {

namespace {

TEST(PreviewTevPackets, CreateHasTheBytesOfTheProtocol) {
  const std::string packet = tev_create("ab", 3, 258, true);
  const std::string want(
      "\x1b\0\0\0\x04\x01"
      "ab\0"
      "\x03\0\0\0"
      "\x02\x01\0\0"
      "\x03\0\0\0"
      "R\0G\0B\0",
      27);
  EXPECT_EQ(packet, want);
}

TEST(PreviewTevPackets, UpdatesFillTheImage) {
  test::TevReader reader;
  const auto add = [&](const std::string& packet) {
    for (const char c : packet) reader.add(&c, 1);  // arrives in pieces
  };
  add(tev_create("image", 4, 3, false));
  add(tev_update("image", 1, 1, 2, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, -0.5f}));
  const test::TevImage& image = reader.images.at("image");
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  std::vector<float> want(36, 0.0f);
  for (std::size_t i = 0; i < 6; ++i) want[15 + i] = static_cast<float>(i + 1);
  for (std::size_t i = 0; i < 6; ++i) want[27 + i] = static_cast<float>(i + 7);
  want[32] = -0.5f;
  EXPECT_EQ(image.values, want);
}

}  // namespace

namespace {

using test::TevServer;

class PreviewTevSink : public testing::Test {
 protected:
  OnNote note() {
    return [this](const std::string& text) { notes_ += text; };
  }
  std::unique_ptr<Preview> preview(const std::string& port) {
    return std::make_unique<Preview>(std::make_unique<TevSink>("127.0.0.1", port, note()), note());
  }
  static display::PictureInfo info(int width, int height, const std::string& name = "scene.toml") {
    return {name, width, height, {}};
  }
  std::string notes_;
};

TEST_F(PreviewTevSink, TheViewerHasTheExactImageInTheEnd) {
  TevServer server(TevServer::Manner::kReads);
  const film::Partial first = partial(1100, 70), second = partial(1100, 70, 0.5), other = partial(40, 30, 3);
  {
    const auto sender = preview(std::to_string(server.port()));
    sender->begin(info(1100, 70));
    write_all(first, *sender);
    sender->end();
    sender->begin(info(1100, 70));  // the next frame has the same name and replaces the image
    write_all(second, *sender);
    sender->end();
    sender->begin(info(40, 30, "other.toml"));
    write_all(other, *sender);
  }
  const auto images = server.images();
  ASSERT_EQ(images.size(), 2u);
  EXPECT_TRUE(images.at("scene.toml").values == means(second));
  EXPECT_EQ(images.at("scene.toml").creations, 2);
  EXPECT_GE(images.at("scene.toml").updates, 6);
  EXPECT_EQ(images.at("other.toml").values, means(other));
  EXPECT_EQ(notes_, "");
}

TEST_F(PreviewTevSink, AViewerThatNeverReadsDelaysNothingForLong) {
  TevServer server(TevServer::Manner::kHangs);
  {
    // More than the system buffers.
    const film::Partial state = partial(1200, 1200);
    const auto sender = preview(std::to_string(server.port()));
    sender->begin(info(1200, 1200));
    write_all(state, *sender);
    sender->end();
    sender->begin(info(1200, 1200));
    write_all(state, *sender);
  }
  EXPECT_NE(notes_.find("does not respond; its image is incomplete\n"), std::string::npos) << notes_;
  EXPECT_EQ(std::count(notes_.begin(), notes_.end(), '\n'), 1);
}

TEST_F(PreviewTevSink, AViewerThatLeavesIsNotAnError) {
  TevServer server(TevServer::Manner::kLeaves);
  {
    const film::Partial state = partial(1200, 1200);
    const auto sender = preview(std::to_string(server.port()));
    sender->begin(info(1200, 1200));
    write_all(state, *sender);
  }
  server.images();
  EXPECT_GE(server.connections(), 1);
}

TEST_F(PreviewTevSink, AViewerThatIsStartedLaterGetsTheWholeImage) {
  int port = 0;
  { port = TevServer(TevServer::Manner::kReads).port(); }  // now nobody listens there
  const film::Partial state = partial(100, 100);
  Canvas canvas(100, 100);
  write_all(state, canvas);
  std::map<std::string, test::TevImage> images;
  {
    auto sink = std::make_unique<TevSink>("127.0.0.1", std::to_string(port), note());
    sink->begin(info(100, 100), canvas);
    sink->update(canvas.take_changed());
    EXPECT_EQ(notes_, "warning: tev cannot be reached at 127.0.0.1:" + std::to_string(port) +
                          ": Connection refused; the render continues, and the preview begins when tev is started\n");
    TevServer server(TevServer::Manner::kReads, port);
    while (server.connections() == 0) {
      sink->poll();
      usleep(10'000);
    }
    sink->finish();
    sink.reset();
    images = server.images();
  }
  EXPECT_TRUE(images.at("scene.toml").values == means(state));
}

TEST_F(PreviewTevSink, AnUnknownHostIsAWarning) {
  TevSink sink("not a host", "1", note());
  sink.poll();
  sink.finish();
  EXPECT_EQ(notes_.find("warning: tev cannot be reached at not a host:1: "), 0u) << notes_;
}

}  // namespace

}  // namespace orrery::preview
