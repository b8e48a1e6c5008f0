// SPDX-License-Identifier: Apache-2.0
#include "denoise/planes.h"

#include <tbb/blocked_range.h>

namespace orrery::denoise {

Values window_means(const Values& in, Frame frame, int radius_px) {
  Values out(frame.pixels());
  const auto width = static_cast<std::size_t>(frame.width), radius = static_cast<std::size_t>(radius_px);
  const auto side = static_cast<float>(2 * radius_px + 1);
  frame.each_row([&](int y) {
    Values sums(width + 2 * radius);  // of the window's columns
    for (int i = -radius_px; i <= radius_px; ++i) {
      const float* const row = in.data() + frame.at(0, y + i);
      for (std::size_t x = 0; x < width; ++x) sums[radius + x] += row[x];
    }
    std::fill_n(sums.begin(), radius, sums[radius]);
    std::fill_n(sums.end() - radius_px, radius, sums[radius + width - 1]);
    float* const row = out.data() + frame.at(0, y);
    for (std::size_t i = 0; i <= 2 * radius; ++i)
      for (std::size_t x = 0; x < width; ++x) row[x] += sums[x + i];
    for (std::size_t x = 0; x < width; ++x) row[x] /= side * side;
  });
  return out;
}

Values least_around(const Values& in, Frame frame, int distance_px) {
  return frame.each([&](int x, int y) {
    return std::min({in[frame.at(x, y)], in[frame.at(x - distance_px, y)], in[frame.at(x + distance_px, y)],
                     in[frame.at(x, y - distance_px)], in[frame.at(x, y + distance_px)]});
  });
}

void add_squared_errors(const HalfPair& plane, Frame frame, Values& to) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, frame.pixels()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const float difference = (usable((*plane.a)[i]) - usable((*plane.b)[i])) * plane.scale;
      to[i] += difference * difference / 4;
    }
  });
}

Values variance_of(const std::vector<HalfPair>& planes, Frame frame, int radius_px, const Values* limits) {
  Values squares(frame.pixels());
  for (const HalfPair& plane : planes) add_squared_errors(plane, frame, squares);
  if (limits != nullptr)
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = std::min(squares[i], (*limits)[i] * (*limits)[i]);
  return window_means(squares, frame, radius_px);
}

void scale_pixel(PaddedPlane& plane, Frame frame, std::size_t pixel, float factor) {
  constexpr int kBorder = PaddedPlane::kBorder;
  const int x = frame.x(pixel), y = frame.y(pixel);
  const float value = factor * *plane.at(x, y);
  for (int row = y == 0 ? -kBorder : y; row <= (y == frame.height - 1 ? y + kBorder : y); ++row)
    for (int column = x == 0 ? -kBorder : x; column <= (x == frame.width - 1 ? x + kBorder : x); ++column)
      *plane.at(column, row) = value;
}

PaddedPlane padded(const Values& values, Frame frame, float scale) {
  frame.check();
  PaddedPlane out(frame.width, frame.height);
  constexpr int kBorder = PaddedPlane::kBorder;
  tbb::parallel_for(-kBorder, frame.height + kBorder, [&](int y) {
    const float* const from = values.data() + frame.at(0, y);
    float* const to = out.at(0, y);
    for (int x = 0; x < frame.width; ++x) to[x] = usable(from[x]) * scale;
    std::fill_n(to - kBorder, kBorder, to[0]);
    std::fill_n(to + frame.width, kBorder, to[frame.width - 1]);
  });
  return out;
}

}  // namespace orrery::denoise
