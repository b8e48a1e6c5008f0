// SPDX-License-Identifier: Apache-2.0
// Means over blocks of pixels, for comparing images that differ in noise.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"

namespace orrery::test {

inline constexpr int kBlock = 8;  ///< px, side of a block

/// Mean of the blocks' radiance over the seeds, and its squared standard error.
struct BlockMeans {
  std::vector<double> mean, error2;

  /// Standard error of the image's mean, relative to it.
  double relative_error() const {
    double error2_sum = 0, mean_sum = 0;
    for (const double e : error2) error2_sum += e;
    for (const double m : mean) mean_sum += m;
    return std::sqrt(error2_sum) / mean_sum;
  }
};

/// Renders a scene with the seeds 1, 2, ... Its sides are multiples of kBlock.
inline BlockMeans block_means(compile::CompiledScene compiled, int seeds) {
  const auto width = static_cast<std::size_t>(compiled.width), height = static_cast<std::size_t>(compiled.height);
  const std::size_t blocks = (width / kBlock) * (height / kBlock);
  std::vector<std::vector<double>> values(blocks);
  for (int seed = 0; seed < seeds; ++seed) {
    compiled.sampler.seed = static_cast<std::uint32_t>(seed + 1);
    const render::Result result = render::render(compiled, {});
    std::vector<double> sum(blocks, 0.0);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < width * height; ++i)
        sum[i / width / kBlock * (width / kBlock) + i % width / kBlock] +=
            static_cast<double>(result.picture.planes[c].values[i]) / (3 * kBlock * kBlock);
    for (std::size_t b = 0; b < blocks; ++b) values[b].push_back(sum[b]);
  }
  BlockMeans out{std::vector<double>(blocks, 0.0), std::vector<double>(blocks, 0.0)};
  for (std::size_t b = 0; b < blocks; ++b) {
    for (const double v : values[b]) out.mean[b] += v / seeds;
    for (const double v : values[b]) out.error2[b] += (v - out.mean[b]) * (v - out.mean[b]) / (seeds - 1) / seeds;
  }
  return out;
}

}  // namespace orrery::test
