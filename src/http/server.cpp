// SPDX-License-Identifier: Apache-2.0
#include "http/server.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::http {
namespace {

constexpr unsigned kMaxConnections = 256;
constexpr std::size_t kMaxStrangers = 128;            // connections that have not been admitted
constexpr unsigned kSilenceLimit_s = 5;               // of strangers
constexpr unsigned kIdleLimit_s = 60;                 // of others; longer than any handler waits
constexpr std::size_t kConnectionMemory = 32 * 1024;  // limits the header of a request

/// A request that is being received.
struct Exchange {
  Request request;
  bool is_admitted = false, is_too_large = false;
};

std::string field(MHD_Connection* connection, const char* name) {
  const char* const value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
  return value != nullptr ? value : "";
}

MHD_Result add_argument(void* query, MHD_ValueKind, const char* name, const char* value) {
  (*static_cast<std::map<std::string, std::string>*>(query))[name] = value != nullptr ? value : "";
  return MHD_YES;
}

/// The memory of a body that is being sent.
using Body = std::shared_ptr<const std::string>;

ssize_t read_body(void* body, std::uint64_t at, char* buffer, std::size_t size) {
  const std::string& text = **static_cast<Body*>(body);
  if (at >= text.size()) return MHD_CONTENT_READER_END_OF_STREAM;
  return static_cast<ssize_t>(text.copy(buffer, size, at));
}

void release_body(void* body) { delete static_cast<Body*>(body); }

/// Decodes %XX in place. A zero byte would end the text.
std::size_t unescape(void*, MHD_Connection*, char* text) {
  const std::size_t size = MHD_http_unescape(text);
  std::replace(text, text + size, '\0', '\x1a');
  return size;
}

MHD_Result send(MHD_Connection* connection, const Response& response, bool is_admitted) {
  constexpr std::size_t kBlock = 64 * 1024;
  MHD_Response* const out = response.body && !response.body->empty()
                                ? MHD_create_response_from_callback(response.body->size(), kBlock, read_body,
                                                                    new Body(response.body), release_body)
                                : MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT);
  if (out == nullptr) return MHD_NO;
  if (!is_admitted) MHD_add_response_header(out, MHD_HTTP_HEADER_CONNECTION, "close");
  if (!response.type.empty()) MHD_add_response_header(out, "Content-Type", response.type.c_str());
  for (const auto& [name, value] : response.fields) MHD_add_response_header(out, name.c_str(), value.c_str());
  const MHD_Result result = MHD_queue_response(connection, static_cast<unsigned>(response.status), out);
  MHD_destroy_response(out);
  return result;
}

class MicroServer {
 public:
  MicroServer(const sockaddr_in& address, Admission admits, Handler handler)
      : admits_(std::move(admits)), handler_(std::move(handler)) {
    daemon_ = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION, 0, nullptr, nullptr, &MicroServer::receive,
        this, MHD_OPTION_SOCK_ADDR, &address, MHD_OPTION_CONNECTION_LIMIT, kMaxConnections,
        MHD_OPTION_CONNECTION_TIMEOUT, kSilenceLimit_s, MHD_OPTION_CONNECTION_MEMORY_LIMIT, kConnectionMemory,
        MHD_OPTION_NOTIFY_CONNECTION, &MicroServer::notice, this, MHD_OPTION_NOTIFY_COMPLETED, &MicroServer::forget,
        nullptr, MHD_OPTION_UNESCAPE_CALLBACK, &unescape, nullptr, MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_END);
    if (daemon_ == nullptr)
      throw base::Error(
          base::ErrorKind::kCannotCreate,
          fmt::format("cannot listen on port {}: {}; choose another one with --port, or none for a free one",
                      ntohs(address.sin_port), std::strerror(errno)));
    const MHD_DaemonInfo* const info = MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_BIND_PORT);
    port_ = info != nullptr && info->port != 0 ? info->port : ntohs(address.sin_port);
  }
  ~MicroServer() { MHD_stop_daemon(daemon_); }
  MicroServer(const MicroServer&) = delete;
  MicroServer& operator=(const MicroServer&) = delete;

  int port() const { return port_; }

 private:
  /// Notes that a connection begins or ends. Too many strangers: the one that has waited longest must go.
  static void notice(void* self, MHD_Connection* connection, void**, MHD_ConnectionNotificationCode code) {
    auto& server = *static_cast<MicroServer*>(self);
    std::deque<MHD_Connection*>& strangers = server.strangers_;
    const std::lock_guard lock(server.mutex_);
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
      std::erase(strangers, connection);
      return;
    }
    strangers.push_back(connection);
    if (strangers.size() <= kMaxStrangers) return;
    // Its thread then closes it; the descriptor stays valid until that has been noticed here.
    shutdown(MHD_get_connection_info(strangers.front(), MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd, SHUT_RDWR);
    strangers.pop_front();
  }

  void admit(MHD_Connection* connection) {
    MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, kIdleLimit_s);
    const std::lock_guard lock(mutex_);
    std::erase(strangers_, connection);
  }

  static MHD_Result receive(void* self, MHD_Connection* connection, const char* url, const char* method, const char*,
                            const char* data, std::size_t* size, void** state) {
    auto& server = *static_cast<MicroServer*>(self);
    if (*state == nullptr) {  // the header has been received
      auto exchange = std::make_unique<Exchange>();
      Request& request = exchange->request;
      request.method = method;
      request.path = url;
      request.host = field(connection, MHD_HTTP_HEADER_HOST);
      request.origin = field(connection, MHD_HTTP_HEADER_ORIGIN);
      request.authorization = field(connection, MHD_HTTP_HEADER_AUTHORIZATION);
      MHD_get_connection_values(connection, MHD_GET_ARGUMENT_KIND, add_argument, &request.query);
      exchange->is_admitted = server.admits_(request);
      if (exchange->is_admitted) server.admit(connection);
      *state = exchange.release();
      return MHD_YES;
    }
    auto& exchange = *static_cast<Exchange*>(*state);
    if (*size > 0) {
      exchange.is_too_large = exchange.is_too_large || exchange.request.body.size() + *size > kLargestBody;
      if (!exchange.is_too_large) exchange.request.body.append(data, *size);
      *size = 0;
      return MHD_YES;
    }
    Response response{413};
    try {
      if (!exchange.is_too_large) response = server.handler_(exchange.request);
    } catch (const std::exception&) {
      response.status = 500;
    }
    return send(connection, response, exchange.is_admitted);
  }

  static void forget(void*, MHD_Connection*, void** state, MHD_RequestTerminationCode) {
    delete static_cast<Exchange*>(*state);
    *state = nullptr;
  }

  Admission admits_;
  Handler handler_;
  std::mutex mutex_;                       // guards strangers_
  std::deque<MHD_Connection*> strangers_;  ///< not admitted yet, the oldest first
  MHD_Daemon* daemon_;
  int port_;
};

}  // namespace

Server serve(const std::string& address, int port, Admission admits, Handler handler) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1)
    base::refuse(fmt::format("--host: `{}` is not an IPv4 address, e.g. 127.0.0.1", address));
  const auto server = std::make_shared<const MicroServer>(at, std::move(admits), std::move(handler));
  return {server->port(), server};
}

}  // namespace orrery::http
