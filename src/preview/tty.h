// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace orrery::preview {

/// The size of a terminal; a pixel size of 0 is unknown.
struct TerminalSize {
  int columns = 80, rows = 24;
  int width = 0, height = 0;  ///< px

  bool operator==(const TerminalSize&) const = default;
};

/// The terminal of a file descriptor, written without blocking. The terminal is reopened, so that other processes that
/// share the descriptor are not affected.
class Tty {
 public:
  /// Reopens the terminal of a descriptor in non-blocking mode.
  ///
  /// Errors     base::Error(kUsage) if the descriptor is not a terminal or cannot be reopened
  explicit Tty(int descriptor);
  ~Tty();
  Tty(const Tty&) = delete;
  Tty& operator=(const Tty&) = delete;

  TerminalSize size() const;

  /// True if a shell runs this process in the background, so that the terminal belongs to another one.
  bool is_in_background() const;

  /// Sends queries and returns the replies received until `is_complete` returns true, for at most half a second. Turns
  /// echo off and restores the terminal's mode afterwards.
  std::string ask(const std::string& queries, bool (*is_complete)(const std::string& reply)) const;

  /// Writes as much as the terminal accepts.
  ///
  /// Result     number of bytes; 0 if the terminal does not accept any
  std::size_t write(const char* bytes, std::size_t count) const;

  /// Waits until the terminal accepts bytes, for at most `milliseconds`.
  void wait(int milliseconds) const;

 private:
  int terminal_ = -1;
};

/// Restores the mode of a terminal that is being queried, and ends an escape sequence that is being written. Safe in a
/// signal handler; the process must end right after.
void restore_terminal() noexcept;

}  // namespace orrery::preview
