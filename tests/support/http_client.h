// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace orrery::support {

/// A connection to a server on this host.
class HttpConnection {
 public:
  explicit HttpConnection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<std::uint16_t>(port));
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
      throw std::runtime_error("cannot connect");
  }
  ~HttpConnection() { ::close(socket_); }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void send(const std::string& bytes) const {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t sent = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) return;  // the server has answered and closed
      at += static_cast<std::size_t>(sent);
    }
  }
  /// Waits for bytes. Result: their number
  ssize_t receive(char* buffer, std::size_t size) const { return ::recv(socket_, buffer, size, 0); }
  /// All bytes until the server closes the connection.
  std::string receive() const {
    std::string out;
    char buffer[4096];
    for (ssize_t n; (n = receive(buffer, sizeof buffer)) > 0;) out.append(buffer, static_cast<std::size_t>(n));
    return out;
  }

 private:
  int socket_;
};

struct HttpAnswer {
  int status = 0;  ///< 0: none
  std::string header, body;
};

/// Sends a request and receives the answer. `fields` are whole lines of the header.
inline HttpAnswer http_request(int port, const std::string& method, const std::string& path,
                               const std::string& fields = {}, const std::string& body = {}) {
  const HttpConnection connection(port);
  std::string text = method + " " + path + " HTTP/1.1\r\nConnection: close\r\n" + fields;
  if (fields.find("Host:") == std::string::npos) text += "Host: 127.0.0.1:" + std::to_string(port) + "\r\n";
  if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  connection.send(text + "\r\n" + body);
  const std::string received = connection.receive();
  HttpAnswer out;
  if (received.rfind("HTTP/1.1 ", 0) == 0) out.status = std::atoi(received.c_str() + 9);
  const std::size_t end = received.find("\r\n\r\n");
  if (end != std::string::npos) {
    out.header = received.substr(0, end + 2);
    out.body = received.substr(end + 4);
  }
  return out;
}

}  // namespace orrery::support
