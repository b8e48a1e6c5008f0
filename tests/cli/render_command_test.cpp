// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliProgram : public ProgramTest {};

TEST_F(CliProgram, RendersAllFormatsInOneRun) {
  const Outcome r = run("render good.toml -o a.exr -o a.png -o a.jpg -o a.tif -o a.ppm -o a.hdr");
  EXPECT_EQ(r.status, 0) << r.err;
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif", "a.ppm", "a.hdr"})
    EXPECT_GT(std::filesystem::file_size(folder_ / name), 100u) << name;
  EXPECT_TRUE(r.out.empty());
  EXPECT_TRUE(contains(r.err, "100% done")) << "progress is reported without a terminal";
  EXPECT_TRUE(contains(r.err, "wrote a.exr, a.png"));
  EXPECT_EQ(file_count(), 6) << "no temporary files remain";
}

TEST_F(CliProgram, QuietPrintsNothing) {
  const Outcome r = run("render good.toml -o a.png -q");
  EXPECT_EQ(r.status, 0);
  EXPECT_EQ(r.out + r.err, "");
}

TEST_F(CliProgram, ReportsProgressInTheFormatsOfRenderManagers) {
  EXPECT_TRUE(contains(run("render good.toml -o a.png --progress alf").err, "ALF_PROGRESS 100%\n"));
  EXPECT_TRUE(contains(run("render good.toml -o a.png --progress openjd").err, "openjd_progress: 100\n"));
  EXPECT_TRUE(contains(run("render good.toml -o a.png --progress json").err, "{\"progress\": 100"));
  EXPECT_FALSE(contains(run("render good.toml -o a.png --progress none").err, "%"));
}

TEST_F(CliProgram, MissingSceneExits66) {
  const Outcome r = run("render nowhere.toml -o a.png");
  EXPECT_EQ(r.status, 66);
  EXPECT_TRUE(contains(r.err, "nowhere.toml"));
}

TEST_F(CliProgram, InvalidSceneExits65WithAllDiagnosticsAndNoFiles) {
  write("bad.toml", "[image]\nwidht = 3\n[camera]\nvfov = 200\n[render]\nsamples = 0\n");
  const Outcome r = run("render bad.toml -o a.png");
  EXPECT_EQ(r.status, 65);
  EXPECT_EQ(r.err,
            "bad.toml:2:1: error: unknown key `widht` in image; did you mean `width`?\n"
            "    widht = 3\n"
            "    ^~~~~\n"
            "bad.toml:4:8: error: camera.vfov is 200; must be above 0 and below 180\n"
            "    vfov = 200\n"
            "           ^~~\n"
            "bad.toml:6:11: error: render.samples is 0; must be in 1..2147483647\n"
            "    samples = 0\n"
            "              ^\n"
            "orrery: bad.toml: 3 errors\n");
  EXPECT_EQ(file_count(), 0);
}

TEST_F(CliProgram, UnwritableOutputExits73BeforeRendering) {
  // This render would take hours: an exit shows that it did not start.
  const std::string slow = "render good.toml --samples 100000000 ";
  Outcome r = run(slow + "-o nowhere/a.exr");
  EXPECT_EQ(r.status, 73);
  EXPECT_TRUE(contains(r.err, "nowhere"));
  std::filesystem::create_directory(folder_ / "taken.png");
  EXPECT_EQ(run(slow + "-o taken.png").status, 73);
  EXPECT_EQ(run(slow + "-o a.png --stats nowhere/s.json").status, 73);
}

TEST_F(CliProgram, UsageErrorExits2WithASuggestion) {
  Outcome r = run("render good.toml -o a.png --sampels 3");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(contains(r.err, "did you mean `--samples`?")) << r.err;
  r = run("rendr good.toml");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(contains(r.err, "did you mean `render`?")) << r.err;
  EXPECT_EQ(run("").status, 2);
  EXPECT_EQ(run("render good.toml").status, 2) << "no output";
  r = run("render good.toml -o a.webp");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(contains(r.err, "exr, hdr, png")) << r.err;
  EXPECT_EQ(run("render good.toml -o a.png --threads 0").status, 2);
  EXPECT_EQ(run("render good.toml -o a.png", "ORRERY_ISA=mmx").status, 2);
  EXPECT_EQ(run("render good.toml -o a.jpg --bits 16").status, 2);
  r = run("render good.toml -o a.png --set color.view=Filmik --set color.display=sRGB");
  EXPECT_EQ(r.status, 65);
  EXPECT_TRUE(contains(r.err, "Un-tone-mapped")) << r.err;
  EXPECT_EQ(file_count(), 0);
}

TEST_F(CliProgram, FullDiskExits74AndLeavesNoFiles) {
  // A file size limit fails writes like a full disk; ulimit counts in blocks of 512 or 1024 bytes.
  for (const char* name : {"a.exr", "a.png", "a.tif", "a.ppm", "a.hdr"}) {
    const Outcome r =
        run(std::string("render good.toml --width 400 --height 300 --samples 1 -q -o ") + name, "ulimit -f 8 &&");
    EXPECT_EQ(r.status, 74) << name << ": " << r.err;
    EXPECT_EQ(file_count(), 0) << name;
  }
}

TEST_F(CliProgram, ExistingImageSurvivesAFailedWrite) {
  ASSERT_EQ(run("render good.toml -o a.png -q").status, 0);
  const std::string before = text_of(folder_ / "a.png");
  EXPECT_EQ(run("render good.toml --width 400 --height 300 --samples 1 -q -o a.png", "ulimit -f 8 &&").status, 74);
  EXPECT_TRUE(text_of(folder_ / "a.png") == before);
}

TEST_F(CliProgram, NumbersAreDecimal) {
  const Outcome r = run("render good.toml -o a.png -v -t 010");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(contains(r.err, " 10 threads")) << r.err;
}

TEST_F(CliProgram, MemoryLimitIsEnforced) {
  const Outcome r = run("render good.toml -o a.png --memory-limit 1K");
  EXPECT_EQ(r.status, 71);
  EXPECT_TRUE(contains(r.err, "orrery: the render needs about ")) << r.err;
  EXPECT_TRUE(contains(r.err, "--memory-limit allows 1.0 KiB; raise the limit\n")) << r.err;
  EXPECT_EQ(file_count(), 0);
  EXPECT_EQ(run("render good.toml -o a.png --memory-limit 1G").status, 0);
}

TEST_F(CliProgram, OverridesAreValidatedLikeTheFile) {
  const Outcome r = run("render good.toml -o a.png --set camera.vfov=30 --set render.sampels=3");
  EXPECT_EQ(r.status, 65);
  EXPECT_TRUE(contains(r.err,
                       "--set: error: unknown key `sampels` in render; did you mean `samples`?\n"
                       "    --set render.sampels=3\n"
                       "          ^~~~~~~~~~~~~~~~\n"))
      << r.err;
  EXPECT_TRUE(contains(r.err, "did you mean `samples`?")) << r.err;
  EXPECT_EQ(run("render good.toml -o a.png -q --set 'sphere[0].radius=0.25' --set render.precision=fast").status, 0);
}

TEST_F(CliProgram, OneKeyIsSetOnce) {
  const Outcome r = run("render good.toml -o a.png --samples 9 --set render.samples=5");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(contains(r.err, "--samples and --set render.samples=5 set the same key")) << r.err;
}

TEST_F(CliProgram, AFileWhoseNameBeginsWithADashIsTakenForAnOption) {
  write("-dash.toml", "");
  EXPECT_TRUE(contains(run("render -dash.toml -o a.png").err, "write ./-dash.toml"));
  EXPECT_EQ(run("render -" + std::string(5000, 'x') + " -o a.png").status, 2) << "longer than the name of any file";
}

TEST_F(CliProgram, OptionsWithoutEffectAreNamed) {
  EXPECT_TRUE(contains(run("render good.toml -o a.exr --bits 16").err,
                       "warning: --bits has no effect: the bits are those of PNG and TIFF, and none is written\n"));
  EXPECT_TRUE(contains(run("render good.toml -o a.png --type float --multipart").err,
                       "warning: --type, --multipart have no effect"));
  EXPECT_FALSE(contains(run("render good.toml -o a.exr -o a.png --bits 16 --type float").err, "no effect"));
}

TEST_F(CliProgram, StatisticsDescribeTheRender) {
  ASSERT_EQ(run("render good.toml -o a.png -q --stats s.json").status, 0);
  const auto json = nlohmann::json::parse(text_of(folder_ / "s.json"));
  EXPECT_EQ(json["schema"], "orrery.stats/1");
  EXPECT_EQ(json["paths"], 32 * 18 * 4);
  EXPECT_EQ(json["exit_reason"], "completed");
  EXPECT_GT(json["paths_per_second"], 0);
}

TEST_F(CliProgram, ReproducibleFilesAreByteIdentical) {
  ASSERT_EQ(run("render good.toml -o a.exr -q --reproducible").status, 0);
  ASSERT_EQ(run("render good.toml -o b.exr -q --reproducible -t 1").status, 0);
  EXPECT_TRUE(text_of(folder_ / "a.exr") == text_of(folder_ / "b.exr"));
  ASSERT_EQ(run("render good.toml -o c.exr -q --reproducible --set render.accelerator=list").status, 0);
  EXPECT_TRUE(text_of(folder_ / "a.exr") == text_of(folder_ / "c.exr"));
}

TEST_F(CliProgram, DevelopMatchesRender) {
  ASSERT_EQ(run("render good.toml -o a.exr -o a.ppm -q --type float --set color.display='Gamma 2.0 Rec.709'").status,
            0);
  ASSERT_EQ(run("develop a.exr -o b.ppm --display 'Gamma 2.0 Rec.709'").status, 0);
  EXPECT_TRUE(text_of(folder_ / "a.ppm") == text_of(folder_ / "b.ppm"));
  EXPECT_EQ(run("develop a.exr -o b.exr").status, 2);
  EXPECT_EQ(run("develop missing.exr -o b.png").status, 66);
  write("noise.exr", std::string(5000, 'x'));
  EXPECT_EQ(run("develop noise.exr -o b.png").status, 65);
}

TEST_F(CliProgram, SkiesRenderAndFollowKeyframes) {
  write("sky.toml", text_of(folder_ / "good.toml") +
                        "[background]\ntype = \"sky\"\nturbidity = 4\n"
                        "[[key]]\ntarget = \"background.sun_elevation\"\nframes = [1, 2]\nvalues = [40, -10]\n");
  ASSERT_EQ(run("render sky.toml -o a.####.ppm -q --frames 1-2 --threads 1").status, 0);
  ASSERT_EQ(run("render sky.toml -o b.####.ppm -q --frames 1-2 --threads 3").status, 0);
  EXPECT_EQ(text_of(folder_ / "a.0001.ppm"), text_of(folder_ / "b.0001.ppm"));
  EXPECT_EQ(text_of(folder_ / "a.0002.ppm"), text_of(folder_ / "b.0002.ppm"));
  EXPECT_NE(text_of(folder_ / "a.0001.ppm"), text_of(folder_ / "a.0002.ppm"));
  EXPECT_TRUE(contains(run("info sky.toml").out, "background  sky: 512 x 256, lin_rec709\n"));
  EXPECT_TRUE(contains(run("check good.toml --set background.turbidity=4").err, "set background.type to \"sky\""));
}

TEST_F(CliProgram, InvalidOcioConfigExits65AndAMissingOne66) {
  write("broken.ocio", "not a config");
  EXPECT_EQ(run("render good.toml -o a.png --set color.config=broken.ocio").status, 65);
  EXPECT_EQ(run("render good.toml -o a.png --set color.config=nowhere.ocio").status, 66);
  EXPECT_EQ(run("render good.toml -o a.png -q", "OCIO=").status, 0);
}

TEST_F(CliProgram, HelpAndVersionSucceed) {
  for (const char* command :
       {"", "render", "info", "check", "generate", "generate final", "generate cloud", "develop", "compare"}) {
    const Outcome r = run(std::string(command) + " --help");
    EXPECT_EQ(r.status, 0);
    EXPECT_TRUE(contains(r.out, "Usage: orrery") && r.err.empty()) << command;
    EXPECT_TRUE(contains(r.out, "Example") || *command == '\0') << command;
  }
  EXPECT_TRUE(contains(run("--version").out, "Embree"));
}

}  // namespace
}  // namespace orrery::test
