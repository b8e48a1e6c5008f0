// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "preview/sink.h"

namespace orrery::preview {

/// A packet that makes tev create a black image with channels R, G and B, replacing one of the same name.
///
/// `grabs_focus`  tev selects the image
/// Reference  tev
std::string tev_create(const std::string& name, int width, int height, bool grabs_focus);

/// A packet that replaces a rectangle of an image.
///
/// `rgb`      3 * width * height scene-linear values, row by row from the top
/// Reference  tev
std::string tev_update(const std::string& name, int x, int y, int width, int height, const std::vector<float>& rgb);

/// A TCP connection that never blocks.
class Connection {
 public:
  enum class State { kClosed, kConnecting, kOpen };

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

/// Sends images to tev: scene-linear R, G, B in the working space, without exposure.
///
/// At most one packet waits to be sent. A viewer that reads slowly receives fewer updates; one that closes the
/// connection, or starts later, receives the whole image when it can be reached again.
class TevSink : public Sink {
 public:
  /// Resolves the address of tev.
  ///
  /// Errors     none: an address that cannot be reached is reported by `on_note`
  TevSink(const std::string& host, const std::string& port, OnNote on_note);

  double interval_s() const override { return 0.1; }
  void begin(const display::PictureInfo& picture, const Canvas& canvas) override;
  void update(const std::vector<std::size_t>& cells) override;
  void poll() override;
  void finish() override;

 private:
  using Clock = std::chrono::steady_clock;

  void check_connection();
  void begin_image();
  bool next_packet();
  void flush();
  bool is_done() const { return packet_.empty() && pending_.empty(); }

  Connection connection_;
  OnNote on_note_;
  std::string address_;  ///< "127.0.0.1:14158"
  std::string name_, focused_;
  const Canvas* canvas_ = nullptr;
  std::set<std::size_t> seen_, pending_;  ///< cells that have content, and those that must be sent
  std::size_t next_cell_ = 0;
  std::string packet_;  ///< packet that is being sent
  std::size_t sent_ = 0;
  bool was_open_ = false;
  bool reported_ = false;  ///< the user was notified that tev is unreachable or has disconnected
  Clock::time_point retry_ = Clock::now(), last_sent_ = Clock::now();
};

}  // namespace orrery::preview
