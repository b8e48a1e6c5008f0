// SPDX-License-Identifier: Apache-2.0
// --preview: viewers, terminals and files, and that the image does not depend on them.
#include <signal.h>
#include <utmp.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "cli/program.h"
#include "support/pseudo_terminal.h"
#include "support/tev_server.h"

namespace orrery::test {
namespace {

class CliPreview : public ProgramTest {
 protected:
  /// Renders good.toml to FILE with further options; the image must be the same whatever they are.
  Outcome render(const std::string& file, const std::string& options) {
    return run("render good.toml -q --reproducible --type float -o " + file + " " + options);
  }

  /// Runs `orrery WORDS` in a pseudo-terminal with these variables.
  ///
  /// `step`     called with the process whenever the program has printed something
  /// Result     exit status, or 128 + the signal that ended it
  int run_in(PseudoTerminal& terminal, std::vector<const char*> words, std::vector<std::string> variables,
             const std::function<void(pid_t)>& step = {}) {
    words.insert(words.begin(), "orrery");
    words.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
      for (const char* name : {"COLORTERM", "NO_COLOR", "TMUX", "TERM_PROGRAM", "LC_TERMINAL"}) unsetenv(name);
      for (std::string& variable : variables) putenv(variable.data());
      if (chdir(folder_.c_str()) != 0 || login_tty(terminal.slave()) != 0) _exit(126);
      execv(ORRERY_PROGRAM, const_cast<char* const*>(words.data()));
      _exit(127);
    }
    int status = 0;
    // Our own end of the terminal stays open, so that its mode can be read: the end is that of the process.
    std::optional<TerminalReader> reader;
    if (step) {
      while (waitpid(child, &status, WNOHANG) == 0) {
        pollfd readable{terminal.master(), POLLIN, 0};
        if (poll(&readable, 1, 10) > 0) terminal.read_some();
        step(child);
      }
    } else {
      reader.emplace(terminal);
      waitpid(child, &status, 0);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  std::vector<const char*> long_render() const {
    return {"render", "good.toml", "-o",    "a.exr", "--width", "500",       "--height",
            "500",    "--samples", "60000", "-t",    "1",       "--preview", "terminal"};
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
  for (const char* options : {"", "--noise 0.05", "--exposure 1 --display \"Gamma 2.0 Rec.709\""}) {
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
  ::setenv("TERM", "xterm", 1);  // services have none, which would be the first error reported
  const std::string before = text_of(folder_ / "good.toml");
  write("cloud.csv", "x,y,z\n0,0,0\n");
  for (const auto& [arguments, status, text] : std::vector<std::tuple<std::string, int, std::string>>{
           {"render good.toml -o a.png --preview foo", 2, "`foo` is not a preview; write tev, tev:HOST:PORT, terminal"},
           {"render good.toml -o a.png --preview a.png", 2, "are the same file"},
           {"render good.toml -o a.png --preview none/p.png", 73, "directory none does not exist"},
           {"render good.toml -o a.exr --preview p.png --view Foo", 2, "Foo"},
           {"render good.toml -o a.png --preview terminal", 2, "standard error is not a terminal"},
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

TEST_F(CliPreview, TerminalsShowTheImageAsTheyCan) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  const std::vector<const char*> words = {"render", "good.toml", "-o", "a.png", "--preview", "terminal"};
  struct Case {
    const char* answers;
    std::vector<std::string> variables;
    const char* drawing;  ///< what its drawing contains
  };
  for (const Case& c :
       {Case{"\033_Gi=31;OK\033\\\033[6;20;10t\033[?62c", {"TERM=xterm-kitty"}, "\033_Ga=T,f=24,"},
        Case{"\033[?62c", {"TERM=xterm", "TERM_PROGRAM=iTerm.app"}, "\033]1337;File=inline=1;"},
        Case{"\033[?62;4c", {"TERM=xterm"}, "\033P0;1q"},
        Case{"\033[?62c", {"TERM=xterm", "COLORTERM=truecolor"}, "38;2;"}, Case{"", {"TERM=xterm"}, "38;5;"}}) {
    PseudoTerminal terminal(c.answers);
    const termios before = terminal.mode();
    EXPECT_EQ(run_in(terminal, words, c.variables), 0) << terminal.output();
    EXPECT_NE(terminal.last_drawing().find(c.drawing), std::string::npos) << terminal.output();
    EXPECT_NE(terminal.output().find("wrote a.png"), std::string::npos);
    EXPECT_EQ(terminal.mode().c_lflag, before.c_lflag);
  }
}

TEST_F(CliPreview, TerminalsWithoutColoursAreRefused) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  const std::vector<const char*> words = {"render", "good.toml", "-o", "a.png", "--preview", "terminal"};
  for (const std::vector<std::string>& variables :
       std::vector<std::vector<std::string>>{{"TERM=dumb"}, {"TERM=xterm", "NO_COLOR=1"}}) {
    PseudoTerminal terminal;
    EXPECT_EQ(run_in(terminal, words, variables), 2);
    EXPECT_NE(terminal.output().find("; use --preview FILE.png or --preview tev"), std::string::npos);
  }
  EXPECT_EQ(file_count(), 0);
}

TEST_F(CliPreview, SignalsLeaveTheTerminalUsable) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  // Interrupted while the terminal has not answered, and while the image is drawn and the window is resized.
  for (const char* wait_for : {"\033[c", "\0338"}) {
    const bool is_drawn = std::string(wait_for) == "\0338";
    PseudoTerminal terminal(is_drawn ? "\033[?62;4c" : "");
    const termios before = terminal.mode();
    int columns = 80;
    bool sent = false;
    const int status = run_in(terminal, long_render(), {"TERM=xterm"}, [&](pid_t child) {
      if (sent) return;
      const bool is_seen = terminal.output().find(wait_for) != std::string::npos;
      if (is_seen && columns > 60) {
        terminal.resize(columns -= 7, 10);
      } else if (is_seen) {
        kill(child, SIGINT);
        sent = true;
      }
    });
    EXPECT_EQ(status, 75) << terminal.output();
    EXPECT_EQ(terminal.mode().c_lflag, before.c_lflag);
    const bool has_checkpoint = std::filesystem::remove(folder_ / "a.checkpoint.exr");
    if (is_drawn) {
      EXPECT_TRUE(has_checkpoint);
    }
  }
}

TEST_F(CliPreview, ASecondSignalRestoresTheTerminal) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal;  // does not answer, so that the signals arrive while echo is off
  const termios before = terminal.mode();
  bool sent = false;
  run_in(terminal, long_render(), {"TERM=xterm"}, [&](pid_t child) {
    if (sent || (terminal.mode().c_lflag & ECHO) != 0) return;
    sent = true;
    kill(child, SIGINT);
    kill(child, SIGTERM);
  });
  EXPECT_TRUE(sent);
  EXPECT_EQ(terminal.mode().c_lflag, before.c_lflag);
}

TEST_F(CliPreview, ATerminalThatDoesNotReadStopsNoRender) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal("\033[?62;4c");
  bool is_stopped = false;
  const std::vector<const char*> words = {"render",   "good.toml", "-o",        "a.png", "-q",        "--width", "640",
                                          "--height", "360",       "--samples", "200",   "--preview", "terminal"};
  const int status = run_in(terminal, words, {"TERM=xterm"}, [&](pid_t) {
    // As Ctrl-S does: output is suspended from the first drawing on.
    if (is_stopped || terminal.output().find("\033P0;1q") == std::string::npos) return;
    is_stopped = true;
    tcflow(terminal.slave(), TCOOFF);
  });
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.png"));
}

}  // namespace
}  // namespace orrery::test
