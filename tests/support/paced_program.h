// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace orrery::test {

/// A child process that renders in step with the test.
///
/// Its standard error is a pipe that holds one line. Unless the test reads, the render blocks at the second line of
/// progress after the last one read, so a signal arrives at the same stage of the work however fast the machine is.
///
/// Domain     one render thread (`-t 1`) and `--progress arnold`; with more threads only one of them blocks
class PacedProgram {
 public:
  struct Options {
    rlim_t largest_file = RLIM_INFINITY;  ///< file size limit in bytes (RLIMIT_FSIZE)
    int ignored_signal = 0;               ///< ignored from the start, as SIGHUP under nohup
  };

  PacedProgram(const std::filesystem::path& folder, std::vector<const char*> words, const Options& options)
      : changes_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
    words.insert(words.begin(), "orrery");
    words.push_back(nullptr);
    inotify_add_watch(changes_, folder.c_str(), IN_CREATE | IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE);
    int ends[2];
    // O_DIRECT: each write is a packet in its own slot; the smallest pipe has one slot.
    if (pipe2(ends, O_CLOEXEC | O_DIRECT) != 0 || fcntl(ends[1], F_SETPIPE_SZ, 4096) != 4096) std::abort();
    lines_ = ends[0];
    child_ = fork();
    if (child_ != 0) {
      close(ends[1]);
      return;
    }
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
      signal(number, number == options.ignored_signal ? SIG_IGN : SIG_DFL);
    const rlimit limit{options.largest_file, options.largest_file};
    if (chdir(folder.c_str()) != 0 || setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(126);
    dup2(ends[1], STDERR_FILENO);
    execv(ORRERY_PROGRAM, const_cast<char* const*>(words.data()));
    _exit(127);
  }
  PacedProgram(const std::filesystem::path& folder, std::vector<const char*> words)
      : PacedProgram(folder, std::move(words), Options()) {}
  PacedProgram(const PacedProgram&) = delete;
  PacedProgram& operator=(const PacedProgram&) = delete;
  ~PacedProgram() {
    if (child_ > 0) {
      send(SIGKILL);
      wait();
    }
    close(lines_);
    close(changes_);
  }

  /// Lets the program run until it reports at least this percentage.
  ///
  /// Result     false if it exited before
  bool run_to(int percent) {
    while (percent_ < percent)
      if (!read_packet()) return false;
    return true;
  }

  /// Lets the program run until its standard error contains `text`.
  ///
  /// Result     false if it exited before
  bool run_until(const std::string& text) {
    while (text_.find(text) == std::string::npos)
      if (!read_packet()) return false;
    return true;
  }

  /// Lets the program run until it has made `count` more changes to files in its folder.
  ///
  /// Result     false if it exited before
  bool run_changes(int count) {
    while (read_changes() > 0) {
    }
    pollfd both[2] = {{lines_, POLLIN, 0}, {changes_, POLLIN, 0}};
    while (count > 0) {
      poll(both, 2, -1);
      if ((both[1].revents & POLLIN) != 0) count -= read_changes();
      if (both[0].revents != 0 && !read_packet()) return false;
    }
    return true;
  }

  void send(int number) const { kill(child_, number); }

  /// Waits for the program to exit.
  ///
  /// Result     exit status, or 128 + the signal that ended it
  int wait() {
    while (read_packet()) {
    }
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  bool is_running() const { return waitpid(child_, nullptr, WNOHANG) == 0; }

  /// Standard error read so far.
  const std::string& text() const { return text_; }

 private:
  bool read_packet() {
    char packet[4096];
    const ssize_t length = read(lines_, packet, sizeof(packet));
    if (length <= 0) return false;
    text_.append(packet, static_cast<std::size_t>(length));
    const std::size_t done = text_.rfind("% done");
    if (done != std::string::npos) percent_ = std::atoi(text_.c_str() + text_.rfind('\n', done) + 1);
    return true;
  }

  int read_changes() const {
    alignas(inotify_event) char events[4096];
    const ssize_t length = read(changes_, events, sizeof(events));
    int count = 0;
    for (ssize_t at = 0; at < length; ++count)
      at += static_cast<ssize_t>(sizeof(inotify_event) + reinterpret_cast<const inotify_event*>(events + at)->len);
    return count;
  }

  pid_t child_ = 0;
  int lines_ = -1, changes_ = -1;
  int percent_ = -1;
  std::string text_;
};

}  // namespace orrery::test
