// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace orrery::test {

/// An image as a viewer has it.
struct TevImage {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> values;  ///< channels of all pixels, row by row
  int creations = 0, updates = 0;
};

/// Decodes tev's packets by the description of its protocol, independently of the encoder.
class TevReader {
 public:
  /// Takes bytes as they arrive.
  void add(const char* bytes, std::size_t count) {
    stream_.append(bytes, count);
    for (;;) {
      if (stream_.size() < 4) return;
      at_ = 0;
      const auto length = static_cast<std::size_t>(number<std::uint32_t>());
      if (length < 5) throw std::runtime_error("packet without a type");
      if (stream_.size() < length) return;
      end_ = length;
      read_packet();
      if (at_ != end_) throw std::runtime_error("packet with bytes after its payload");
      stream_.erase(0, length);
    }
  }

  std::map<std::string, TevImage> images;

 private:
  template <class Number>
  Number number() {
    Number out;
    if (at_ + sizeof(out) > stream_.size()) throw std::runtime_error("packet is too short");
    std::memcpy(&out, stream_.data() + at_, sizeof(out));  // the tests run on little-endian machines
    at_ += sizeof(out);
    return out;
  }
  std::string text() {
    const std::size_t end = stream_.find('\0', at_);
    if (end >= end_) throw std::runtime_error("text without end");
    const std::string out = stream_.substr(at_, end - at_);
    at_ = end + 1;
    return out;
  }
  std::vector<std::string> names(int count) {
    std::vector<std::string> out;
    for (int i = 0; i < count; ++i) out.push_back(text());
    return out;
  }

  void read_packet() {
    const int type = number<std::uint8_t>();
    number<std::uint8_t>();  // grabs the focus
    const std::string name = text();
    if (type == 4) {
      TevImage& image = images[name];
      image.width = number<std::int32_t>();
      image.height = number<std::int32_t>();
      image.channels = names(number<std::int32_t>());
      image.values.assign(static_cast<std::size_t>(image.width * image.height) * image.channels.size(), 0.0f);
      ++image.creations;
    } else if (type == 6) {
      update(images.at(name));
    } else {
      throw std::runtime_error("unknown packet type");
    }
  }

  void update(TevImage& image) {
    const auto count = static_cast<std::size_t>(number<std::int32_t>());
    if (names(static_cast<int>(count)) != image.channels) throw std::runtime_error("other channels");
    const int x = number<std::int32_t>(), y = number<std::int32_t>();
    const int width = number<std::int32_t>(), height = number<std::int32_t>();
    if (x < 0 || y < 0 || width < 1 || height < 1 || x + width > image.width || y + height > image.height)
      throw std::runtime_error("rectangle outside the image");
    std::vector<std::int64_t> offsets, strides;
    for (std::size_t c = 0; c < count; ++c) offsets.push_back(number<std::int64_t>());
    for (std::size_t c = 0; c < count; ++c) strides.push_back(number<std::int64_t>());
    const std::size_t data = at_;
    for (std::int64_t i = 0; i < std::int64_t{width} * height; ++i)
      for (std::size_t c = 0; c < count; ++c) {
        at_ = data + sizeof(float) * static_cast<std::size_t>(offsets[c] + i * strides[c]);
        const auto pixel = static_cast<std::size_t>((y + i / width) * image.width + x + i % width);
        image.values[pixel * count + c] = number<float>();
      }
    ++image.updates;
  }

  std::string stream_;
  std::size_t at_ = 0, end_ = 0;
};

/// A viewer on a free port of the loopback interface.
class TevServer {
 public:
  enum class Manner {
    kReads,
    kHangs,   ///< accepts a connection, and never reads
    kLeaves,  ///< closes each connection after its first bytes
  };

  /// `port`     0: any free port
  explicit TevServer(Manner manner, int port = 0) : manner_(manner) {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    const int yes = 1;
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    socklen_t size = sizeof(address);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(listener_, 4) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0 || pipe(stop_) != 0)
      throw std::runtime_error("no server");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~TevServer() {
    stop();
    for (const int descriptor : {listener_, stop_[0], stop_[1]}) close(descriptor);
  }
  TevServer(const TevServer&) = delete;
  TevServer& operator=(const TevServer&) = delete;

  int port() const { return port_; }
  std::string target() const { return "tev:127.0.0.1:" + std::to_string(port_); }

  /// Ends the server once its clients have closed their connections, and returns the images.
  std::map<std::string, TevImage> images() {
    stop();
    if (!fault_.empty()) throw std::runtime_error(fault_);
    return reader_.images;
  }
  int connections() const { return connections_; }

 private:
  void stop() {
    if (!thread_.joinable()) return;
    [[maybe_unused]] const ssize_t written = write(stop_[1], "x", 1);
    thread_.join();
  }

  void serve() {
    for (bool ending = false;;) {
      pollfd both[2] = {{listener_, POLLIN, 0}, {stop_[0], POLLIN, 0}};
      poll(both, 2, ending ? 0 : -1);
      if ((both[0].revents & POLLIN) != 0) {
        talk(accept(listener_, nullptr, nullptr));
      } else if (ending) {
        return;
      }
      ending = (both[1].revents & POLLIN) != 0;
    }
  }

  void talk(int client) {
    ++connections_;
    if (manner_ == Manner::kHangs) {
      pollfd stop{stop_[0], POLLIN, 0};
      poll(&stop, 1, -1);
      close(client);
      return;
    }
    std::vector<char> bytes(1 << 16);
    for (ssize_t count; (count = recv(client, bytes.data(), bytes.size(), 0)) > 0;) {
      if (manner_ == Manner::kLeaves) break;
      try {
        reader_.add(bytes.data(), static_cast<std::size_t>(count));
      } catch (const std::exception& error) {
        fault_ = error.what();
        break;
      }
    }
    close(client);
  }

  Manner manner_;
  int listener_ = -1, port_ = 0, stop_[2] = {-1, -1};
  std::atomic<int> connections_ = 0;
  TevReader reader_;
  std::string fault_;
  std::thread thread_;
};

}  // namespace orrery::test
