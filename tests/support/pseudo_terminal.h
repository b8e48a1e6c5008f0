// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>

namespace orrery::test {

/// False where the system has no pseudo-terminals, as in a root without /dev/pts.
inline bool has_pseudo_terminals() {
  const int master = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master < 0) return false;
  const bool is_usable = grantpt(master) == 0 && unlockpt(master) == 0 && access(ptsname(master), R_OK | W_OK) == 0;
  close(master);
  return is_usable;
}

/// Skips a test that needs a PseudoTerminal where there is none.
#define ORRERY_NEEDS_PSEUDO_TERMINAL() \
  if (!orrery::test::has_pseudo_terminals()) GTEST_SKIP() << "there are no pseudo-terminals"

/// A pseudo-terminal, and what a terminal emulator does at its other end: it collects the output and answers queries.
class PseudoTerminal {
 public:
  /// `answers`  to a query of the device attributes and what was asked before; empty: does not answer
  explicit PseudoTerminal(std::string answers = {}) : answers_(std::move(answers)) {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) std::abort();
    slave_ = open(ptsname(master_), O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (slave_ < 0) std::abort();
    resize(80, 24);
  }
  ~PseudoTerminal() {
    close_slave();
    close(master_);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  int slave() const { return slave_; }
  int master() const { return master_; }
  std::string name() const { return ptsname(master_); }
  /// So that reading ends when the last other process has closed the terminal.
  void close_slave() {
    if (slave_ >= 0) close(slave_);
    slave_ = -1;
  }

  void resize(int columns, int rows) const {
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = static_cast<unsigned short>(rows);
    ioctl(master_, TIOCSWINSZ, &size);
  }
  termios mode() const {
    termios out{};
    tcgetattr(master_, &out);
    return out;
  }

  /// Reads what is there, waiting for at least one byte, and answers.
  ///
  /// Result     false at the end
  bool read_some() {
    char bytes[65536];
    const ssize_t count = read(master_, bytes, sizeof(bytes));
    if (count <= 0) return false;
    output_.append(bytes, static_cast<std::size_t>(count));
    const std::size_t query = output_.find("\033[c", answered_);
    if (query != std::string::npos && !answers_.empty()) {
      answered_ = query + 1;
      [[maybe_unused]] const ssize_t written = write(master_, answers_.data(), answers_.size());
    }
    return true;
  }

  const std::string& output() const { return output_; }

  /// The last complete drawing between saving and restoring the cursor, without the returns that the terminal adds.
  std::string last_drawing() const {
    const std::size_t end = output_.rfind("\0338"), begin = output_.rfind("\0337", end);
    if (end == std::string::npos || begin == std::string::npos) return {};
    std::string out = output_.substr(begin + 2, end - begin - 2);
    for (std::size_t at = 0; (at = out.find("\r\r\n", at)) != std::string::npos;) out.erase(at, 1);
    return out;
  }

 private:
  int master_ = -1, slave_ = -1;
  std::string answers_, output_;
  std::size_t answered_ = 0;
};

/// Reads a terminal on a separate thread until destruction.
class TerminalReader {
 public:
  explicit TerminalReader(PseudoTerminal& terminal)
      : thread_([this, &terminal] {
          pollfd readable{terminal.master(), POLLIN, 0};
          while (!ending_ || poll(&readable, 1, 0) > 0)
            if (poll(&readable, 1, 1) > 0) terminal.read_some();
        }) {}
  ~TerminalReader() {
    ending_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace orrery::test
