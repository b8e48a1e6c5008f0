// SPDX-License-Identifier: Apache-2.0
// --preview: viewers and files, and that the image does not depend on them.
#include <cstdint>
#include <cstring>
#include <tuple>
#include <vector>

#include "cli/program.h"
#include "support/tev_server.h"

namespace orrery::test {
namespace {

class CliPreview : public ProgramTest {
 protected:
  /// Renders good.toml to FILE with further options; the image must be the same whatever they are.
  Outcome render(const std::string& file, const std::string& options) {
    return run("render good.toml -q --reproducible --type float -o " + file + " " + options);
  }
};

/// R, G, B of all pixels of an uncompressed EXR with float channels A, B, G, R, which ends with its rows: y, size in
/// bytes, and the values of one channel after the other.
std::vector<float> rows_of_exr(const std::filesystem::path& file, int width, int height) {
  const std::string bytes = text_of(file);
  const std::size_t row = 2 * sizeof(std::int32_t) + 4 * sizeof(float) * static_cast<std::size_t>(width);
  const std::size_t begin = bytes.size() - row * static_cast<std::size_t>(height);
  std::vector<float> out;
  for (int y = 0; y < height; ++y) {
    const char* const at = bytes.data() + begin + row * static_cast<std::size_t>(y);
    std::int32_t stored_y = -1;
    std::memcpy(&stored_y, at, sizeof(stored_y));
    EXPECT_EQ(stored_y, y);
    for (int x = 0; x < width; ++x)
      for (const int channel : {3, 2, 1}) {
        float value = 0;
        std::memcpy(&value,
                    at + 2 * sizeof(std::int32_t) + sizeof(float) * static_cast<std::size_t>(channel * width + x),
                    sizeof(value));
        out.push_back(value);
      }
  }
  return out;
}

TEST_F(CliPreview, TheImageHasTheSameBits) {
  ASSERT_EQ(render("plain.exr", "").status, 0);
  ASSERT_EQ(render("adaptive.exr", "--noise 0.05").status, 0);
  const std::string plain = text_of(folder_ / "plain.exr"), adaptive = text_of(folder_ / "adaptive.exr");
  TevServer server(TevServer::Manner::kReads);
  for (const std::string& where : {std::string("p.png"), server.target()}) {
    EXPECT_EQ(render("a.exr", "--preview " + where).status, 0);
    EXPECT_TRUE(text_of(folder_ / "a.exr") == plain) << where;
    EXPECT_EQ(render("a.exr", "--noise 0.05 --preview " + where).status, 0);
    EXPECT_TRUE(text_of(folder_ / "a.exr") == adaptive) << where;
  }
  EXPECT_EQ(server.images().at("good.toml").creations, 2);
}

TEST_F(CliPreview, TheFileIsTheImageInTheEnd) {
  for (const char* options : {"", "--noise 0.05", "--set color.exposure=1 --set color.display=\"Gamma 2.0 Rec.709\""}) {
    ASSERT_EQ(render("a.png", std::string("--preview p.png ") + options).status, 0);
    EXPECT_EQ(run("compare a.png p.png --fail-above max=0").status, 0) << options;
  }
  ASSERT_EQ(run("render good.toml -q -o a.png --preview p.png --denoise").status, 0);
  EXPECT_EQ(run("compare a.png p.png --fail-above max=0").status, 0) << "denoised";
}

TEST_F(CliPreview, TevHasTheImageInTheEnd) {
  // A shape that tells rows from columns.
  TevServer server(TevServer::Manner::kReads);
  ASSERT_EQ(render("a.exr", "--compression none --preview " + server.target()).status, 0);
  const TevImage image = server.images().at("good.toml");
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.height, 18);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  ASSERT_EQ(image.values.size(), 3 * 32 * 18u);
  EXPECT_EQ(image.values, rows_of_exr(folder_ / "a.exr", 32, 18));
}

TEST_F(CliPreview, ViewersThatHangLeaveOrAreMissingAreNotErrors) {
  for (const TevServer::Manner manner : {TevServer::Manner::kHangs, TevServer::Manner::kLeaves}) {
    TevServer server(manner);
    const Outcome outcome = run("render good.toml -o a.png --width 640 --height 360 --preview " + server.target());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("orrery:"), std::string::npos) << outcome.err;
  }
  int port = 0;
  { port = TevServer(TevServer::Manner::kReads).port(); }
  const Outcome outcome = run("render good.toml -o a.png --preview tev:127.0.0.1:" + std::to_string(port));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("warning: tev cannot be reached at 127.0.0.1:"), std::string::npos) << outcome.err;
}

TEST_F(CliPreview, RejectsBadRequestsBeforeAnyFileIsTouched) {
  const std::string before = text_of(folder_ / "good.toml");
  write("cloud.csv", "x,y,z\n0,0,0\n");
  for (const auto& [arguments, status, text] : std::vector<std::tuple<std::string, int, std::string>>{
           {"render good.toml -o a.png --preview foo", 2,
            "`foo` is not a preview; write tev, tev:HOST:PORT, or the name"},
           {"render good.toml -o a.png --preview a.png", 2, "are the same file"},
           {"render good.toml -o a.png --preview none/p.png", 73, "directory none does not exist"},
           {"render good.toml -o a.exr --preview p.png --set color.view=Foo", 65, "Foo"},
           {"render good.toml -o a.png --preview terminal", 2, "`terminal` is not a preview"},
           {"plot cloud.csv -o a.png --radius 1 --legend p.png --preview p.png", 2, "are the same file"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << arguments << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << arguments << outcome.err;
  }
  EXPECT_EQ(file_count(), 1);  // cloud.csv
  EXPECT_EQ(text_of(folder_ / "good.toml"), before);
}

TEST_F(CliPreview, FramesShareOneFile) {
  const Outcome outcome = run("render good.toml -o a.##.png --frames 1-3 --preview p.png");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(file_count(), 4);
}

TEST_F(CliPreview, PlotHasAPreview) {
  write("cloud.csv", "x,y,z\n0,0,0\n1,0,0\n");
  const Outcome outcome = run("plot cloud.csv --radius 1 -o a.png --width 40 --height 30 --preview p.png");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(run("compare a.png p.png --fail-above max=0").status, 0);
}

}  // namespace
}  // namespace orrery::test
