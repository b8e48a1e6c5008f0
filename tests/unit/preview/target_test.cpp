// SPDX-License-Identifier: Apache-2.0
#include "preview/target.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "base/error.h"
#include "preview/file_sink.h"
#include "preview/tev_sink.h"

namespace orrery::preview {
namespace {

TEST(PreviewTarget, TevListensOnLoopbackUnlessAHostIsGiven) {
  const auto address = [](const std::string& text) {
    const Target target = parse_target(text);
    EXPECT_EQ(target.kind, TargetKind::kTev);
    return target.host + " " + target.port;
  };
  EXPECT_EQ(address("tev"), "127.0.0.1 14158");
  EXPECT_EQ(address("tev:desk"), "desk 14158");
  EXPECT_EQ(address("tev:desk:9000"), "desk 9000");
  EXPECT_EQ(address("tev:[::1]:9000"), "::1 9000");
  EXPECT_EQ(address("tev:[::1]"), "::1 14158");
}

TEST(PreviewTarget, KnowsPngFiles) {
  EXPECT_EQ(parse_target("out/p.PNG").file, "out/p.PNG");
  EXPECT_EQ(parse_target("tev.png").kind, TargetKind::kFile);
  EXPECT_EQ(parse_target("tev:9000.png").kind, TargetKind::kFile);
}

TEST(PreviewTarget, MakesTheSinkOfItsKind) {
  const auto sink_of = [](const Target& target) { return make_sink(target, {}); };
  EXPECT_EQ(sink_of({}), nullptr);
  const std::unique_ptr<Sink> file = sink_of(parse_target("p.png"));
  EXPECT_NE(dynamic_cast<const FileSink*>(file.get()), nullptr);
  const std::unique_ptr<Sink> tev = sink_of(parse_target("tev"));
  EXPECT_NE(dynamic_cast<const TevSink*>(tev.get()), nullptr);
}

TEST(PreviewTarget, AFramePatternIsNotAPreview) {
  try {
    parse_target("p.##.png");
    ADD_FAILURE();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("frame pattern"), std::string::npos);
  }
}

TEST(PreviewTarget, RejectsEverythingElse) {
  for (const char* text : {"", "terminal", "p.exr", "tev:", "tev::9000", "tev:desk:", "tev:desk:0", "tev:desk:65536",
                           "tev:desk:9x", "tev:::1", "tev:[::1", "tev:[::1]9", "tev2"}) {
    try {
      parse_target(text);
      ADD_FAILURE() << text;
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kUsage) << text;
      EXPECT_NE(std::string(error.what()).find("write tev, tev:HOST:PORT, or the name"), std::string::npos) << text;
    }
  }
}

}  // namespace
}  // namespace orrery::preview
