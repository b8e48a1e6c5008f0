// SPDX-License-Identifier: Apache-2.0
#include "preview/tty.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>

#include "base/error.h"

namespace orrery::preview {
namespace {

/// Maximum time for a terminal to reply.
constexpr std::chrono::milliseconds kAnswerTime{500};

/// Largest answer that is read, bytes.
constexpr std::size_t kMaxReplyBytes = 4096;

// For a signal handler: the terminal in use, and the mode to restore.
std::atomic<int> in_use{-1};
std::atomic<bool> is_asking{false};
termios mode_before;

}  // namespace

Tty::Tty(int descriptor) {
  if (isatty(descriptor) == 0)
    throw base::Error(base::ErrorKind::kUsage,
                      "--preview terminal: standard error is not a terminal; use --preview FILE.png or --preview tev");
  const std::string name = "/proc/self/fd/" + std::to_string(descriptor);
  constexpr int kFlags = O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  terminal_ = ::open(name.c_str(), kFlags);
  if (terminal_ < 0) terminal_ = ::open("/dev/tty", kFlags);
  if (terminal_ < 0)
    throw base::Error(base::ErrorKind::kUsage,
                      "--preview terminal: the terminal cannot be opened; use --preview FILE.png or --preview tev");
  in_use = terminal_;
}

Tty::~Tty() {
  in_use = -1;
  ::close(terminal_);
}

TerminalSize Tty::size() const {
  winsize size{};
  TerminalSize out;
  if (ioctl(terminal_, TIOCGWINSZ, &size) != 0) return out;
  if (size.ws_col > 0) out.columns = size.ws_col;
  if (size.ws_row > 0) out.rows = size.ws_row;
  out.width = size.ws_xpixel;
  out.height = size.ws_ypixel;
  return out;
}

bool Tty::is_in_background() const {
  const pid_t foreground = tcgetpgrp(terminal_);  // fails if it is not this process's controlling terminal
  return foreground > 0 && foreground != getpgrp();
}

std::string Tty::ask(const std::string& queries, bool (*is_complete)(const std::string&)) const {
  using Clock = std::chrono::steady_clock;
  std::string reply;
  if (queries.empty() || is_in_background() || tcgetattr(terminal_, &mode_before) != 0) return reply;
  termios quiet = mode_before;
  quiet.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  quiet.c_cc[VMIN] = 0;
  quiet.c_cc[VTIME] = 0;
  is_asking = true;
  tcsetattr(terminal_, TCSANOW, &quiet);
  if (write(queries.data(), queries.size()) == queries.size()) {
    const auto end = Clock::now() + kAnswerTime;
    while (!is_complete(reply) && reply.size() < kMaxReplyBytes) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
      pollfd readable{terminal_, POLLIN, 0};
      if (left <= 0 || (::poll(&readable, 1, static_cast<int>(left)) <= 0 && errno != EINTR)) break;
      char bytes[256];
      const ssize_t count = ::read(terminal_, bytes, sizeof(bytes));
      if (count > 0) reply.append(bytes, static_cast<std::size_t>(count));
      if (count == 0) break;  // the terminal has been closed
      if (count < 0 && errno != EAGAIN && errno != EINTR) break;
    }
    if (!is_complete(reply)) tcflush(terminal_, TCIFLUSH);
  }
  tcsetattr(terminal_, TCSANOW, &mode_before);
  is_asking = false;
  return reply;
}

std::size_t Tty::write(const char* bytes, std::size_t count) const {
  const ssize_t written = ::write(terminal_, bytes, count);
  return written > 0 ? static_cast<std::size_t>(written) : 0;
}

void Tty::wait(int milliseconds) const {
  pollfd writable{terminal_, POLLOUT, 0};
  // A terminal that has hung up is reported as ready immediately; the write then fails.
  if (::poll(&writable, 1, milliseconds) > 0 && (writable.revents & (POLLHUP | POLLERR)) != 0)
    ::usleep(static_cast<useconds_t>(milliseconds) * 1000);
}

void restore_terminal() noexcept {
  const int terminal = in_use;
  if (terminal < 0) return;
  if (is_asking) tcsetattr(terminal, TCSANOW, &mode_before);
  constexpr char kEnd[] = "\033\\\033[0m\r\n";  // end of a string sequence, default colours
  [[maybe_unused]] const ssize_t ignored = ::write(terminal, kEnd, sizeof(kEnd) - 1);
}

}  // namespace orrery::preview
