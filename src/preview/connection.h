// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <string>
#include <vector>

namespace orrery::preview {

/// A TCP connection that never blocks.
class Connection {
 public:
  enum class State {
    kClosed,
    kConnecting,
    kOpen,
  };

  /// Resolves the address. A name that cannot be resolved leaves a connection that always fails.
  Connection(const std::string& host, const std::string& port);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  State state() const { return state_; }
  /// The reason why the connection is closed: "Connection refused".
  const std::string& reason() const { return reason_; }

  /// Starts connecting, if closed.
  void open();

  /// Updates the state: whether connecting has succeeded, and whether the other side has closed the connection.
  void check();

  /// Sends as much as the system accepts.
  ///
  /// Result     number of bytes; 0 if the other side does not read, or has closed the connection
  std::size_t send(const char* bytes, std::size_t count);

  /// Waits until the socket accepts bytes, for at most `milliseconds`.
  void wait(int milliseconds) const;

 private:
  struct Address {
    int family;
    socklen_t size;
    sockaddr_storage storage;
  };
  void try_next();
  void close(const std::string& reason);

  std::vector<Address> addresses_;
  std::size_t next_ = 0;  ///< index of the address to try next
  int socket_ = -1;
  State state_ = State::kClosed;
  std::string reason_;
};

}  // namespace orrery::preview
