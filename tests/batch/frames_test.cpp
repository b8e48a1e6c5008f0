// SPDX-License-Identifier: Apache-2.0
// Frame ranges, several scenes, and existing output files.
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace orrery::test {
namespace {

/// Moves the sphere of the good scene from left to right.
constexpr const char* kFlight = R"(
[camera]
look_from = [0, 0, 1]
look_at = [0, 0, -1]
[[key]]
target = "sphere[0].center"
frames = [1, 5]
values = [[-1, 0, -1], [1, 0, -1]]
)";

constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    "property float radius\nend_header\n0 0 -1 0.5\n";

class BatchFrames : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("shot.toml", animated());
  }
  static std::string animated() { return std::string(kGoodScene) + kFlight; }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
};

TEST_F(BatchFrames, RangeWritesOneImagePerFrame) {
  const Outcome r = run("render shot.toml -o s.####.exr -o s.%02d.png --frames 1-5:2 --stats s.##.json -q");
  ASSERT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(r.err, "");
  for (const char* name : {"s.0001.exr", "s.0003.exr", "s.0005.exr", "s.01.png", "s.05.png", "s.03.json"})
    EXPECT_TRUE(exists(name)) << name;
  EXPECT_EQ(file_count(), 9);
  EXPECT_NE(text_of(folder_ / "s.01.png"), text_of(folder_ / "s.05.png"));
  // A frame has the same pixels whichever command renders it.
  ASSERT_EQ(run("render shot.toml -o one.png --frames 5 -q").status, 0);
  ASSERT_EQ(run("render shot.toml -o set.png -q --set 'sphere[0].center=[1,0,-1]' --set 'key=[]'").status, 0);
  EXPECT_EQ(run("compare one.png s.05.png -q --fail-above max=0").status, 0);
  EXPECT_EQ(run("compare one.png set.png -q --fail-above max=0").status, 0);
}

TEST_F(BatchFrames, RangeWithoutFramePlaceholderIsRejected) {
  const Outcome range = run("render shot.toml -o s.png --frames 1-5");
  EXPECT_EQ(range.status, 2);
  EXPECT_NE(range.err.find("s.png is one name for 5 frames"), std::string::npos) << range.err;
  const Outcome single = run("render shot.toml -o s.#.png --frames 1-5");
  EXPECT_EQ(single.status, 2);
  EXPECT_NE(single.err.find("; a single # is an ordinary character, so write at least ##\n"), std::string::npos)
      << single.err;
  const Outcome place = run("render shot.toml -o s.##.png");
  EXPECT_EQ(place.status, 2);
  EXPECT_NE(place.err.find("--frames"), std::string::npos) << place.err;
  const Outcome statistics = run("render shot.toml -o s.##.png --frames 1-5 --stats s.json");
  EXPECT_EQ(statistics.status, 2);
  for (const char* text : {"1-", "a", "1-5x0", "5 6", "", "1-99999999", "1,,2"})
    EXPECT_EQ(run(std::string("render shot.toml -o s.##.png --frames '") + text + "'").status, 2) << text;
}

TEST_F(BatchFrames, SkipExistingSkipsCompleteMatchingFiles) {
  const std::string command =
      "render shot.toml -o s.##.exr -o s.##.png -o s.##.jpg -o s.##.tif --frames 1-3 --skip-existing";
  ASSERT_EQ(run(command + " -q").status, 0);
  ASSERT_EQ(run(command + " -q --stats s.##.json").status, 0);
  EXPECT_FALSE(exists("s.01.json"));  // nothing was rendered; an earlier run's statistics must survive
  const std::string first = text_of(folder_ / "s.01.exr"), second = text_of(folder_ / "s.02.exr");
  EXPECT_NE(run(command).err.find("0 of 3 rendered, 3 skipped"), std::string::npos);
  EXPECT_EQ(text_of(folder_ / "s.01.exr"), first);

  // Truncated, mismatched and missing files are rendered again. The others stay.
  write("s.02.exr", second.substr(0, second.size() / 2));
  EXPECT_NE(run(command).err.find("1 of 3 rendered, 2 skipped"), std::string::npos);
  write("s.02.png", text_of(folder_ / "s.03.png"));
  EXPECT_NE(run(command).err.find("1 of 3 rendered, 2 skipped"), std::string::npos);
  std::filesystem::remove(folder_ / "s.03.jpg");
  EXPECT_NE(run(command).err.find("1 of 3 rendered, 2 skipped"), std::string::npos);
  EXPECT_EQ(text_of(folder_ / "s.01.exr"), first);

  // Other settings give another image, even those that no EXR pixel depends on.
  for (const char* other :
       {"--samples 5", "--type float", "--set color.exposure=1", "--layers Z", "--bits 16", "--compression zip"}) {
    ASSERT_EQ(run(command + " -q").status, 0);
    const Outcome r = run(command + " " + (std::string(other) == "--bits 16" ? "" : other));
    EXPECT_NE(r.err.find(std::string(other) == "--bits 16" ? "0 of 3" : "3 of 3"), std::string::npos) << other << "\n"
                                                                                                      << r.err;
  }
}

TEST_F(BatchFrames, FailedFrameIsReportedAndTheOthersRender) {
  for (const int frame : {1, 3}) write("cloud." + std::to_string(frame) + ".ply", kPly);
  write("cloud.toml", animated() + "[[points]]\nfile = \"cloud.%d.ply\"\nmaterial = \"grey\"\n");
  const Outcome r = run("render cloud.toml -o c.##.png --frames 1-3");
  EXPECT_EQ(r.status, 66);
  EXPECT_TRUE(exists("c.01.png"));
  EXPECT_FALSE(exists("c.02.png"));
  EXPECT_TRUE(exists("c.03.png"));
  EXPECT_NE(r.err.find("cloud.2.ply"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("2 of 3 rendered, 0 skipped, 1 failed\nfailed: frame 2 of cloud.toml"), std::string::npos)
      << r.err;
}

TEST_F(BatchFrames, ScenePlaceholderNamesSeveralScenes) {
  const Outcome r = run("render good.toml shot.toml -o {scene}.##.png --frames 1-2 -q");
  ASSERT_EQ(r.status, 0) << r.err;
  for (const char* name : {"good.01.png", "good.02.png", "shot.01.png", "shot.02.png"}) EXPECT_TRUE(exists(name));
  EXPECT_EQ(run("render good.toml shot.toml -o a.png").status, 2);
  std::filesystem::create_directory(folder_ / "other");
  write("other/good.toml", animated());
  const Outcome same = run("render good.toml other/good.toml -o {scene}.png");
  EXPECT_EQ(same.status, 2);
  EXPECT_NE(same.err.find("good.png (-o of other/good.toml) and good.png (-o of good.toml) are the same file"),
            std::string::npos)
      << same.err;
}

TEST_F(BatchFrames, TurntableIsPeriodic) {
  const std::string turn = " --set animation.turntable=4 --samples 4 -q ";
  ASSERT_EQ(run("render shot.toml -o t.##.png --frames 1,3,5" + turn + "--set 'key=[]'").status, 0);
  EXPECT_EQ(run("compare t.01.png t.05.png -q --fail-above max=0").status, 0);
  EXPECT_NE(run("compare t.01.png t.03.png -q --fail-above max=0.01").status, 0);
}

}  // namespace
}  // namespace orrery::test
