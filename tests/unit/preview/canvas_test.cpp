// SPDX-License-Identifier: Apache-2.0
#include "preview/canvas.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "film/sums.h"
#include "kernel/pixel_sum.h"
#include "unit/preview/pictures.h"

namespace orrery::preview {
namespace {

std::vector<float> read_all(const Canvas& canvas) {
  std::vector<float> out(3 * static_cast<std::size_t>(canvas.width()) * static_cast<std::size_t>(canvas.height()));
  std::vector<float> coverage(static_cast<std::size_t>(canvas.width()));
  for (int y = 0; y < canvas.height(); ++y)
    canvas.read(0, y, canvas.width(), &out[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width())],
                coverage.data());
  return out;
}

TEST(PreviewCanvas, HoldsTheMeansOfBothHalves) {
  film::Sums state = sums(5, 3);
  state.light[1].resize(state.pixel_count());
  for (kernel::PixelSum& sum : state.light[1]) {
    sum.rgb[0] = kernel::to_fixed_point(7);
    sum.weight = 3;
  }
  state.light[0][4] = state.light[1][4] = {};  // no samples, and thus black
  Canvas canvas(5, 3);
  write_all(state, canvas);
  EXPECT_EQ(read_all(canvas), means(state));
  EXPECT_FLOAT_EQ(read_all(canvas)[0], 7.0f / 4);
  EXPECT_FLOAT_EQ(read_all(canvas)[1], 1.0f / 4);
  EXPECT_EQ(read_all(canvas)[12], 0.0f);
}

TEST(PreviewCanvas, MarksTheCellsOfARectangleOnce) {
  Canvas canvas(100, 70);
  EXPECT_TRUE(canvas.take_changed().empty());
  const film::Sums state = sums(100, 70);
  const kernel::PixelPlace corner{0, 0}, end{2, 2};
  canvas.write(state, {30, 62, 19, 4, {&corner, 1}});
  canvas.write(state, {97, 67, 3, 3, {&end, 1}});
  EXPECT_EQ(canvas.take_changed(), (std::vector<std::size_t>{4, 5, 8, 9, 11}));
  EXPECT_TRUE(canvas.take_changed().empty());
  const Cell last = canvas.cell(11);
  EXPECT_EQ((std::vector<int>{last.x, last.y, last.width, last.height}), (std::vector<int>{96, 64, 4, 6}));
  float rgb[3], want[3], coverage = 0;
  canvas.read(99, 69, 1, rgb, &coverage);
  EXPECT_EQ(coverage, 1) << "unknown";
  state.mean(math::pixel_index(99, 69, 100), want);
  EXPECT_EQ(rgb[1], want[1]);
  canvas.read(31, 62, 1, rgb, &coverage);
  EXPECT_EQ(rgb[1], 0.0f);  // in the rectangle, but not among its pixels
}

TEST(PreviewCanvas, AReaderOfMarkedCellsHasEveryPixelInTheEnd) {
  constexpr int kSide = 64, kPasses = 50;
  Canvas canvas(kSide, kSide);
  std::atomic<int> writing{2};
  std::vector<std::thread> writers;
  for (int half = 0; half < 2; ++half)
    writers.emplace_back([&, half] {
      const std::vector<kernel::PixelPlace> rows = all_pixels(kSide, 1);
      for (int pass = 1; pass <= kPasses; ++pass) {
        const film::Sums state = sums(kSide, kSide, pass);
        for (int y = half; y < kSide; y += 2) canvas.write(state, {0, y, kSide, 1, rows});
      }
      --writing;
    });
  std::vector<float> copy(3 * kSide * kSide), coverage(kSide);
  const auto copy_changed = [&] {
    for (const std::size_t index : canvas.take_changed()) {
      const Cell cell = canvas.cell(index);
      for (int y = cell.y; y < cell.y + cell.height; ++y)
        canvas.read(cell.x, y, cell.width, &copy[static_cast<std::size_t>(3 * (y * kSide + cell.x))], coverage.data());
    }
  };
  while (writing > 0) copy_changed();
  copy_changed();
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(copy, means(sums(kSide, kSide, kPasses)));
}

}  // namespace
}  // namespace orrery::preview
