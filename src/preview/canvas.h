// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/zero_pages.h"
#include "film/forward.h"

namespace orrery::preview {

/// A square of a Canvas, smaller at the right and bottom edges.
struct Cell {
  int x, y, width, height;  ///< px
};

/// The image rendered so far, written by the rendering threads and read by a preview's thread, without locks.
///
/// A pixel that is written and read at the same time may be read with channels from different passes; its cell is then
/// marked as changed again, so the next read corrects it.
class Canvas {
 public:
  static constexpr int kSide = 32;  ///< side of a cell, px

  Canvas(int width_px, int height_px);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }

  /// Copies the means of pixels and marks their cells as changed. Called on the rendering threads.
  ///
  /// Domain     concurrent calls have no pixel in common
  void write(const film::Sums& state, const film::RenderedPixels& rendered) noexcept;

  /// Copies an image, such as the denoised result.
  ///
  /// Domain     of the same size, with the planes R, G and B; no concurrent calls
  void write(const film::Picture& picture) noexcept;

  /// The cells that have changed since the last call, as indices in row-major order. Called on one thread.
  std::vector<std::size_t> take_changed();

  Cell cell(std::size_t index) const noexcept;

  /// Copies a row of scene-linear R, G, B values, and the coverage, which is 1 if the render does not determine it.
  ///
  /// `rgb`      3 * count values
  void read(int x, int y, int count, float* rgb, float* coverage) const noexcept;

 private:
  static constexpr std::size_t kChannels = 4;

  std::size_t at(int x, int y) const noexcept;
  std::atomic_ref<float> value(std::size_t i) const noexcept { return std::atomic_ref(values_[i]); }

  int width_, height_;
  std::size_t cells_per_row_;
  /// R, G, B and coverage of all pixels. Its pages are cleared by the threads that first write them.
  mutable base::ZeroVector<float> values_;
  std::vector<std::atomic<std::uint8_t>> changed_;  ///< 1: the cell has changed
};

}  // namespace orrery::preview
