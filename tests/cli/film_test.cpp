// SPDX-License-Identifier: Apache-2.0
// Films and annotated images of the command plot.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "cli/program.h"
#include "support/mentions.h"

namespace orrery::test {
namespace {

class CliFilm : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::string dump;
    for (int step = 0; step < 3; ++step)
      dump +=
          "ITEM: TIMESTEP\n" + std::to_string(100 * step) +
          "\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\nITEM: ATOMS id type x y z radius\n"
          "1 1 " +
          std::to_string(step) + " 0 0 1\n";
    write("a.dump", dump);
    // Programs in place of ffmpeg: one that copies its input, one that fails, and one that hides a failure.
    write_program("copies/ffmpeg", "for last; do :; done; exec cat > \"${last#file:}\"");
    write_program("fails/ffmpeg", "head -c 100 > /dev/null; echo first >&2; echo out of luck >&2; exit 3");
    write_program("hides/ffmpeg",
                  "for last; do :; done; head -c 100 > \"${last#file:}\"; cat > /dev/null; echo disk full >&2");
    // Programs that end with status 0 without a film: before they have read everything, and without output.
    write_program("stops/ffmpeg", "for last; do :; done; head -c 100 > \"${last#file:}\"");
    write_program("forgets/ffmpeg", "cat > /dev/null");
    // One that never ends.
    write_program("hangs/ffmpeg", "cat > /dev/null; echo $$ > ffmpeg.pid; exec sleep 1000000");
  }
  void write_program(const std::string& name, const std::string& script) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    write(name, "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
  }
  Outcome film(const std::string& arguments, const std::string& ffmpeg = "copies") {
    return run("plot a.dump --width 17 --height 9 --samples 1 " + arguments, "PATH=\"$PWD/" + ffmpeg + ":$PATH\"");
  }
  struct Encoding {
    pid_t program = 0, encoder = 0;
  };
  /// Starts a command, and waits until its encoder has all frames. The encoder is 0 if the command has ended before.
  Encoding start_encoding() const {
    std::filesystem::remove(folder_ / "ffmpeg.pid");
    const std::string path = (folder_ / "hangs").string() + ":" + std::getenv("PATH");
    Encoding out;
    out.program = fork();
    if (out.program == 0) {
      if (chdir(folder_.c_str()) != 0) _exit(126);
      setenv("PATH", path.c_str(), 1);
      setenv("TMPDIR", ".", 1);
      dup2(open(".err", O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600), STDERR_FILENO);
      execl(ORRERY_PROGRAM, "orrery", "plot", "a.dump", "-o", "a.mp4", "--frames", "all", "--width", "17", "--height",
            "9", "--samples", "1", nullptr);
      _exit(127);
    }
    std::string pid;
    while (!pid.ends_with('\n') && waitpid(out.program, nullptr, WNOHANG) == 0) pid = text_of(folder_ / "ffmpeg.pid");
    if (pid.ends_with('\n')) out.encoder = std::stoi(pid);
    return out;
  }
  static int status_of(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// Number of temporary files and folders, in the folder of the film, which is also that of temporary files.
  int unfinished_files() const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      count += name.starts_with(".a.mp4.") || contains(name, "orrery");
    }
    return count;
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
};

TEST_F(CliFilm, HasAllFramesInOrder) {
  const Outcome r = film("-o a.mp4 --frames all --keep-frames");
  ASSERT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(contains(r.err, "wrote a.mp4: 3 frames, 24 frames per second\n")) << r.err;
  std::string all;
  for (const char* frame : {"1", "2", "3"})
    all += text_of(folder_ / "a.mp4.frames" / ("frame.00000" + std::string(frame) + ".png"));
  EXPECT_EQ(text_of(folder_ / "a.mp4"), all);
  ASSERT_EQ(film("-o a.mp4 --frames 3,1").status, 0);
  EXPECT_FALSE(exists("a.mp4.frames/frame.000001.png")) << "removed";
  EXPECT_TRUE(exists("a.mp4.frames/frame.000002.png")) << "of another command";
}

TEST_F(CliFilm, AFailureKeepsTheFramesForTheNextCommand) {
  const Outcome failed = film("-o a.gif --frames all", "fails");
  EXPECT_EQ(failed.status, 74);
  EXPECT_TRUE(mentions(failed.err, {"a.gif: ffmpeg", "status 3: out of luck", "a.gif.frames", "continues"}));
  EXPECT_FALSE(exists("a.gif") || exists("a.gif.part"));
  const Outcome r = film("-o a.gif --frames all");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(contains(r.err, "3 skipped")) << r.err;
  EXPECT_TRUE(exists("a.gif"));
  EXPECT_FALSE(exists("a.gif.frames"));
}

TEST_F(CliFilm, AnErrorWithStatusZeroKeepsTheOldFilmAndTheFrames) {
  ASSERT_EQ(film("-o a.gif --frames 1").status, 0);
  const std::string old = text_of(folder_ / "a.gif");
  const Outcome failed = film("-o a.gif --frames all", "hides");
  EXPECT_EQ(failed.status, 74);
  EXPECT_TRUE(contains(failed.err, "disk full; the frames are in")) << failed.err;
  EXPECT_EQ(text_of(folder_ / "a.gif"), old);
  EXPECT_FALSE(exists("a.gif.part"));
  EXPECT_TRUE(exists("a.gif.frames/frame.000003.png"));
}

TEST_F(CliFilm, AnEncoderThatEndsEarlyHasFailed) {
  for (const auto& [ffmpeg, reason] :
       {std::pair{"stops", "ended before it had read all frames"}, std::pair{"forgets", "wrote an empty file"}}) {
    const Outcome failed = film("-o a.mp4 --frames all", ffmpeg);
    EXPECT_EQ(failed.status, 74);
    EXPECT_TRUE(contains(failed.err, reason)) << failed.err;
    EXPECT_FALSE(exists("a.mp4"));
    EXPECT_TRUE(exists("a.mp4.frames/frame.000003.png"));
  }
}

TEST_F(CliFilm, IsWrittenLikeAnImage) {
  write("victim", "theirs");
  std::filesystem::create_symlink("victim", folder_ / "link.mp4.part");
  std::filesystem::create_symlink("target.mp4", folder_ / "link.mp4");
  ASSERT_EQ(film("-o link.mp4 --frames 1").status, 0);
  EXPECT_EQ(text_of(folder_ / "victim"), "theirs");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.mp4"));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / "target.mp4"));
}

TEST_F(CliFilm, IsAnOutputOfItsCommand) {
  for (const char* files : {"--stats z.mp4 -o z.mp4", "-o z.mp4 -o ./z.mp4", "-o z.mp4 --legend z.mp4",
                            "-o z.mp4 --save-scene z.mp4", "-o z.mp4 --preview z.mp4"}) {
    EXPECT_EQ(film(std::string(files) + " --frames all").status, 2) << files;
    EXPECT_FALSE(exists("z.mp4.frames")) << files;
  }
  std::filesystem::copy_file(folder_ / "a.dump", folder_ / "a.mp4");
  EXPECT_EQ(run("plot a.mp4 --format lammps -o a.mp4 --frames all", "PATH=\"$PWD/copies:$PATH\"").status, 2);
}

TEST_F(CliFilm, TwoCommandsDoNotWriteOneFilm) {
  std::filesystem::create_directory(folder_ / "a.mp4.frames");
  const int other = open((folder_ / "a.mp4.frames").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  const Outcome second = film("-o a.mp4 --frames all");
  EXPECT_EQ(second.status, 73);
  EXPECT_TRUE(contains(second.err, "another command is writing a.mp4")) << second.err;
  close(other);
  EXPECT_EQ(film("-o a.mp4 --frames all").status, 0);
}

TEST_F(CliFilm, ASignalStopsTheEncoder) {
  for (const int number : {SIGINT, SIGTERM}) {
    const Encoding encoding = start_encoding();
    ASSERT_GT(encoding.encoder, 0) << text_of(folder_ / ".err");
    kill(encoding.program, number);
    EXPECT_EQ(status_of(encoding.program), 75);
    EXPECT_NE(kill(encoding.encoder, 0), 0) << "it is still running";
    EXPECT_TRUE(contains(text_of(folder_ / ".err"), "the frames are in a.mp4.frames")) << text_of(folder_ / ".err");
    EXPECT_TRUE(exists("a.mp4.frames/frame.000003.png"));
    EXPECT_EQ(unfinished_files(), 0);
  }
  EXPECT_EQ(film("-o a.mp4 --frames all").status, 0);
}

TEST_F(CliFilm, TheEncoderOfAKilledCommandEndsAndTheNextCommandCleansUp) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const Encoding encoding = start_encoding();
  ASSERT_GT(encoding.encoder, 0) << text_of(folder_ / ".err");
  kill(encoding.program, SIGKILL);
  EXPECT_EQ(status_of(encoding.program), 128 + SIGKILL);
  EXPECT_EQ(status_of(encoding.encoder), 128 + SIGKILL);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
  EXPECT_EQ(unfinished_files(), 1);
  const Outcome next = film("-o a.mp4 --frames all");
  EXPECT_EQ(next.status, 0) << next.err;
  EXPECT_TRUE(contains(next.err, "3 skipped")) << next.err;
  EXPECT_EQ(unfinished_files(), 0);
}

TEST_F(CliFilm, TheEncoderDoesNotInheritIgnoredSignals) {
  // The last digits of the mask of ignored signals, without those of the C library.
  const std::string ignored = "sed -n 's/^SigIgn:.*\\(.......\\)$/\\1/p' /proc/self/status > ";
  write_program("looks/ffmpeg",
                ignored + "signals; cat > /dev/null; for last; do :; done; echo film > \"${last#file:}\"");
  ASSERT_EQ(run("plot a.dump -o a.mp4 --frames 1 --width 17 --height 9 --samples 1",
                ignored + "expected; PATH=\"$PWD/looks:$PATH\"")
                .status,
            0);
  EXPECT_EQ(text_of(folder_ / "signals"), text_of(folder_ / "expected"));
}

TEST_F(CliFilm, TurntablesHaveTheFramesOfTheirTime) {
  const Outcome r = film("-o a.mp4 --turntable 0.5s --fps 10 --keep-frames");
  ASSERT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(contains(r.err, "wrote a.mp4: 5 frames, 10 frames per second\n")) << r.err;
  EXPECT_TRUE(contains(r.err, "the whole orbit")) << r.err;
  EXPECT_TRUE(film("-o b.mp4 --turntable 0.5s --frames 1-2").err.find("wrote b.mp4: 2 frames") != std::string::npos);
}

TEST_F(CliFilm, RequestsThatCannotBeMetAreRefused) {
  EXPECT_TRUE(contains(film("-o a.mp4").err, "a.mp4 is a film"));
  EXPECT_TRUE(contains(film("-o a.mp4 --frames all --transparent").err, "a.mp4 is a film, which is opaque"));
  EXPECT_TRUE(contains(film("-o a.mp4 -o b.gif --frames all --fps 60").err, "b.gif: a GIF has at most 50 frames"));
  EXPECT_EQ(film("-o b.gif --frames all --fps 50").status, 0);
  EXPECT_TRUE(contains(run("plot a.dump -o a.mp4 --frames all --height 1").err, "a video is at least 2 pixels"));
  EXPECT_EQ(film("-o no/a.mp4 --frames all").status, 73);
  const Outcome none = run("plot a.dump -o a.mp4 --frames all", "PATH=/nowhere");
  EXPECT_EQ(none.status, 73);
  EXPECT_TRUE(contains(none.err, "install the package ffmpeg")) << none.err;
  EXPECT_FALSE(exists("a.mp4.frames")) << "empty folders do not stay";
}

/// By the real program, where it is installed, as in the tests of packages.
TEST_F(CliFilm, FfmpegReadsTheFrames) {
  if (std::system("command -v ffmpeg ffprobe > /dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  ASSERT_EQ(run("plot a.dump -o a.mp4 --frames all --width 33 --height 17 --samples 1 -q").status, 0);
  const std::string probe = "cd '" + folder_.string() +
                            "' && ffprobe -v error -show_entries "
                            "stream=width,height,pix_fmt,color_space,color_transfer,nb_frames -of csv a.mp4 > probe";
  ASSERT_EQ(std::system(probe.c_str()), 0);
  EXPECT_EQ(text_of(folder_ / "probe"), "stream,32,16,yuv420p,bt709,iec61966-2-1,3\n");
}

TEST_F(CliFilm, AnnotationsOfASavedSceneAreTheSame) {
  const std::string options =
      "--title 'step {step}' --scale-bar '1 nm' --color-bar --outline 1 --label 'id == 1: A' --frame 2 ";
  Outcome r = film(options + "-o a.ppm -o a.exr --save-scene a.toml");
  ASSERT_EQ(r.status, 0) << r.err;
  ASSERT_EQ(run("render a.toml --samples 1 --frames 2 -o b.##.ppm -q").status, 0);
  EXPECT_EQ(text_of(folder_ / "a.ppm"), text_of(folder_ / "b.02.ppm"));
  std::string plain = text_of(folder_ / "a.toml");
  const std::size_t table = plain.find("[annotation]");
  ASSERT_NE(table, std::string::npos);
  support::write_bytes(folder_ / "c.toml", plain.erase(table, plain.find("\n[", table) - table));
  ASSERT_EQ(run("render c.toml --samples 1 --frames 2 -o c.ppm -o c.exr -q").status, 0);
  EXPECT_NE(text_of(folder_ / "a.ppm"), text_of(folder_ / "c.ppm"));
  ASSERT_EQ(run("develop a.exr -o d.ppm -q").status, 0);
  ASSERT_EQ(run("develop c.exr -o e.ppm -q").status, 0);
  EXPECT_EQ(text_of(folder_ / "d.ppm"), text_of(folder_ / "e.ppm")) << "the beauty is without annotation";
  EXPECT_TRUE(contains(text_of(folder_ / "a.exr"), "annotation.R"));
  r = film("--frame 2 --title '漢' -o c.png");
  EXPECT_EQ(r.status, 0);
  EXPECT_TRUE(contains(r.err, "has no glyphs for `漢`")) << r.err;
}

TEST_F(CliFilm, SkippedImagesHaveTheSameAnnotation) {
  ASSERT_EQ(film("-o a.png --title A").status, 0);
  EXPECT_TRUE(contains(film("-o a.png --title A --skip-existing").err, "skipped"));
  EXPECT_FALSE(contains(film("-o a.png --title B --skip-existing").err, "skipped"));
}

TEST_F(CliFilm, InvalidAnnotationsAreRefused) {
  EXPECT_TRUE(contains(film("-o a.png --scale-bar auto --perspective 30").err, "depends on its distance"));
  EXPECT_TRUE(contains(film("-o a.png --scale-bar nm").err, "`nm` is not a length"));
  EXPECT_EQ(film("-o a.png --scale-bar 0").status, 2);
  EXPECT_EQ(film("-o a.png --label x").status, 65);
  EXPECT_EQ(film("-o a.png --title '{foo}'").status, 65);
  EXPECT_EQ(film("-o a.png --outline 65").status, 2);
  EXPECT_EQ(film("-o a.png --title a --font NoSuchFont").status, 66);
  EXPECT_TRUE(contains(film("-o a.png --title a --font ./no.ttf").err, "no.ttf; set --font"));
  EXPECT_EQ(run("render good.toml -o a.png --set annotation.scale_bar=1").status, 65) << "a perspective camera";
}

}  // namespace
}  // namespace orrery::test
