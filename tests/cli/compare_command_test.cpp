// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/mentions.h"

namespace orrery::test {
namespace {

class CliCompare : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ASSERT_EQ(run("render good.toml -o a.exr -q").status, 0);
    ASSERT_EQ(run("render good.toml -o b.exr -q --set render.seed=2").status, 0);
  }
};

TEST_F(CliCompare, ImageEqualsItself) {
  const Outcome r = run("compare a.exr a.exr --fail-above rmse=0 --fail-above relmse=0 --fail-above max=0");
  EXPECT_EQ(r.status, 0) << r.err;
  for (const char* line : {"images      32 x 18, channels R, G, B\n", "rmse        0\n", "psnr        infinite\n",
                           "ssim        1\n", "flip        0\n", "differing   0 of 2304 values\n"})
    EXPECT_NE(r.out.find(line), std::string::npos) << line << r.out;
}

TEST_F(CliCompare, AnotherSeedDiffersAndExceedsLimits) {
  const Outcome r = run("compare a.exr b.exr --json");
  EXPECT_EQ(r.status, 0);
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_GT(json["rmse"], 0);
  EXPECT_GT(json["max"], json["rmse"]);
  EXPECT_EQ(run("compare a.exr b.exr --fail-above rmse=1 --fail-above max=1").status, 0);
  const Outcome failed = run("compare a.exr b.exr -q --fail-above rmse=1 --fail-above max=0");
  EXPECT_EQ(failed.status, 1);
  EXPECT_EQ(failed.out, "");
  EXPECT_EQ(failed.err.rfind("orrery: max is ", 0), 0u) << failed.err;
}

/// Status 1 means that images differ, and nothing else: an incomplete installation is another status.
TEST_F(CliCompare, InternalErrorsAreNoDifference) {
  const std::filesystem::path program(ORRERY_PROGRAM);
  std::filesystem::copy_file(program, folder_ / "launcher");
  std::filesystem::copy_file(program.parent_path() / "../libexec/orrery/orrery-program", folder_ / "program");
  const std::string words = " compare a.exr a.exr --fail-above max=0";
  EXPECT_EQ(run("--version; ./launcher" + words).status, 70) << "the program is missing";
  EXPECT_EQ(run("--version; ./program" + words).status, 70) << "the module for images is missing";
  EXPECT_EQ(run("--version; \"" ORRERY_PROGRAM "\"" + words).status, 0);
}

/// libpng prints its errors, too.
TEST_F(CliCompare, AnErrorInAPngIsPrintedOnce) {
  constexpr unsigned char kWithoutPixels[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0,    0, 0, 0x0d,
                                              0x49, 0x48, 0x44, 0x52, 0,    0,    0,    4,    0,    0, 0, 4,
                                              8,    2,    0,    0,    0,    0x26, 0x93, 0x09, 0x29, 0, 0, 0,
                                              0,    0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  write("a.png", {reinterpret_cast<const char*>(kWithoutPixels), sizeof(kWithoutPixels)});
  const Outcome r = run("compare a.png a.png");
  EXPECT_EQ(r.status, 65);
  EXPECT_EQ(r.err, "orrery: cannot read image a.png: PNG read error: IEND: out of place\n");
}

TEST_F(CliCompare, UnmatchedLayersAreNamedAndTheRestIsCompared) {
  ASSERT_EQ(run("render good.toml -o z.exr -q --layers Z,variance").status, 0);
  const Outcome r = run("compare z.exr a.exr");
  EXPECT_EQ(r.status, 0);
  EXPECT_EQ(r.err, "warning: only in z.exr: Z, variance\n");
  EXPECT_NE(r.out.find("z-test      no difference but noise"), std::string::npos) << r.out;
  const Outcome z = run("compare z.exr a.exr --layer Z");
  EXPECT_EQ(z.status, 65);
  EXPECT_NE(z.err.find("layer Z"), std::string::npos) << z.err;
  EXPECT_EQ(run("compare a.exr b.exr --fail-above z=1").status, 2);
}

TEST_F(CliCompare, HitLayersAndCryptomattesAreCompared) {
  ASSERT_EQ(run("render good.toml -o l.exr -q --layers Z,CryptoObject").status, 0);
  ASSERT_EQ(run("render good.toml -o m.exr -q --set render.seed=2 --layers Z,CryptoObject").status, 0);
  const auto of = [&](const std::string& layer) {
    const Outcome r = run("compare l.exr m.exr -t 2 --json --layer " + layer);
    EXPECT_EQ(r.status, 0) << r.err;
    return nlohmann::json::parse(r.out);
  };
  const auto z = of("Z"), matte = of("CryptoObject");
  EXPECT_LT(z["max"], 1e6);
  EXPECT_GT(z["no_hit"], 0);
  EXPECT_GT(matte["mae"], 0);
  EXPECT_LE(matte["max"], 1);
}

TEST_F(CliCompare, PartsAreCompared) {
  ASSERT_EQ(run("render good.toml -o one.exr -q --layers Z,N").status, 0);
  ASSERT_EQ(run("render good.toml -o parts.exr -q --layers Z,N --multipart").status, 0);
  const Outcome all = run("compare one.exr parts.exr");
  EXPECT_EQ(all.status, 0) << all.err;
  EXPECT_NE(all.out.find("differing   0 of"), std::string::npos) << all.out;
  EXPECT_EQ(all.out.find("only"), std::string::npos) << all.out;
  for (const char* layer : {"Z", "N"})
    EXPECT_EQ(run(std::string("compare parts.exr parts.exr --layer ") + layer).status, 0);
}

TEST_F(CliCompare, ZTestDetectsABrighterScene) {
  ASSERT_EQ(run("render good.toml -o v.exr -q --layers variance --samples 64").status, 0);
  ASSERT_EQ(run("render good.toml -o w.exr -q --layers variance --samples 64 --set render.seed=9").status, 0);
  ASSERT_EQ(run("render good.toml -o x.exr -q --layers variance --samples 64 --set render.seed=9 --set "
                "background.top=[0.6,0.8,1]")
                .status,
            0);
  EXPECT_NE(run("compare w.exr v.exr").out.find("no difference but noise"), std::string::npos);
  EXPECT_NE(run("compare x.exr v.exr").out.find("differ by more than noise"), std::string::npos);
}

TEST_F(CliCompare, DifferentSizesAndDamagedFilesAreBadData) {
  ASSERT_EQ(run("render good.toml -o c.exr -q --width 16").status, 0);
  const Outcome r = run("compare a.exr c.exr");
  EXPECT_EQ(r.status, 65);
  EXPECT_TRUE(mentions(r.err, {"different sizes", "32 x 18", "16 x 18\n"}));
  write("noise.exr", "noise");
  EXPECT_EQ(run("compare a.exr noise.exr").status, 65);
}

}  // namespace
}  // namespace orrery::test
