// SPDX-License-Identifier: Apache-2.0
#include "preview/terminal_kind.h"

#include <gtest/gtest.h>

#include <map>

namespace orrery::preview {
namespace {

Environment with(std::map<std::string, std::string> values) {
  return [values](const char* name) { return values.count(name) > 0 ? values.at(name) : std::string(); };
}

TEST(PreviewTerminalKind, ReportsWhyThereAreNoColours) {
  EXPECT_EQ(missing_colors(with({{"TERM", "xterm"}})), "");
  EXPECT_EQ(missing_colors(with({{"TERM", "vte-256color"}})), "");
  EXPECT_EQ(missing_colors(with({})), "TERM is not set");
  EXPECT_EQ(missing_colors(with({{"TERM", "xterm"}, {"NO_COLOR", "1"}})), "NO_COLOR is set");
  for (const char* term : {"dumb", "unknown", "vt100", "vt220", "xterm-mono", "linux-m"})
    EXPECT_EQ(missing_colors(with({{"TERM", term}})), "the terminal `" + std::string(term) + "` has no colours");
}

TEST(PreviewTerminalKind, ReadsAnswersInPieces) {
  const std::string all = "x\033_Gi=31;OK\033\\\033[6;20;10t\033[?62;4;22c";
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_FALSE(parse_reply(all.substr(0, i)).is_complete) << i;
  const TerminalReply reply = parse_reply(all);
  EXPECT_TRUE(reply.is_complete && reply.kitty && reply.sixel);
  EXPECT_EQ(reply.cell_width, 10);
  EXPECT_EQ(reply.cell_height, 20);
}

TEST(PreviewTerminalKind, IgnoresWrongAnswers) {
  // 4 as the class of a terminal, and 14, are not the sixel attribute.
  EXPECT_FALSE(parse_reply("\033[?4;14c").sixel);
  EXPECT_FALSE(parse_reply("\033_Gi=31;ENOTSUP\033\\\033[?62c").kitty);
  for (const char* text : {"\033[6;0;0t", "\033[6;99999;99999t", "\033[6;20t", "\033[4;20;10t", "\033[6;-3;10t",
                           "\033[6;99999999999999999999;3t", "\033[;;;;;;t", "\033[t", "\033["})
    EXPECT_EQ(parse_reply(text).cell_height, 0) << text;
}

TEST(PreviewTerminalKind, ChoosesTheBestGraphics) {
  TerminalReply all, none;
  all.kitty = all.sixel = true;
  EXPECT_EQ(best_graphics(with({{"TERM_PROGRAM", "iTerm.app"}}), all), Graphics::kKitty);
  all.kitty = false;
  EXPECT_EQ(best_graphics(with({{"TERM_PROGRAM", "iTerm.app"}}), all), Graphics::kIterm);
  EXPECT_EQ(best_graphics(with({{"LC_TERMINAL", "iTerm2"}}), none), Graphics::kIterm);
  EXPECT_EQ(best_graphics(with({{"LC_TERMINAL", "iTerm2"}, {"TERM", "screen-256color"}}), all), Graphics::kSixel);
  EXPECT_EQ(best_graphics(with({{"COLORTERM", "truecolor"}}), none), Graphics::kTrueColor);
  EXPECT_EQ(best_graphics(with({{"TERM", "xterm-direct"}}), none), Graphics::kTrueColor);
  EXPECT_EQ(best_graphics(with({{"TERM", "xterm-256color"}}), none), Graphics::k256Colors);
}

TEST(PreviewTerminalKind, AsksOnlyWhatTheTerminalUnderstands) {
  EXPECT_EQ(queries(with({{"TERM", "linux"}})), "");
  EXPECT_EQ(queries(with({{"TERM", "tmux-256color"}})), "\033[16t\033[c");
  EXPECT_TRUE(queries(with({{"TERM", "xterm"}})).starts_with("\033_G"));
}

}  // namespace
}  // namespace orrery::preview
