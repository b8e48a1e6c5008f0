// SPDX-License-Identifier: Apache-2.0
#include "preview/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "preview/canvas.h"

namespace orrery::preview {

Fit fit(int width_px, int height_px, double pixel_aspect, const Screen::CellGrid& grid) {
  const double width = width_px * pixel_aspect, height = height_px;
  const double room_width = static_cast<double>(grid.columns) * grid.cell_width;
  const double room_height = static_cast<double>(grid.rows) * grid.cell_height;
  if (grid.rows < 1 || grid.columns < 1) return {};
  const double scale =
      std::min({1.0, room_width / width, room_height / height, std::sqrt(kLargestBitmap / (width * height))});
  Fit out;
  out.columns = std::clamp(static_cast<int>(scale * width / grid.cell_width), 1, grid.columns);
  out.width = out.columns * grid.cell_width;
  out.height = std::max(1, static_cast<int>(std::lround(out.width * height / width)));
  out.rows = (out.height + grid.cell_height - 1) / grid.cell_height;
  return out.rows <= grid.rows ? out : Fit{};
}

std::vector<float> scaled(const Canvas& canvas, int width_px, int height_px) {
  // The first source pixel of each new one; an image that is scaled up repeats pixels.
  const auto begin = [](int i, int count, int source) {
    return static_cast<int>(static_cast<std::int64_t>(i) * source / count);
  };
  std::vector<float> out, row(3 * static_cast<std::size_t>(canvas.width()));
  std::vector<double> sums(3 * static_cast<std::size_t>(width_px));
  out.reserve(sums.size() * static_cast<std::size_t>(height_px));
  for (int y = 0; y < height_px; ++y) {
    std::fill(sums.begin(), sums.end(), 0.0);
    const int top = begin(y, height_px, canvas.height());
    const int bottom = std::max(top + 1, begin(y + 1, height_px, canvas.height()));
    for (int source = top; source < bottom; ++source) {
      canvas.read(0, source, canvas.width(), row.data());
      for (int x = 0; x < width_px; ++x) {
        const int left = begin(x, width_px, canvas.width());
        const int right = std::max(left + 1, begin(x + 1, width_px, canvas.width()));
        for (int c = 0; c < 3; ++c) {
          double sum = 0;
          for (int i = left; i < right; ++i) sum += row[static_cast<std::size_t>(3 * i + c)];
          sums[static_cast<std::size_t>(3 * x + c)] += sum / (right - left);
        }
      }
    }
    for (const double sum : sums) out.push_back(static_cast<float>(sum / (bottom - top)));
  }
  return out;
}

}  // namespace orrery::preview
