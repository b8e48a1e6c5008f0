// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "preview/connection.h"
#include "preview/sink.h"

namespace orrery::preview {

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
  bool is_done() const { return packet_.empty() && pending_count_ == 0; }
  void mark(std::size_t cell);

  Connection connection_;
  OnNote on_note_;
  std::string address_;  ///< "127.0.0.1:14158"
  std::string name_, focused_;
  const Canvas* canvas_ = nullptr;
  std::vector<bool> seen_, pending_;  ///< by cell: has content; must be sent
  std::size_t pending_count_ = 0, next_cell_ = 0;
  std::string packet_;  ///< packet that is being sent
  std::size_t sent_ = 0;
  bool was_open_ = false;
  bool reported_ = false;  ///< the user was notified that tev is unreachable or has disconnected
  Clock::time_point retry_ = Clock::now(), last_sent_ = Clock::now();
};

}  // namespace orrery::preview
