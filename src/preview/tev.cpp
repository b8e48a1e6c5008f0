// SPDX-License-Identifier: Apache-2.0
#include "preview/tev.h"

#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "display/settings.h"
#include "math/pixels.h"
#include "preview/sink.h"

namespace orrery::preview {

namespace {

constexpr char kCreateImage = 4, kUpdateImageV3 = 6;
constexpr const char* kChannels[] = {"R", "G", "B"};
constexpr std::int32_t kChannelCount = 3;

using namespace std::chrono_literals;

/// Cells in a packet, next to each other in a row: 400 KB.
constexpr std::size_t kCellsPerPacket = 32;

/// Time between attempts to connect.
constexpr auto kRetry = 2s;

/// A viewer that has read nothing for this long is considered hung.
constexpr auto kViewerTimeout = 1s;

/// Maximum time to send the last pixels of an image.
constexpr auto kLongestFinish = 10s;

/// A packet: its length in bytes, including these four, its type and its payload; numbers are little-endian.
class Packet {
 public:
  explicit Packet(char type) : bytes_(4, '\0') { bytes_ += type; }

  void add(bool flag) { bytes_ += flag ? '\1' : '\0'; }
  void add(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  void add(std::int32_t number) { add_bytes(static_cast<std::uint32_t>(number), 4); }
  void add(std::int64_t number) { add_bytes(static_cast<std::uint64_t>(number), 8); }
  void add(const std::vector<float>& values) {
    static_assert(std::endian::native == std::endian::little);  // as Embree
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  }
  void add_channels() {
    add(kChannelCount);
    for (const char* const name : kChannels) add(std::string(name));
  }

  std::string finished() {
    for (std::size_t i = 0; i < 4; ++i) bytes_[i] = static_cast<char>(bytes_.size() >> (8 * i) & 0xff);
    return std::move(bytes_);
  }

 private:
  void add_bytes(std::uint64_t number, int count) {
    for (int i = 0; i < count; ++i) bytes_ += static_cast<char>(number >> (8 * i) & 0xff);
  }

  std::string bytes_;
};

}  // namespace

std::string tev_create(const std::string& name, int width, int height, bool grabs_focus) {
  Packet packet(kCreateImage);
  packet.add(grabs_focus);
  packet.add(name);
  packet.add(static_cast<std::int32_t>(width));
  packet.add(static_cast<std::int32_t>(height));
  packet.add_channels();
  return packet.finished();
}

std::string tev_update(const std::string& name, int x, int y, int width, int height, const std::vector<float>& rgb) {
  Packet packet(kUpdateImageV3);
  packet.add(false);  // does not grab the focus
  packet.add(name);
  packet.add_channels();
  for (const int number : {x, y, width, height}) packet.add(static_cast<std::int32_t>(number));
  for (std::int64_t offset = 0; offset < kChannelCount; ++offset) packet.add(offset);
  for (int channel = 0; channel < kChannelCount; ++channel) packet.add(std::int64_t{kChannelCount});  // stride
  packet.add(rgb);
  return packet.finished();
}

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

TevSink::TevSink(const std::string& host, const std::string& port, OnNote on_note)
    : connection_(host, port), on_note_(std::move(on_note)), address_(fmt::format("{}:{}", host, port)) {}

void TevSink::begin(const display::PictureInfo& picture, const Canvas& canvas) {
  canvas_ = &canvas;
  name_ = picture.name;
  seen_.clear();
  if (was_open_) begin_image();
  poll();
}

void TevSink::update(const std::vector<std::size_t>& cells) {
  seen_.insert(cells.begin(), cells.end());
  if (was_open_) pending_.insert(cells.begin(), cells.end());
}

void TevSink::poll() {
  check_connection();
  flush();
}

void TevSink::finish() {
  const auto end = Clock::now() + kLongestFinish;
  if (connection_.state() == Connection::State::kOpen && packet_.empty()) last_sent_ = Clock::now();
  const auto connects_until = Clock::now() + kViewerTimeout;
  for (;;) {
    poll();
    const auto now = Clock::now();
    if (connection_.state() == Connection::State::kClosed || now > end) break;
    if (connection_.state() == Connection::State::kConnecting ? now > connects_until
                                                              : now - last_sent_ > kViewerTimeout)
      break;
    if (connection_.state() == Connection::State::kOpen && is_done()) break;
    connection_.wait(50);
  }
  const bool incomplete = connection_.state() != Connection::State::kOpen || !is_done();
  if (was_open_ && incomplete && !std::exchange(reported_, true))
    on_note_(base::warning_line(fmt::format("tev at {} does not respond; its image is incomplete", address_)));
  // The rest of a packet must be sent before anything else.
  pending_.clear();
  canvas_ = nullptr;
}

/// Connects, and again after a while if that fails or the viewer disconnects.
void TevSink::check_connection() {
  connection_.check();
  if (connection_.state() == Connection::State::kClosed) {
    if (std::exchange(was_open_, false)) {
      packet_.clear();
      pending_.clear();
      retry_ = Clock::now() + kRetry;
      return;
    }
    if (Clock::now() >= retry_) {
      connection_.open();
      connection_.check();
      retry_ = Clock::now() + kRetry;
      if (connection_.state() == Connection::State::kClosed && !std::exchange(reported_, true))
        on_note_(base::warning_line(fmt::format(
            "tev cannot be reached at {}: {}; the render continues, and the preview begins when tev is started",
            address_, connection_.reason())));
    }
  }
  if (connection_.state() == Connection::State::kOpen && !was_open_) {
    was_open_ = true;
    last_sent_ = Clock::now();
    packet_.clear();
    begin_image();
  }
}

/// Sends the image with all cells that have content.
void TevSink::begin_image() {
  if (canvas_ == nullptr) return;
  pending_ = seen_;
  next_cell_ = 0;
  const std::string create = tev_create(name_, canvas_->width(), canvas_->height(), focused_ != name_);
  focused_ = name_;
  if (packet_.empty()) sent_ = 0;
  packet_ += create;  // after the rest of a packet of the previous image
}

/// Makes a packet of the next pending cells. They are processed in rotation, so that none waits forever.
bool TevSink::next_packet() {
  if (pending_.empty()) return false;
  const auto found = pending_.lower_bound(next_cell_);
  const std::size_t first = found != pending_.end() ? *found : *pending_.begin();
  const std::size_t row_end = (first / canvas_->cells_per_row() + 1) * canvas_->cells_per_row();
  next_cell_ = first;
  while (next_cell_ < std::min(row_end, first + kCellsPerPacket) && pending_.erase(next_cell_) > 0) ++next_cell_;
  const Cell left = canvas_->cell(first), right = canvas_->cell(next_cell_ - 1);
  const int width = right.x + right.width - left.x;
  std::vector<float> rgb(3 * math::pixel_count(width, left.height));
  for (int y = 0; y < left.height; ++y)
    canvas_->read(left.x, left.y + y, width, &rgb[3 * math::pixel_index(0, y, width)]);
  packet_ = tev_update(name_, left.x, left.y, width, left.height, rgb);
  sent_ = 0;
  return true;
}

/// Sends packets until there are none left or the viewer does not accept more.
void TevSink::flush() {
  while (was_open_ && (!packet_.empty() || next_packet())) {
    const std::size_t count = connection_.send(packet_.data() + sent_, packet_.size() - sent_);
    if (count == 0) break;
    last_sent_ = Clock::now();
    sent_ += count;
    if (sent_ < packet_.size()) continue;
    packet_.clear();
    sent_ = 0;
  }
}

}  // namespace orrery::preview
