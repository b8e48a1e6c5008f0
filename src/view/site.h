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

/// An option that the page may set.
struct Control {
  std::string name;                      ///< "--style"
  std::string heading, type, help;       ///< as --help shows them; type: empty for a flag
  std::vector<std::string> values = {};  ///< if it has no others
  bool is_repeatable = false;
};

/// What the page offers for a command.
struct Controls {
  std::string title;  ///< name of the file
  /// What a user types to make the picture of these words.
  std::function<std::string(const std::vector<std::string>& words)> command;
  std::vector<Control> options;
  bool fills_window = false;                                  ///< the page chooses the size of the image
  std::map<std::string, std::vector<std::string>> maps = {};  ///< colours of colour maps, #rrggbb
  /// The values of a column of a frame as JSON, see info::column_values_json(); empty: there are no columns.
  std::function<std::string(int frame, const std::string& column, bool is_log)> column = {};
  /// The command that makes a film of these words, and starts or cancels it, if there is a folder for it.
  std::function<std::string(const std::vector<std::string>& words)> film_command = {};
  std::function<void(const std::vector<std::string>& words)> film = {};
  std::function<std::string()> film_state = {};  ///< as JSON
  std::function<void()> film_cancel = {};
};

/// The page and what it requests, by HTTP.
///
/// A request is answered only if it carries the secret in a header, and names this host by its address or a name of the
/// loopback interface: pages of other sites cannot ask, not even with a DNS name of their own that they redirect. The
/// page itself is the same for everybody; it finds the secret in its address. Nothing that a client sends is a name of
/// a file. Each page shows its own images: what belongs to the wish of another one is answered with 409.
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
  http::Response answer_client(const http::Request& request);
  http::Response frame(const http::Request& request);
  http::Response page() const;
  http::Response state() const;
  http::Response column(const http::Request& request) const;
  http::Response pick(const http::Request& request);
  http::Response change(const http::Request& request);
  Wish wish_of(const http::Request& request) const;
  http::Response picture(const std::string& extension) const;
  http::Response scene(bool is_brief) const;

  Viewer& viewer_;
  const Controls controls_;
  const std::string host_, secret_;
  const Wish first_;                               ///< that of the command line
  std::atomic<Clock::time_point> last_request_{};  ///< that carried the secret
};

/// 128 random bits as text.
///
/// Errors     base::Error(kIo) if the system has no random numbers
std::string random_secret();

}  // namespace orrery::view
