// SPDX-License-Identifier: Apache-2.0
#include "preview/fit.h"

#include <gtest/gtest.h>

#include "film/partial.h"
#include "unit/preview/pictures.h"

namespace orrery::preview {
namespace {

constexpr Screen::CellGrid kText{80, 22, 1, 2}, kCells{80, 22, 10, 20};

TEST(PreviewFit, KeepsTheAspectRatioInsideTheTerminal) {
  EXPECT_EQ(fit(1600, 900, 1, kText), (Fit{78, 44, 78, 22}));
  EXPECT_EQ(fit(400, 1600, 1, kText), (Fit{11, 44, 11, 22}));
  EXPECT_EQ(fit(1600, 200, 1, kText), (Fit{80, 10, 80, 5}));
  EXPECT_EQ(fit(100, 100, 2, kText), (Fit{80, 40, 80, 20}));  // pixels twice as wide as high
  EXPECT_EQ(fit(2000, 500, 1, kCells), (Fit{800, 200, 80, 10}));
}

TEST(PreviewFit, DoesNotEnlarge) {
  EXPECT_EQ(fit(30, 20, 1, kText), (Fit{30, 20, 30, 10}));
  EXPECT_EQ(fit(30, 20, 1, kCells), (Fit{30, 20, 3, 1}));
}

TEST(PreviewFit, LimitsThePixels) {
  const Fit large = fit(8000, 4000, 1, {1000, 500, 10, 20});
  EXPECT_LE(large.width * large.height, kLargestBitmap);
  EXPECT_GE(large.width * large.height, 0.9 * kLargestBitmap);
}

TEST(PreviewFit, FitsOrIsEmptyInEveryTerminal) {
  for (int columns = 0; columns < 12; ++columns)
    for (int rows = -2; rows < 12; ++rows)
      for (const auto& [width, height] : {std::pair{1, 1}, {1, 65536}, {65536, 1}, {640, 360}})
        for (const auto& [w, h] : {std::pair{1, 2}, {10, 20}, {1024, 1}}) {
          const Fit size = fit(width, height, 1, {columns, rows, w, h});
          EXPECT_LE(size.columns, std::max(columns, 0));
          EXPECT_LE(size.rows, std::max(rows, 0));
          EXPECT_LE(size.height, std::max(rows, 0) * h);
          EXPECT_EQ(size.width > 0, size.height > 0);
        }
}

TEST(PreviewFit, ScalesByTheMeansOfPixels) {
  Canvas canvas(4, 4);
  const film::Partial state = partial(4, 4);
  write_all(state, canvas);
  const std::vector<float> all = means(state);
  EXPECT_EQ(scaled(canvas, 4, 4), all);
  const std::vector<float> half = scaled(canvas, 2, 2);
  ASSERT_EQ(half.size(), 12u);
  // Pixels 2, 3, 6 and 7, green.
  EXPECT_FLOAT_EQ(half[4], (all[7] + all[10] + all[19] + all[22]) / 4);
  EXPECT_EQ(scaled(canvas, 8, 1).size(), 24u);
}

}  // namespace
}  // namespace orrery::preview
