// SPDX-License-Identifier: Apache-2.0
// The commands that work on image files. `orrery denoise` and --denoise: they agree, and whatever the program does to
// get an image does not matter.
#include <algorithm>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliDevelop : public ProgramTest {};

/// The look of the view Neutral does not grey the page, and edges are mixtures of page and object.
TEST_F(CliDevelop, AnExrFileOfAPlotGivesItsImage) {
  write("a.csv", "x,y,z\n0,0,0\n3,0,0\n");
  ASSERT_EQ(run("plot a.csv -q --samples 16 --width 64 --height 36 -o a.exr -o a.ppm").status, 0);
  ASSERT_EQ(run("develop a.exr -q --view Neutral -o b.ppm").status, 0);
  const std::string a = text_of(folder_ / "a.ppm"), b = text_of(folder_ / "b.ppm");
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(b.substr(b.size() - 3), "\xff\xff\xff") << "the page";
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::abs(static_cast<unsigned char>(a[i]) - static_cast<unsigned char>(b[i])));
  EXPECT_LE(most, 1) << "halves are rounded";
}

class CliDenoise : public ProgramTest {
 protected:
  std::string bytes(const char* file) const { return text_of(folder_ / file); }
};

TEST_F(CliDenoise, ThreadsAndInstructionSetDoNotMatter) {
  const std::string render = "render good.toml -q --reproducible --denoise --samples 8 -o ";
  ASSERT_EQ(run(render + "a.exr -t 1").status, 0);
  ASSERT_EQ(run(render + "a.ppm -o with.exr -t 1").status, 0);
  ASSERT_EQ(run(render + "b.exr -t 2", "ORRERY_ISA=avx2").status, 0);
  ASSERT_EQ(run(render + "c.ppm").status, 0) << "a display format alone";
  ASSERT_EQ(run("render good.toml -q --reproducible --samples 8 -o noisy.exr -o noisy.ppm").status, 0);
  EXPECT_TRUE(bytes("a.exr") == bytes("b.exr"));
  EXPECT_TRUE(bytes("a.ppm") == bytes("c.ppm"));
  EXPECT_FALSE(bytes("a.ppm") == bytes("noisy.ppm"));
  EXPECT_NE(bytes("a.exr").find("orrery/denoised"), std::string::npos);
  EXPECT_EQ(bytes("a.exr").find("half_a"), std::string::npos) << "nobody requested the layer";
}

TEST_F(CliDenoise, AFileGivesTheSameImageAsARender) {
  ASSERT_EQ(run("render good.toml -q --type float --samples 8 --layers halves,diffuse -o noisy.exr").status, 0);
  const Outcome denoised = run("denoise noisy.exr -o a.exr");
  ASSERT_EQ(denoised.status, 0);
  EXPECT_EQ(denoised.err, "wrote a.exr: beauty and 2 light layers\n");
  ASSERT_EQ(run("render good.toml -q --type float --samples 8 --layers halves,diffuse --denoise -o b.exr").status, 0);
  EXPECT_NE(run("compare a.exr b.exr").out.find("differing   0 of"), std::string::npos);
}

TEST_F(CliDenoise, ShardsAreDenoisedWhenMerged) {
  const std::string render = "render good.toml -q --reproducible --denoise --samples 8 -o ";
  ASSERT_EQ(run(render + "whole.exr").status, 0);
  ASSERT_EQ(run(render + "1.exr --shard 1/2").status, 0);
  ASSERT_EQ(run(render + "2.exr --shard 2/2").status, 0);
  ASSERT_EQ(run("merge 1.exr 2.exr -q --reproducible --denoise -o merged.exr").status, 0);
  EXPECT_NE(run("compare whole.exr merged.exr").out.find("differing   0 of"), std::string::npos);
  EXPECT_EQ(run("denoise 1.exr -o a.exr").status, 65) << "a shard is no image";
  ASSERT_EQ(run("render good.toml -q --samples 8 --shard 1/2 -o 3.exr").status, 0);
  ASSERT_EQ(run("render good.toml -q --samples 8 --shard 2/2 -o 4.exr").status, 0);
  EXPECT_EQ(run("merge 3.exr 4.exr --denoise -o no.ppm").status, 65);
  for (const char* output : {"no.ppm", "no.exr"})
    EXPECT_NE(run(std::string("merge 3.exr 4.exr --denoise -o ") + output).err.find("have no halves"),
              std::string::npos);
  EXPECT_NE(run("merge 1.exr 2.exr -o no.exr").err.find("merge them with --denoise"), std::string::npos);
  EXPECT_EQ(run("merge 1.exr 2.exr -q -o noisy.ppm").status, 0) << "display formats have no layers";
}

TEST_F(CliDenoise, DeepSamplesAreNotDenoised) {
  EXPECT_EQ(run("render good.toml -o a.exr --deep d.exr --denoise").status, 2);
}

TEST_F(CliDenoise, FilteringTwiceIsAWarning) {
  ASSERT_EQ(run("render good.toml -q --samples 8 --denoise --layers halves -o a.exr").status, 0);
  EXPECT_NE(run("denoise a.exr -o b.exr").err.find("a.exr was denoised already"), std::string::npos);
}

/// One sample has no second half; in a file it is NaN.
TEST_F(CliDenoise, ASingleSampleIsAWarning) {
  const Outcome one = run("render good.toml --type float --samples 1 --denoise -o clean.exr");
  EXPECT_NE(one.err.find("render at least 2 samples per pixel"), std::string::npos) << one.err;
  EXPECT_EQ(run("render good.toml --type float --samples 2 --denoise -o two.exr").err.find("warning"),
            std::string::npos);
  const Outcome halves = run("render good.toml --type float --samples 1 --layers halves -o noisy.exr");
  EXPECT_EQ(halves.err.find("not finite"), std::string::npos) << halves.err;
  EXPECT_NE(run("denoise noisy.exr -o filtered.exr").err.find("not filtered"), std::string::npos);
  for (const char* file : {"clean.exr", "filtered.exr"})
    EXPECT_EQ(run(std::string("compare noisy.exr --fail-above max=0 ") + file).status, 0) << file;
}

TEST_F(CliDenoise, SkipExistingKnowsWhetherAnImageIsDenoised) {
  const std::string render = "render good.toml --samples 8 --skip-existing -o a.exr";
  ASSERT_EQ(run(render).status, 0);
  EXPECT_EQ(run(render + " --denoise").err.find("skipped"), std::string::npos);
  EXPECT_NE(run(render + " --denoise").err.find("skipped"), std::string::npos);
}

TEST_F(CliDenoise, FilesInTilesAreRewrittenInTiles) {
  ASSERT_EQ(
      run("render good.toml -q --samples 8 --layers halves -o rows.exr --type float --width 70 --height 37").status, 0);
  ASSERT_EQ(std::system(("oiiotool '" + (folder_ / "rows.exr").string() + "' --tile 16 16 -o '" +
                         (folder_ / "tiles.exr").string() + "'")
                            .c_str()),
            0);
  ASSERT_EQ(run("denoise rows.exr -o a.exr -q").status, 0);
  EXPECT_EQ(run("denoise tiles.exr -o b.exr -q").status, 0);
  EXPECT_EQ(run("compare a.exr b.exr --fail-above max=0").status, 0);
}

TEST_F(CliDenoise, PartsWithSeparateColorsAreCopiedAndNamed) {
  ASSERT_EQ(run("render good.toml -q --samples 8 --layers halves -o left.exr --type float").status, 0);
  ASSERT_EQ(run("render good.toml -q --samples 8 --layers halves -o right.exr --type float --set render.seed=2").status,
            0);
  const auto file = [&](const char* name) { return "'" + (folder_ / name).string() + "' "; };
  const std::string join = "oiiotool " + file("left.exr") + "--attrib oiio:subimagename left " + file("right.exr") +
                           "--attrib oiio:subimagename right --siappend -o " + file("both.exr");
  ASSERT_EQ(std::system(join.c_str()), 0);
  const Outcome denoised = run("denoise both.exr -o out.exr");
  EXPECT_EQ(denoised.status, 0);
  EXPECT_NE(denoised.err.find("channels R, G and B"), std::string::npos) << denoised.err;
  ASSERT_EQ(std::system(("oiiotool " + file("out.exr") + "--subimage 1 -o " + file("copied.exr")).c_str()), 0);
  EXPECT_EQ(run("compare right.exr copied.exr --fail-above max=0").status, 0);
  EXPECT_EQ(run("compare left.exr out.exr --fail-above max=0").status, 1);
}

TEST_F(CliDenoise, BadInputIsRejected) {
  ASSERT_EQ(run("render good.toml -q --samples 8 -o plain.exr").status, 0);
  const Outcome plain = run("denoise plain.exr -o a.exr");
  EXPECT_EQ(plain.status, 65);
  EXPECT_NE(plain.err.find("--layers halves"), std::string::npos) << plain.err;
  EXPECT_EQ(run("denoise plain.exr -o plain.exr").status, 2);
  EXPECT_EQ(run("denoise plain.exr -o a.png").status, 2);
  EXPECT_EQ(run("denoise missing.exr -o a.exr").status, 66);
  EXPECT_EQ(run("denoise plain.exr -o missing/a.exr").status, 73);
  write("noise.exr", std::string(5000, 'x'));
  EXPECT_EQ(run("denoise noise.exr -o b.exr").status, 65);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.exr"));
}

}  // namespace
}  // namespace orrery::test
