// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.h"

#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <pthread.h>
#include <time.h>

#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "base/text.h"
#include "preview/file_sink.h"
#include "preview/tev.h"

namespace orrery::preview {

namespace {

/// Address on which tev listens unless it is started with --hostname.
constexpr const char* kTevHost = "127.0.0.1";
constexpr const char* kTevPort = "14158";

[[noreturn]] void refuse(const std::string& text) {
  base::refuse(fmt::format("--preview: {}; write tev, tev:HOST:PORT, or the name of a .png file", text));
}

/// Parses HOST, HOST:PORT or [IPV6]:PORT.
Target tev_at(const std::string& address) {
  Target target{address, kTevPort, {}};
  std::size_t colon = address.rfind(':');
  if (address.starts_with('[')) {
    const std::size_t end = address.find(']');
    if (end == std::string::npos) refuse(fmt::format("`{}` lacks a closing bracket", address));
    if (end + 1 < address.size() && address[end + 1] != ':') refuse(fmt::format("`{}` is not an address", address));
    target.host = address.substr(1, end - 1);
    colon = end + 1 < address.size() ? end + 1 : std::string::npos;
  } else if (std::count(address.begin(), address.end(), ':') > 1) {
    refuse(fmt::format("`{}` is not an address; put an IPv6 address into brackets", address));
  } else {
    target.host = address.substr(0, colon);
  }
  if (colon != std::string::npos) target.port = address.substr(colon + 1);
  if (target.host.empty()) refuse(fmt::format("`{}` has no host", address));
  const int port = base::number_of<int>(target.port).value_or(0);
  if (port < 1 || port > 65535) refuse(fmt::format("`{}` is not a port from 1 to 65535", target.port));
  return target;
}

/// Time between two calls of Sink::poll.
constexpr std::chrono::milliseconds kTick{50};

/// Time of a processor clock: of this thread, or of the whole process.
double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

Target parse_target(const std::string& text) {
  if (text.empty()) return {};
  if (text == "tev") return {kTevHost, kTevPort, {}};
  if (base::has_frame_pattern(text))
    base::refuse(
        fmt::format("--preview: {} has a frame pattern; all frames share one preview, so write one name", text));
  if (base::extension(text) == ".png") return {{}, {}, text};
  if (text.starts_with("tev:")) return tev_at(text.substr(4));
  refuse(fmt::format("`{}` is not a preview", text));
}

std::unique_ptr<Sink> make_sink(const Target& target, const OnNote& note) {
  if (!target.host.empty()) return std::make_unique<TevSink>(target.host, target.port, note);
  if (!target.file.empty()) return std::make_unique<FileSink>(target.file);
  return nullptr;
}

Preview::Preview(std::unique_ptr<Sink> sink, OnNote on_note)
    : sink_(std::move(sink)), on_note_(std::move(on_note)), thread_([this] { run(); }) {}

Preview::~Preview() {
  end();
  ask(Request::kQuit);
  thread_.join();
}

void Preview::begin(const display::PictureInfo& picture) {
  end();
  picture_ = picture;
  canvas_ = std::make_unique<Canvas>(picture.width, picture.height);
  ask(Request::kBegin);
}

void Preview::end() {
  if (!canvas_) return;
  ask(Request::kEnd);
  canvas_.reset();
}

/// Passes a request to the preview's thread and waits until it is served. Meanwhile, that thread owns all members.
void Preview::ask(Request request) {
  std::unique_lock lock(mutex_);
  request_ = request;
  wake_.notify_one();
  served_.wait(lock, [this] { return request_ == Request::kNone; });
}

void Preview::run() {
  using Clock = std::chrono::steady_clock;
  pthread_setname_np(pthread_self(), "preview");  // for profilers
  Clock::time_point start;
  double processor_start = 0;
  std::optional<Pacing> pacing;  // of the current image
  std::unique_lock lock(mutex_);
  for (;;) {
    const Request request = request_;
    if (request == Request::kBegin) answer();  // the render does not wait for the sink
    lock.unlock();
    const double before = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    const auto cost = [before] { return seconds_of(CLOCK_THREAD_CPUTIME_ID) - before; };
    if (request != Request::kNone) {
      start = Clock::now();
      processor_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
      if (request == Request::kBegin) attempt([this] { sink_->begin(picture_, *canvas_); });
      if (request == Request::kEnd) {
        refresh();
        attempt([this] { sink_->finish(); });
      }
      pacing.reset();
      if (request == Request::kBegin) pacing.emplace(sink_->interval_s());
      if (pacing) pacing->spend(cost());
    } else if (!failed_) {
      const double now = std::chrono::duration<double>(Clock::now() - start).count();
      const bool is_due = pacing && pacing->is_due(now, seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor_start);
      if (is_due) refresh();
      sink_->poll();
      if (pacing) is_due ? pacing->updated(now, cost()) : pacing->spend(cost());
    }
    lock.lock();
    if (request == Request::kEnd || request == Request::kQuit) answer();
    if (request == Request::kQuit) return;
    wake_.wait_for(lock, kTick, [this] { return request_ != Request::kNone; });
  }
}

/// Domain     mutex_ is locked
void Preview::answer() {
  request_ = Request::kNone;
  served_.notify_one();
}

void Preview::refresh() {
  attempt([this] {
    const std::vector<std::size_t> cells = canvas_->take_changed();
    if (!cells.empty()) sink_->update(cells);
  });
}

/// Does something with the sink, whose failure ends the preview.
void Preview::attempt(const std::function<void()>& what) {
  if (failed_) return;
  try {
    what();
  } catch (const std::exception& error) {
    failed_ = true;
    on_note_(base::warning_line(fmt::format("the preview ended: {}", error.what())));
  }
}

}  // namespace orrery::preview
