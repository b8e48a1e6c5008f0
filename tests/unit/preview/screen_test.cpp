// SPDX-License-Identifier: Apache-2.0
#include "preview/screen.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/pseudo_terminal.h"

namespace orrery::preview {
namespace {

using test::PseudoTerminal;
using test::TerminalReader;

std::string color_terminal(const char* name) { return std::string(name) == "TERM" ? "xterm-256color" : ""; }

TEST(PreviewScreen, AsksWithoutEchoAndRestoresTheMode) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal("\033_Gi=31;OK\033\\\033[6;18;9t\033[?62;4c");
  const termios before = terminal.mode();
  {
    const TerminalReader reader(terminal);
    const Screen screen(terminal.slave(), color_terminal);
    EXPECT_EQ(screen.graphics(), Graphics::kKitty);
    EXPECT_EQ(screen.cell_grid(), (Screen::CellGrid{80, 22, 9, 18}));
  }
  const termios after = terminal.mode();
  EXPECT_EQ(before.c_lflag, after.c_lflag);
  EXPECT_NE(after.c_lflag & ECHO, 0u);
  EXPECT_EQ(terminal.output().find("62"), std::string::npos) << "an answer was echoed";
}

TEST(PreviewScreen, ATerminalThatDoesNotAnswerGetsHalfBlocks) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal;
  const termios before = terminal.mode();
  const Screen screen(terminal.slave(), color_terminal);
  EXPECT_EQ(screen.graphics(), Graphics::k256Colors);
  EXPECT_EQ(screen.cell_grid(), (Screen::CellGrid{80, 22, 1, 2}));
  EXPECT_EQ(terminal.mode().c_lflag, before.c_lflag);
}

TEST(PreviewScreen, MessagesScrollAboveTheImage) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal("\033[?62c");
  {
    const TerminalReader reader(terminal);
    Screen screen(terminal.slave(), color_terminal);
    screen.bar("bar one");
    screen.show("IMAGE1", 3);
    screen.poll();
    screen.note("a message\nof two lines\n");
    screen.bar("bar two");
    screen.poll();
    screen.finish();
  }
  const std::string& text = terminal.output();
  const std::size_t first = text.find("IMAGE1"), note = text.find("a message\r");
  const std::size_t second = text.find("IMAGE1", note), bar = text.find("bar two", note);
  ASSERT_NE(second, std::string::npos) << text;
  EXPECT_LT(first, note);
  EXPECT_LT(note, second);
  EXPECT_LT(second, bar);
  // Before the message, the cursor goes to the first row of the image, and everything below is cleared.
  EXPECT_NE(text.find("\033[3A\033[Ja message"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\r\033[K")) << "the bar must be removed";
}

TEST(PreviewScreen, AResizedTerminalGetsANewImageBelow) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal("\033[?62c");
  {
    const TerminalReader reader(terminal);
    Screen screen(terminal.slave(), color_terminal);
    screen.show("IMAGE1", 20);
    screen.poll();
    terminal.resize(40, 10);
    EXPECT_EQ(screen.cell_grid(), (Screen::CellGrid{40, 8, 1, 2}));
    screen.poll();  // the image does not fit any more
    screen.show("IMAGE2", 8);
    screen.poll();
    screen.finish();
  }
  EXPECT_NE(terminal.output().find("\033[8A\0337IMAGE2\0338\033[8B"), std::string::npos) << terminal.output();
  EXPECT_EQ(terminal.output().find("IMAGE1"), terminal.output().rfind("IMAGE1"));
}

TEST(PreviewScreen, ATerminalThatDoesNotReadDelaysNothingForLong) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal;
  Screen screen(terminal.slave(), color_terminal);
  screen.show(std::string(1 << 20, 'x'), 3);
  for (int i = 0; i < 3; ++i) screen.poll();
  EXPECT_FALSE(screen.is_idle());
  screen.finish();
}

TEST(PreviewScreen, RefusesTerminalsWithoutColours) {
  ORRERY_NEEDS_PSEUDO_TERMINAL();
  PseudoTerminal terminal;
  const auto message = [](int descriptor, const Environment& environment) -> std::string {
    try {
      const Screen screen(descriptor, environment);
      return "accepted";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
      return error.what();
    }
  };
  const std::string remedy = "; use --preview FILE.png or --preview tev";
  EXPECT_EQ(message(terminal.slave(), [](const char*) { return std::string(); }),
            "--preview terminal: TERM is not set" + remedy);
  const int file = open("/dev/null", O_RDWR | O_CLOEXEC);
  EXPECT_EQ(message(file, color_terminal), "--preview terminal: standard error is not a terminal" + remedy);
  close(file);
}

}  // namespace
}  // namespace orrery::preview
