// SPDX-License-Identifier: Apache-2.0
// --preview: the file, and that the image does not depend on it.
#include <tuple>
#include <vector>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliPreview : public ProgramTest {
 protected:
  /// Renders good.toml to FILE with further options; the image must be the same whatever they are.
  Outcome render(const std::string& file, const std::string& options) {
    return run("render good.toml -q --reproducible --type float -o " + file + " " + options);
  }
};

TEST_F(CliPreview, TheImageHasTheSameBits) {
  ASSERT_EQ(render("plain.exr", "").status, 0);
  ASSERT_EQ(render("adaptive.exr", "--noise 0.05").status, 0);
  const std::string plain = text_of(folder_ / "plain.exr"), adaptive = text_of(folder_ / "adaptive.exr");
  EXPECT_EQ(render("a.exr", "--preview p.png").status, 0);
  EXPECT_TRUE(text_of(folder_ / "a.exr") == plain);
  EXPECT_EQ(render("a.exr", "--noise 0.05 --preview p.png").status, 0);
  EXPECT_TRUE(text_of(folder_ / "a.exr") == adaptive);
}

TEST_F(CliPreview, TheFileIsTheImageInTheEnd) {
  for (const char* options : {"", "--noise 0.05", "--set color.exposure=1 --set color.display=\"Gamma 2.0 Rec.709\""}) {
    ASSERT_EQ(render("a.png", std::string("--preview p.png ") + options).status, 0);
    EXPECT_EQ(run("compare a.png p.png --fail-above max=0").status, 0) << options;
  }
  ASSERT_EQ(run("render good.toml -q -o a.png --preview p.png --denoise").status, 0);
  EXPECT_EQ(run("compare a.png p.png --fail-above max=0").status, 0) << "denoised";
}

TEST_F(CliPreview, RejectsBadRequestsBeforeAnyFileIsTouched) {
  const std::string before = text_of(folder_ / "good.toml");
  write("cloud.csv", "x,y,z\n0,0,0\n");
  for (const auto& [arguments, status, text] : std::vector<std::tuple<std::string, int, std::string>>{
           {"render good.toml -o a.png --preview tev", 2, "tev was removed"},
           {"render good.toml -o a.png --preview a.png", 2, "are the same file"},
           {"render good.toml -o a.png --preview none/p.png", 73, "directory none does not exist"},
           {"render good.toml -o a.exr --preview p.png --set color.view=Foo", 65, "Foo"},
           {"render good.toml -o a.png --preview terminal", 2, "`terminal` is not a .png file"},
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
