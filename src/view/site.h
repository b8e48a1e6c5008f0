// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "http/server.h"
#include "view/viewer.h"

namespace orrery::view {

/// What the page offers for a command.
struct Controls {
  std::string title;  ///< name of the file
  /// What a user types to make the picture of these words, and a film of it, if there is a way.
  std::function<std::string(const std::vector<std::string>&words)> command, film;
  /// Options that the page may set, with the values among which it lets choose; none: any text.
  std::map<std::string, std::vector<std::string>> options;
};

/// The page and what it requests, by HTTP.
///
/// A request is answered only if it carries the secret in a header, and names this host by its address or a name of the
/// loopback interface: pages of other sites cannot ask, not even with a DNS name of their own that they redirect. The
/// page itself is the same for everybody; it finds the secret in its address. Nothing that a client sends is a name of
/// a file.
class Site {
 public:
  /// `host`     address that the server listens on; "0.0.0.0": all addresses
  /// `secret`   at least 128 random bits, as text for an address
  Site(Viewer& viewer, Controls controls, std::string host, std::string secret);

  /// Whether a request is for this host, and carries the secret.
  bool admits(const http::Request& request) const;

  http::Response answer(const http::Request& request);

  /// Time since the last request that carried the secret; zero until there is one.
  std::chrono::seconds idle() const;

 private:
  using Clock = std::chrono::steady_clock;

  bool is_for_us(const http::Request& request) const;
  http::Response frame(const http::Request& request);
  http::Response state() const;
  http::Response pick(const http::Request& request);
  http::Response change(const http::Request& request);
  http::Response picture(const std::string& extension) const;
  http::Response scene() const;

  Viewer& viewer_;
  const Controls controls_;
  const std::string host_, secret_;
  std::atomic<Clock::time_point> last_request_{};  ///< that carried the secret
};

/// 128 random bits as text.
///
/// Errors     base::Error(kIo) if the system has no random numbers
std::string random_secret();

}  // namespace orrery::view
