// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <pthread.h>
#include <time.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "image/write.h"
#include "math/pixels.h"

namespace orrery::preview {

namespace {

/// Minimum time between updates.
constexpr double kInterval = 1;  // s

/// Time between two checks whether an update is due.
constexpr std::chrono::milliseconds kTick{50};

/// Time of a processor clock: of this thread, or of the whole process.
double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

std::filesystem::path preview_file(const std::string& text) {
  if (text == "tev" || text.starts_with("tev:"))
    base::refuse("--preview: tev was removed; name a .png file, which tev and other viewers read, or use orrery view");
  if (base::has_frame_pattern(text))
    base::refuse(
        fmt::format("--preview: {} has a frame pattern; all frames share one preview, so write one name", text));
  if (!text.empty() && base::extension(text) != ".png")
    base::refuse(fmt::format("--preview: `{}` is not a .png file", text));
  return text;
}

Preview::Preview(std::filesystem::path file, OnNote on_note)
    : file_(std::move(file)), on_note_(std::move(on_note)), thread_([this] { run(); }) {}

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
    if (request == Request::kBegin) answer();  // the render does not wait for set_up()
    lock.unlock();
    const double before = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    const auto cost = [before] { return seconds_of(CLOCK_THREAD_CPUTIME_ID) - before; };
    if (request != Request::kNone) {
      start = Clock::now();
      processor_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
      if (request == Request::kBegin) attempt([this] { set_up(); });
      if (request == Request::kEnd) attempt([this] { refresh(); });
      pacing.reset();
      if (request == Request::kBegin) pacing.emplace(kInterval);
      if (pacing) pacing->spend(cost());
    } else if (!failed_) {
      const double now = std::chrono::duration<double>(Clock::now() - start).count();
      if (pacing && pacing->is_due(now, seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor_start)) {
        attempt([this] { refresh(); });
        pacing->updated(now, cost());
      }
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

void Preview::set_up() {
  develop_.emplace(picture_.display);
  codes_.width = canvas_->width();
  codes_.height = canvas_->height();
  codes_.values.assign(3 * math::pixel_count(codes_.width, codes_.height), 0);
}

/// Develops the cells that have changed and rewrites the file.
///
/// Errors     base::Error: kCannotCreate, kIo
void Preview::refresh() {
  const std::vector<std::size_t> cells = canvas_->take_changed();
  if (cells.empty()) return;
  std::vector<float> coverage(math::pixel_count(Canvas::kSide, Canvas::kSide)), rgb(3 * coverage.size());
  std::vector<std::uint8_t> codes(rgb.size());
  for (const std::size_t index : cells) {
    const Cell cell = canvas_->cell(index);
    const auto row = [&](int y) { return 3 * math::pixel_index(0, y, cell.width); };
    for (int y = 0; y < cell.height; ++y)
      canvas_->read(cell.x, cell.y + y, cell.width, &rgb[row(y)], &coverage[row(y) / 3]);
    (*develop_)(rgb.data(), coverage.data(), math::pixel_count(cell.width, cell.height), codes.data());
    for (int y = 0; y < cell.height; ++y)
      std::copy_n(&codes[row(y)], row(1), &codes_.values[3 * math::pixel_index(cell.x, cell.y + y, codes_.width)]);
  }
  base::write_text_file(file_, image::png_bytes(codes_, image::kUncompressed), false);
}

/// Does something whose failure ends the preview.
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
