// SPDX-License-Identifier: Apache-2.0
#include "preview/canvas.h"

#include <algorithm>

#include "film/picture.h"
#include "film/sums.h"
#include "math/pixels.h"

namespace orrery::preview {

namespace {

std::size_t cells_of(int pixels) { return static_cast<std::size_t>((pixels + Canvas::kSide - 1) / Canvas::kSide); }

}  // namespace

Canvas::Canvas(int width_px, int height_px)
    : width_(width_px),
      height_(height_px),
      cells_per_row_(cells_of(width_px)),
      values_(kChannels * math::pixel_count(width_px, height_px)),
      changed_(cells_per_row_ * cells_of(height_px)) {}

std::size_t Canvas::at(int x, int y) const noexcept { return kChannels * math::pixel_index(x, y, width_); }

void Canvas::write(const film::Sums& state, const film::RenderedPixels& rendered) noexcept {
  for (const kernel::PixelPlace p : rendered.pixels) {
    const std::size_t i = math::pixel_index(rendered.x + p.x, rendered.y + p.y, width_);
    float values[kChannels] = {0, 0, 0, 1};
    state.mean(i, values);
    if (!state.layers.covered.empty()) values[3] = state.coverage(i);
    const std::size_t pixel = at(rendered.x + p.x, rendered.y + p.y);
    for (std::size_t c = 0; c < kChannels; ++c) value(pixel + c).store(values[c], std::memory_order_relaxed);
  }
  const int right = (rendered.x + rendered.width - 1) / kSide, bottom = (rendered.y + rendered.height - 1) / kSide;
  // A read-modify-write, unlike a store, keeps the pixels of an earlier writer visible to whoever resets the mark.
  for (int y = rendered.y / kSide; y <= bottom; ++y)
    for (int x = rendered.x / kSide; x <= right; ++x)
      changed_[static_cast<std::size_t>(y) * cells_per_row_ + static_cast<std::size_t>(x)].fetch_or(
          1, std::memory_order_release);
}

void Canvas::write(const film::Picture& picture) noexcept {
  std::size_t c = 0;
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>& plane = picture.find(name)->values;
    for (std::size_t i = 0; i < plane.size(); ++i) value(kChannels * i + c).store(plane[i], std::memory_order_relaxed);
    ++c;
  }
  for (std::size_t i = 0; i < picture.coverage.size(); ++i)
    value(kChannels * i + c).store(picture.coverage[i], std::memory_order_relaxed);
  for (std::atomic<std::uint8_t>& changed : changed_) changed.fetch_or(1, std::memory_order_release);
}

std::vector<std::size_t> Canvas::take_changed() {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < changed_.size(); ++i)
    if (changed_[i].load(std::memory_order_relaxed) != 0 && changed_[i].exchange(0, std::memory_order_acquire) != 0)
      out.push_back(i);
  return out;
}

Cell Canvas::cell(std::size_t index) const noexcept {
  const int x = static_cast<int>(index % cells_per_row_) * kSide, y = static_cast<int>(index / cells_per_row_) * kSide;
  return {x, y, std::min(kSide, width_ - x), std::min(kSide, height_ - y)};
}

void Canvas::read(int x, int y, int count, float* rgb, float* coverage) const noexcept {
  std::size_t from = at(x, y);
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) *rgb++ = value(from++).load(std::memory_order_relaxed);
    *coverage++ = value(from++).load(std::memory_order_relaxed);
  }
}

}  // namespace orrery::preview
