// SPDX-License-Identifier: Apache-2.0
#include "preview/terminal_kind.h"

#include <charconv>
#include <cstdlib>
#include <vector>

#include <fmt/core.h>

namespace orrery::preview {
namespace {

/// A terminal multiplexer passes on neither kitty's nor iTerm2's images.
bool is_multiplexer(const Environment& environment) {
  const std::string term = environment("TERM");
  return term.starts_with("screen") || term.starts_with("tmux") || !environment("TMUX").empty();
}

/// The numbers in "1;2;34".
std::vector<int> numbers_of(std::string_view text) {
  std::vector<int> out;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at <= end) {
    int number = 0;
    const char* const stop = std::from_chars(at, end, number).ptr;
    out.push_back(number);
    at = stop + 1;
  }
  return out;
}

constexpr int kSixelAttribute = 4;
constexpr int kCellSizeReport = 6;
constexpr int kLargestCell = 1024;  // px

}  // namespace

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string missing_colors(const Environment& environment) {
  const std::string term = environment("TERM");
  if (!environment("NO_COLOR").empty()) return "NO_COLOR is set";
  if (term.empty()) return "TERM is not set";
  const bool is_dec = term.size() > 2 && term.starts_with("vt") && term[2] >= '0' && term[2] <= '9';
  if (term == "dumb" || term == "unknown" || is_dec || term.ends_with("-m") || term.ends_with("-mono"))
    return fmt::format("the terminal `{}` has no colours", term);
  return {};
}

std::string queries(const Environment& environment) {
  if (environment("TERM") == "linux") return {};
  const std::string kitty = is_multiplexer(environment) ? "" : "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\";
  return kitty + "\033[16t\033[c";
}

TerminalReply parse_reply(std::string_view bytes) {
  TerminalReply reply;
  reply.kitty = bytes.find("\033_Gi=31;OK\033\\") != std::string_view::npos;
  for (std::size_t at = bytes.find("\033["); at != std::string_view::npos; at = bytes.find("\033[", at + 2)) {
    const std::size_t end = bytes.find_first_not_of("?0123456789;", at + 2);
    if (end == std::string_view::npos) break;
    std::string_view parameters = bytes.substr(at + 2, end - at - 2);
    if (bytes[end] == 'c' && parameters.starts_with('?')) {
      parameters.remove_prefix(1);
      // The first number is the terminal's class, not an attribute.
      const std::vector<int> attributes = numbers_of(parameters);
      for (std::size_t i = 1; i < attributes.size(); ++i) reply.sixel |= attributes[i] == kSixelAttribute;
      reply.is_complete = true;
    } else if (bytes[end] == 't') {
      const std::vector<int> report = numbers_of(parameters);
      const auto is_size = [](int v) { return v > 0 && v <= kLargestCell; };
      if (report.size() == 3 && report[0] == kCellSizeReport && is_size(report[1]) && is_size(report[2])) {
        reply.cell_height = report[1];
        reply.cell_width = report[2];
      }
    }
  }
  return reply;
}

Graphics best_graphics(const Environment& environment, const TerminalReply& reply) {
  if (reply.kitty) return Graphics::kKitty;
  const bool is_iterm = environment("TERM_PROGRAM") == "iTerm.app" || environment("LC_TERMINAL") == "iTerm2";
  if (is_iterm && !is_multiplexer(environment)) return Graphics::kIterm;
  if (reply.sixel) return Graphics::kSixel;
  const std::string color = environment("COLORTERM");
  return color == "truecolor" || color == "24bit" || environment("TERM").ends_with("-direct") ? Graphics::kTrueColor
                                                                                              : Graphics::k256Colors;
}

}  // namespace orrery::preview
