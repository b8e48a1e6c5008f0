// SPDX-License-Identifier: Apache-2.0
#include "preview/screen.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::preview {
namespace {

/// Assumed size of a cell if the terminal does not report it, px: a low estimate, so that an image does not cover more
/// rows than are reserved for it.
constexpr int kCellWidth = 6, kCellHeight = 12;

/// Rows that are not available for the image: the progress bar, and the line below a shell prompt.
constexpr int kOtherRows = 2;

/// A terminal that has read nothing for this long is considered hung.
constexpr std::chrono::seconds kHangingTerminal{1};

/// Converts line endings for a terminal in any mode.
std::string with_returns(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') out += '\r';
    out += c;
  }
  return out;
}

std::string up(int rows) { return rows > 0 ? fmt::format("\033[{}A", rows) : std::string(); }
std::string down(int rows) { return rows > 0 ? fmt::format("\033[{}B", rows) : std::string(); }

int checked_descriptor(int descriptor, const Environment& environment) {
  const std::string fault = missing_colors(environment);
  if (!fault.empty())
    throw base::Error(base::ErrorKind::kUsage,
                      fmt::format("--preview terminal: {}; use --preview FILE.png or --preview tev", fault));
  return descriptor;
}

}  // namespace

Screen::Screen(int descriptor, const Environment& environment) : tty_(checked_descriptor(descriptor, environment)) {
  const std::string text = queries(environment);
  reply_ = parse_reply(tty_.ask(text, [](const std::string& bytes) { return parse_reply(bytes).is_complete; }));
  graphics_ = best_graphics(environment, reply_);
  // Removes what a terminal may have printed instead of answering.
  if (!text.empty() && !tty_.is_in_background()) output_ = "\r\033[K";
  send();
}

void Screen::bar(const std::string& text) {
  const std::lock_guard lock(mutex_);
  bar_ = text;
  bar_changed_ = true;
}

void Screen::note(const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (is_finished_) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
    return;
  }
  notes_ += text;
}

Screen::CellGrid Screen::cell_grid() const {
  const TerminalSize size = tty_.size();
  CellGrid grid;
  grid.columns = size.columns;
  grid.rows = size.rows - kOtherRows;
  if (is_text(graphics_)) return grid;
  grid.cell_width = reply_.cell_width;
  grid.cell_height = reply_.cell_height;
  if (grid.cell_width == 0) {
    grid.cell_width = size.width >= size.columns ? size.width / size.columns : kCellWidth;
    grid.cell_height = size.height >= size.rows ? size.height / size.rows : kCellHeight;
  }
  return grid;
}

void Screen::show(std::string drawing, int rows) {
  drawing_ = std::move(drawing);
  rows_ = rows;
  is_drawn_ = false;
}

void Screen::poll() {
  if (tty_.is_in_background()) return;
  if (is_idle()) compose();
  send();
}

/// Composes the next output from what has changed. The cursor is in the bar's line, below the image.
void Screen::compose() {
  const std::lock_guard lock(mutex_);
  output_.clear();
  sent_ = 0;
  const TerminalSize size = tty_.size();
  if (!(size == shown_size_) && shown_rows_ > 0) {
    // The terminal may have wrapped or cut the image; a new one begins below.
    output_ += fmt::format("\r{}\033[J", removed(graphics_));
    shown_rows_ = 0;
    is_drawn_ = drawing_.empty();
  }
  shown_size_ = size;
  if (!notes_.empty()) {
    output_ += fmt::format("\r{}{}\033[J{}", up(shown_rows_), shown_rows_ > 0 ? removed(graphics_) : std::string(),
                           with_returns(notes_));
    notes_.clear();
    shown_rows_ = 0;
    is_drawn_ = drawing_.empty();
    bar_changed_ = true;
  }
  if (!is_drawn_ && rows_ <= size.rows - kOtherRows) {
    if (rows_ != shown_rows_) {
      output_ += fmt::format("\r{}{}\033[J", up(shown_rows_), shown_rows_ > 0 ? removed(graphics_) : std::string());
      for (int i = 0; i < rows_; ++i) output_ += "\r\n";
      shown_rows_ = rows_;
    }
    output_ += fmt::format("\r{}\0337{}\0338{}\r", up(rows_), drawing_, down(rows_));
    is_drawn_ = true;
    bar_changed_ = true;
  }
  if (bar_changed_) output_ += fmt::format("\r{}\033[K", bar_);
  bar_changed_ = false;
}

void Screen::send() {
  while (!is_idle()) {
    const std::size_t count = tty_.write(output_.data() + sent_, output_.size() - sent_);
    if (count == 0) return;
    sent_ += count;
  }
}

void Screen::finish() {
  using Clock = std::chrono::steady_clock;
  bar("");
  auto last = Clock::now();
  const auto is_done = [&] {
    const std::lock_guard lock(mutex_);
    const bool fits = rows_ <= tty_.size().rows - kOtherRows;
    return is_idle() && notes_.empty() && (is_drawn_ || !fits) && !bar_changed_;
  };
  while (!is_done() && !tty_.is_in_background() && Clock::now() - last < kHangingTerminal) {
    const std::size_t before = sent_, size = output_.size();
    poll();
    if (sent_ != before || output_.size() != size) last = Clock::now();
    if (!is_idle()) tty_.wait(50);
  }
  std::string rest;
  {
    const std::lock_guard lock(mutex_);
    if (is_finished_) return;
    is_finished_ = true;
    rest = notes_;
  }
  if (!is_idle()) {
    const std::string end = "\033\\\033[0m\r\n";  // of an escape sequence
    tty_.write(end.data(), end.size());
  }
  if (!rest.empty()) note(rest);
}

}  // namespace orrery::preview
