// SPDX-License-Identifier: Apache-2.0
#include "preview/tev_sink.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/diagnostic.h"
#include "display/picture_info.h"
#include "preview/canvas.h"
#include "preview/tev_packets.h"

namespace orrery::preview {
namespace {

using namespace std::chrono_literals;

/// Cells in a packet, next to each other in a row: 400 KB.
constexpr std::size_t kCellsPerPacket = 32;

/// Time between attempts to connect.
constexpr auto kRetry = 2s;

/// A viewer that has read nothing for this long is considered hung.
constexpr auto kViewerTimeout = 1s;

/// Maximum time to send the last pixels of an image.
constexpr auto kLongestFinish = 10s;

}  // namespace

TevSink::TevSink(const std::string& host, const std::string& port, OnNote on_note)
    : connection_(host, port), on_note_(std::move(on_note)), address_(fmt::format("{}:{}", host, port)) {}

void TevSink::begin(const display::PictureInfo& picture, const Canvas& canvas) {
  canvas_ = &canvas;
  name_ = picture.name;
  seen_.assign(canvas.cell_count(), false);
  if (was_open_) begin_image();
  poll();
}

void TevSink::update(const std::vector<std::size_t>& cells) {
  for (const std::size_t cell : cells) {
    seen_[cell] = true;
    if (was_open_) mark(cell);
  }
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
  pending_count_ = 0;
  canvas_ = nullptr;
}

/// Connects, and again after a while if that fails or the viewer disconnects.
void TevSink::check_connection() {
  connection_.check();
  if (connection_.state() == Connection::State::kClosed) {
    if (std::exchange(was_open_, false)) {
      packet_.clear();
      pending_.clear();
      pending_count_ = 0;
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
  pending_.assign(canvas_->cell_count(), false);
  pending_count_ = 0;
  next_cell_ = 0;
  const std::string create = tev_create(name_, canvas_->width(), canvas_->height(), focused_ != name_);
  focused_ = name_;
  if (packet_.empty()) sent_ = 0;
  packet_ += create;  // after the rest of a packet of the previous image
  for (std::size_t i = 0; i < seen_.size(); ++i)
    if (seen_[i]) mark(i);
}

void TevSink::mark(std::size_t cell) {
  if (pending_[cell]) return;
  pending_[cell] = true;
  ++pending_count_;
}

/// Makes a packet of the next pending cells. They are processed in rotation, so that none waits forever.
bool TevSink::next_packet() {
  if (pending_count_ == 0) return false;
  const auto begin = pending_.begin();
  auto found = std::find(begin + static_cast<std::ptrdiff_t>(next_cell_), pending_.end(), true);
  if (found == pending_.end()) found = std::find(begin, pending_.end(), true);
  const auto first = static_cast<std::size_t>(found - begin);
  const std::size_t row_end = (first / canvas_->cells_per_row() + 1) * canvas_->cells_per_row();
  std::size_t last = first;
  for (; last < std::min(row_end, first + kCellsPerPacket) && pending_[last]; ++last) {
    pending_[last] = false;
    --pending_count_;
  }
  next_cell_ = last % pending_.size();
  const Cell left = canvas_->cell(first), right = canvas_->cell(last - 1);
  const int width = right.x + right.width - left.x;
  std::vector<float> rgb(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(left.height));
  for (int y = 0; y < left.height; ++y)
    canvas_->read(left.x, left.y + y, width, &rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width)]);
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
