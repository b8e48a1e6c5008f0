// SPDX-License-Identifier: Apache-2.0
#include "preview/connection.h"

#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace orrery::preview {

Connection::Connection(const std::string& host, const std::string& port) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  if (error != 0) {
    reason_ = gai_strerror(error);
    return;
  }
  for (const addrinfo* a = found; a != nullptr; a = a->ai_next) {
    Address address{a->ai_family, a->ai_addrlen, {}};
    std::memcpy(&address.storage, a->ai_addr, a->ai_addrlen);
    addresses_.push_back(address);
  }
  freeaddrinfo(found);
}

Connection::~Connection() {
  if (socket_ >= 0) ::close(socket_);
}

void Connection::open() {
  if (state_ != State::kClosed) return;
  next_ = 0;
  try_next();
}

void Connection::try_next() {
  while (next_ < addresses_.size()) {
    const Address& address = addresses_[next_++];
    socket_ = ::socket(address.family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0) {
      close(std::strerror(errno));
      continue;
    }
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address.storage), address.size) == 0) {
      state_ = State::kOpen;
      return;
    }
    if (errno == EINPROGRESS) {
      state_ = State::kConnecting;
      return;
    }
    close(std::strerror(errno));
  }
}

void Connection::check() {
  if (state_ == State::kConnecting) {
    pollfd writable{socket_, POLLOUT, 0};
    if (::poll(&writable, 1, 0) <= 0) return;
    int error = 0;
    socklen_t size = sizeof(error);
    getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error == 0) {
      state_ = State::kOpen;
      return;
    }
    close(std::strerror(error));
    try_next();
  } else if (state_ == State::kOpen) {
    char ignored[256];
    const ssize_t count = ::recv(socket_, ignored, sizeof(ignored), MSG_DONTWAIT);
    if (count == 0) close("the viewer has closed the connection");
    if (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) close(std::strerror(errno));
  }
}

std::size_t Connection::send(const char* bytes, std::size_t count) {
  if (state_ != State::kOpen) return 0;
  const ssize_t sent = ::send(socket_, bytes, count, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent >= 0) return static_cast<std::size_t>(sent);
  if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) close(std::strerror(errno));
  return 0;
}

void Connection::wait(int milliseconds) const {
  pollfd writable{socket_, POLLOUT, 0};
  ::poll(&writable, 1, milliseconds);
}

void Connection::close(const std::string& reason) {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  state_ = State::kClosed;
  reason_ = reason;
}

}  // namespace orrery::preview
