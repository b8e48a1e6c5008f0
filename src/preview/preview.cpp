// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <vector>

#include <fmt/core.h>
#include <pthread.h>
#include <time.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "base/stopwatch.h"
#include "image/write.h"
#include "math/pixels.h"

namespace orrery::preview {

namespace {

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

void Preview::begin(const display::PictureInfo& picture) {
  end();
  canvas_ = std::make_unique<Canvas>(picture.width, picture.height);
  is_over_ = false;
  if (failed_) return;
  thread_ = std::thread([this, settings = picture.display] {
    try {
      show(settings);
    } catch (const std::exception& error) {
      failed_ = true;
      on_note_(base::warning_line(fmt::format("the preview ended: {}", error.what())));
    }
  });
}

void Preview::end() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

/// Updates the file until the image is over, and then once more.
void Preview::show(const display::Settings& settings) {
  pthread_setname_np(pthread_self(), "preview");  // for profilers
  const display::PixelDeveloper develop(settings);
  film::EncodedPicture codes;
  codes.width = canvas_->width();
  codes.height = canvas_->height();
  codes.values.assign(3 * math::pixel_count(codes.width, codes.height), 0);
  double cost = seconds_of(CLOCK_THREAD_CPUTIME_ID), processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  base::Stopwatch since_update;
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kTick, [this] { return is_over_; })) {
    if (!is_due(since_update.seconds(), seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor, cost)) continue;
    const double before = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    refresh(develop, codes);
    cost = seconds_of(CLOCK_THREAD_CPUTIME_ID) - before;
    processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    since_update.lap();
  }
  refresh(develop, codes);
}

/// Develops the cells that have changed and rewrites the file.
///
/// Errors     base::Error: kCannotCreate, kIo
void Preview::refresh(const display::PixelDeveloper& develop, film::EncodedPicture& codes) {
  const std::vector<std::size_t> cells = canvas_->take_changed();
  if (cells.empty()) return;
  std::vector<float> coverage(math::pixel_count(Canvas::kSide, Canvas::kSide)), rgb(3 * coverage.size());
  std::vector<std::uint8_t> developed(rgb.size());
  for (const std::size_t index : cells) {
    const Cell cell = canvas_->cell(index);
    const auto row = [&](int y) { return 3 * math::pixel_index(0, y, cell.width); };
    for (int y = 0; y < cell.height; ++y)
      canvas_->read(cell.x, cell.y + y, cell.width, &rgb[row(y)], &coverage[row(y) / 3]);
    develop(rgb.data(), coverage.data(), math::pixel_count(cell.width, cell.height), developed.data());
    for (int y = 0; y < cell.height; ++y)
      std::copy_n(&developed[row(y)], row(1), &codes.values[3 * math::pixel_index(cell.x, cell.y + y, codes.width)]);
  }
  base::write_text_file(file_, image::png_bytes(codes, image::kUncompressed), false);
}

}  // namespace orrery::preview
