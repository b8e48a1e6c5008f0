// SPDX-License-Identifier: Apache-2.0
// Inherited process state, and signals that arrive during startup.
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>
#include <regex>
#include <utility>
#include <vector>

#include "cli/program.h"

namespace orrery::test {
namespace {

constexpr char kStubs[] = "orrery-image-stubs";  // a folder beside the modules

class CliLauncher : public ProgramTest {
 protected:
  /// Runs `orrery WORDS`; calls `prepare` in the child process before exec.
  ///
  /// Result     exit status, or 128 + the signal that ended the process
  int run_prepared(std::vector<const char*> words, const std::function<void()>& prepare) {
    words.insert(words.begin(), "orrery");
    words.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) != 0) _exit(126);
      dup2(open(".err", O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
      dup2(open(".out", O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
      signal(SIGPIPE, SIG_DFL);
      signal(SIGUSR1, SIG_DFL);
      prepare();
      execv(ORRERY_PROGRAM, const_cast<char* const*>(words.data()));
      _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  /// What the dynamic loader says about the libraries that `orrery WORDS` loads.
  std::string libraries_of(const std::string& words) {
    const Outcome r = run(words, "LD_DEBUG=files LD_DEBUG_OUTPUT=loader");
    EXPECT_EQ(r.status, 0) << words << r.err;
    return loader_text();
  }

  /// What the dynamic loader wrote to files named `loader`, which are removed.
  std::string loader_text() {
    std::string text;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (entry.path().stem() != "loader") continue;
      text += text_of(entry.path());
      std::filesystem::remove(entry.path());
    }
    EXPECT_TRUE(contains(text, "libOpenColorIO")) << "LD_DEBUG has no effect";
    return text;
  }

  /// Leaves USR1 blocked and pending across exec; unblocking delivers it.
  static void raise_blocked() {
    sigset_t usr1;
    sigemptyset(&usr1);
    sigaddset(&usr1, SIGUSR1);
    sigprocmask(SIG_BLOCK, &usr1, nullptr);
    raise(SIGUSR1);
  }

  /// Replaces a file descriptor by a pipe whose read end is closed.
  static void break_pipe(int descriptor) {
    int ends[2];
    if (pipe(ends) != 0) _exit(125);
    close(ends[0]);
    dup2(ends[1], descriptor);
  }
};

TEST_F(CliLauncher, PendingUsr1WritesACheckpoint) {
  EXPECT_EQ(run_prepared({"render", "good.toml", "-o", "a.png"}, raise_blocked), 0);
  EXPECT_NE(text_of(folder_ / ".err").find("wrote a.checkpoint.exr"), std::string::npos) << text_of(folder_ / ".err");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.png"));
}

/// The program that the launcher executes has USR1 blocked, so that the signal cannot end it while its libraries load.
/// Here it is grep, which prints its own mask of blocked signals.
TEST_F(CliLauncher, TheLauncherBlocksUsr1) {
  for (const char* folder : {"bin", "libexec/orrery"}) std::filesystem::create_directories(folder_ / folder);
  std::filesystem::copy_file(ORRERY_PROGRAM, folder_ / "bin/orrery");
  std::filesystem::create_symlink("/bin/grep", folder_ / "libexec/orrery/orrery-program");
  ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && bin/orrery SigBlk: /proc/self/status > .out").c_str()), 0);
  const std::string mask = text_of(folder_ / ".out").substr(8);
  EXPECT_EQ(std::stoull(mask, nullptr, 16) >> (SIGUSR1 - 1) & 1, 1u) << mask;
}

/// The archive for all systems has a loader beside the program. Here it is echo, which prints its arguments.
TEST_F(CliLauncher, TheLauncherStartsTheLoaderBesideTheProgram) {
  for (const char* folder : {"bin", "libexec/orrery"}) std::filesystem::create_directories(folder_ / folder);
  std::filesystem::copy_file(ORRERY_PROGRAM, folder_ / "bin/orrery");
  std::filesystem::create_symlink("/bin/echo", folder_ / "libexec/orrery/orrery-loader");
  ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && bin/orrery info 'a b' > .out").c_str()), 0);
  const std::string program = std::filesystem::canonical(folder_).string() + "/bin/../libexec/orrery/orrery-program";
  EXPECT_EQ(text_of(folder_ / ".out"), "--inhibit-cache --argv0 bin/orrery " + program + " info a b\n");
}

TEST_F(CliLauncher, CheckpointOfTheLongestNameIsWritten) {
  const std::string picture = std::string(251, 'n') + ".exr";
  EXPECT_EQ(run_prepared({"render", "good.toml", "-o", picture.c_str()}, raise_blocked), 0);
  EXPECT_NE(text_of(folder_ / ".err").find(".checkpoint.exr\n"), std::string::npos) << text_of(folder_ / ".err");
  EXPECT_EQ(text_of(folder_ / ".err").find("checkpoint not written"), std::string::npos) << text_of(folder_ / ".err");
  EXPECT_TRUE(std::filesystem::exists(folder_ / picture));
}

TEST_F(CliLauncher, Usr1DoesNotEndOtherCommands) {
  EXPECT_EQ(run_prepared({"info", "good.toml"}, raise_blocked), 0);
  EXPECT_EQ(run_prepared({"generate", "final", "-o", "f.toml"}, raise_blocked), 0);
}

TEST_F(CliLauncher, OnlyCommandsWithImagesLoadOpenImageIO) {
  const auto loads_it = [this](const std::string& words) {
    const std::string loaded = libraries_of(words);
    for (const char* unused : {"orrery-data", "libarchive"}) EXPECT_FALSE(contains(loaded, unused)) << words;
    return contains(loaded, "libOpenImageIO");
  };
  for (const char* words : {"--help", "--version", "info good.toml", "check good.toml", "generate final -o final.toml",
                            "submit good.toml -o a.####.exr --frames 1-2 --slurm"})
    EXPECT_FALSE(loads_it(words)) << words;
  EXPECT_TRUE(loads_it("render good.toml -o a.exr -q"));
}

/// Copies the program to a new folder, without the image module.
///
/// Result     its command
std::string copied_program(const std::filesystem::path& folder) {
  const std::filesystem::path libexec = std::filesystem::path(ORRERY_MODULES);
  std::filesystem::create_directory(folder);
  for (const char* file : {"orrery-program", "orrery-data.so"})
    std::filesystem::copy_file(libexec / file, folder / file);
  return "'" + (folder / "orrery-program").string() + "' ";
}

TEST_F(CliLauncher, AnImageLibraryThatCannotBeLoadedIsReportedBeforeRendering) {
  const std::string program = copied_program(folder_ / "program");
  write("program/orrery-image.so", "no library");
  write("a.csv", "x,y,z\n0,0,0\n3,0,0\n");
  for (const std::string words : {"render good.toml -o a.png", "plot a.csv -o a.png --samples 1"}) {
    const std::string command = "cd '" + folder_.string() + "' && " + program + words + " --progress arnold 2> .err";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 70);
    const std::string err = text_of(folder_ / ".err");
    EXPECT_NE(err.find("cannot load "), std::string::npos) << err;
    EXPECT_EQ(err.find("% done"), std::string::npos) << "it rendered: " << err;
  }
}

/// Sonames of the stub libraries. None where OpenImageIO needs no library that could have one.
std::vector<std::string> stubs() {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(ORRERY_MODULES) / kStubs, none))
    names.push_back(entry.path().filename());
  return names;
}

/// Folders of the libraries that the dynamic loader has initialised.
///
/// `name`     regular expression of their names
std::vector<std::string> folders_of(const std::string& name, const std::string& loader_text) {
  std::vector<std::string> folders;
  const std::regex line("calling init: (.*)/" + name + "\n");
  for (std::sregex_iterator i(loader_text.begin(), loader_text.end(), line), end; i != end; ++i)
    folders.push_back((*i)[1]);
  return folders;
}

TEST_F(CliLauncher, StubsStandInForLibrariesThatNoFormatUses) {
  if (!std::filesystem::exists(std::filesystem::path(ORRERY_MODULES) / kStubs)) GTEST_SKIP() << "ORRERY_STUBS=OFF";
  const std::string loaded = libraries_of("render good.toml -o a.exr -o a.png -q");
  const std::string stub_folder = std::filesystem::path(ORRERY_MODULES) / kStubs;
  // Those that bring most of the others. Not stubs(), which would be empty if none were made.
  for (const std::string& folder : folders_of(R"(lib(opencv_videoio|avcodec|avformat|openvdb)\.so[.0-9]*)", loaded))
    EXPECT_EQ(folder, stub_folder);
  for (const std::string& soname : stubs()) EXPECT_TRUE(contains(loaded, stub_folder + "/" + soname)) << soname;
  write("a.csv", "x,y,z\n0,0,0\n");
  for (const std::string& folder : folders_of(R"(lib(curl|crypto|xml2)\.so[.0-9]*)", libraries_of("info a.csv")))
    EXPECT_EQ(folder, std::filesystem::path(ORRERY_MODULES) / "orrery-data-stubs");
}

TEST_F(CliLauncher, AStubThatLacksASymbolIsNotUsed) {
  const std::vector<std::string> sonames = stubs();
  if (sonames.empty()) GTEST_SKIP() << "OpenImageIO needs no library that could have a stub";
  const std::string program = copied_program(folder_ / "program");
  std::filesystem::copy_file(std::filesystem::path(ORRERY_MODULES) / "orrery-image.so",
                             folder_ / "program/orrery-image.so");
  const std::filesystem::path stub = folder_ / "program" / kStubs / sonames.front();
  std::filesystem::create_directory(stub.parent_path());
  ASSERT_EQ(std::system(("'" ORRERY_COMPILER "' -shared -Wl,-soname," + sonames.front() + " -x c++ /dev/null -o '" +
                         stub.string() + "'")
                            .c_str()),
            0);
  const std::string command = "cd '" + folder_.string() + "' && LD_DEBUG=files LD_DEBUG_OUTPUT=loader " + program +
                              "render good.toml -o a.exr -q";
  EXPECT_EQ(std::system(command.c_str()), 0);
  const std::string loaded = loader_text();
  EXPECT_TRUE(contains(loaded, stub.string())) << "the stub was not tried";
  const std::vector<std::string> folders = folders_of(sonames.front(), loaded);
  ASSERT_FALSE(folders.empty());
  EXPECT_NE(folders.back(), stub.parent_path()) << "the library is not loaded";
}

TEST_F(CliLauncher, AnErrorDoesNotWaitForTheImageLibrary) {
  const std::string program = copied_program(folder_ / "program");
  // Opening a pipe that nobody writes to takes forever.
  ASSERT_EQ(mkfifo((folder_ / "program/orrery-image.so").c_str(), 0600), 0);
  write("bad.toml", "[image]\nwidth = 0\n");
  write("a.csv", "x,y,z\n0,0,0\n");
  // The second error is found after the spheres were checked in parallel.
  for (const auto& [words, status] : {std::pair{"render bad.toml -o a.png", 65},
                                      {"render good.toml -o a.png --samples x", 65},
                                      {"plot missing.csv -o a.png", 66},
                                      {"plot a.csv -o a.png --select 'w>0'", 65}}) {
    const std::string command = "cd '" + folder_.string() + "' && timeout -s KILL 60 " + program + words + " 2> .err";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), status) << text_of(folder_ / ".err");
  }
}

TEST_F(CliLauncher, BrokenStderrPipeDoesNotStopTheRender) {
  EXPECT_EQ(run_prepared({"render", "good.toml", "-o", "a.png", "-v"}, [] { break_pipe(2); }), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.png"));
  EXPECT_EQ(run_prepared({"render", "good.toml", "-o", "b.png"},
                         [] {
                           break_pipe(2);
                           dup2(2, 1);
                         }),
            0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "b.png"));
}

/// head(1) has what it wanted: that is no failure, as in other tools.
TEST_F(CliLauncher, ABrokenStdoutPipeIsNoError) {
  for (const std::vector<const char*>& words : std::vector<std::vector<const char*>>{
           {"info", "good.toml"}, {"check", "good.toml"}, {"--help"}, {"--version"}}) {
    EXPECT_EQ(run_prepared(words, [] { break_pipe(1); }), 0) << words[0];
    EXPECT_EQ(text_of(folder_ / ".err"), "") << words[0];
  }
}

TEST_F(CliLauncher, ClosedStdoutExits74) {
  EXPECT_EQ(run_prepared({"info", "good.toml"}, [] { close(1); }), 74);
  EXPECT_NE(text_of(folder_ / ".err"), "");
}

}  // namespace
}  // namespace orrery::test
