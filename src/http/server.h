// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace orrery::http {

/// Largest body of a request, in bytes. A larger one is answered with 413.
inline constexpr std::size_t kLargestBody = 64 * 1024;

struct Request {
  std::string method, path;                  ///< "GET", "/frame"
  std::map<std::string, std::string> query;  ///< decoded; the last value of a repeated name
  std::string host, origin, authorization;   ///< header fields as sent; empty: none
  std::string body;
};

struct Response {
  int status = 200;
  std::string type = {};  ///< content type; empty: no body
  /// Shared, because an image may be sent to several clients.
  std::shared_ptr<const std::string> body = nullptr;
  std::vector<std::pair<std::string, std::string>> fields = {};  ///< further header fields
};

/// Whether a request, whose body has not been received yet, is that of a client. Called on the thread of a connection.
using Admission = std::function<bool(const Request&)>;

/// Answers a request. Called on the thread of a connection; may wait. What it throws is answered with 500.
using Handler = std::function<Response(const Request&)>;

/// A running server, which ends with the last copy of `daemon`, when no handler runs any more.
struct Server {
  int port = 0;
  std::shared_ptr<const void> daemon;
};

/// Starts to serve HTTP/1.1 on an IPv4 address. Each connection has a thread. The number and the idle time of
/// connections are limited. Those that are not of clients cannot lock clients out: they are closed after the first
/// answer, after a few seconds of silence, or when too many others have come.
///
/// `port`     0: a free port
/// Errors     base::Error: kUsage for an address that is not IPv4; kCannotCreate if the port is in use
Server serve(const std::string& address, int port, Admission admits, Handler handler);

}  // namespace orrery::http
