// SPDX-License-Identifier: Apache-2.0
// Direct light: all ways of sampling it converge to the same image.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "compile/compile.h"
#include "render/render.h"
#include "support/lit_scenes.h"

namespace orrery::test {
namespace {

constexpr int kWidth = 32, kHeight = 24, kBlock = 8;
constexpr int kBlocks = (kWidth / kBlock) * (kHeight / kBlock);

/// Mean of the blocks' radiance over the seeds, and its squared standard error.
struct BlockMeans {
  std::vector<double> mean = std::vector<double>(kBlocks, 0.0);
  std::vector<double> error2 = std::vector<double>(kBlocks, 0.0);
};

BlockMeans block_means(compile::CompiledScene compiled, int seeds) {
  std::vector<std::vector<double>> values(kBlocks);
  for (int seed = 0; seed < seeds; ++seed) {
    compiled.sampler.seed = static_cast<std::uint32_t>(seed + 1);
    const render::Result result = render::render(compiled, {});
    std::vector<double> sum(kBlocks, 0.0);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < kWidth * kHeight; ++i)
        sum[i / kWidth / kBlock * (kWidth / kBlock) + i % kWidth / kBlock] +=
            static_cast<double>(result.picture.planes[c].values[i]) / (3 * kBlock * kBlock);
    for (std::size_t b = 0; b < sum.size(); ++b) values[b].push_back(sum[b]);
  }
  BlockMeans out;
  for (std::size_t b = 0; b < values.size(); ++b) {
    for (const double v : values[b]) out.mean[b] += v / seeds;
    for (const double v : values[b]) out.error2[b] += (v - out.mean[b]) * (v - out.mean[b]) / (seeds - 1) / seeds;
  }
  return out;
}

compile::CompiledScene with(scene::Scene scene, scene::DirectLighting mode, int samples) {
  scene.render.direct_lighting = mode;
  scene.render.samples = samples;
  return compile::compile(scene);
}

/// With 2 x 15 degrees of freedom a correct renderer exceeds this about once in 50,000 blocks.
constexpr double kLargestBlockT = 5;

void expect_agreement(const NamedScene& s, int samples, int seeds) {
  const BlockMeans mis = block_means(with(s.scene, scene::DirectLighting::kMis, samples), seeds);
  double light = 0, mean = 0;
  for (const double m : mis.mean) mean += m;
  // In blocks that light hardly reaches, BSDF sampling may find none.
  const double least = 1e-4 * mean / kBlocks;
  for (const auto mode : {scene::DirectLighting::kBsdf, scene::DirectLighting::kLight}) {
    const BlockMeans other = block_means(with(s.scene, mode, samples), seeds);
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const double error = std::sqrt(mis.error2[b] + other.error2[b]);
      EXPECT_LT(std::abs(mis.mean[b] - other.mean[b]), kLargestBlockT * error + least)
          << s.name << ", block " << b << ": " << mis.mean[b] << " against " << other.mean[b] << " ("
          << (mode == scene::DirectLighting::kBsdf ? "bsdf" : "light") << "), error " << error;
    }
  }
  for (const double error2 : mis.error2) light += error2;
  EXPECT_GT(mean, 0) << s.name;
  std::printf("%-60s mean %.5f, relative standard error %.2e\n", s.name.c_str(), mean / kBlocks,
              std::sqrt(light) / mean);
}

TEST(StatisticalDirectLight, AllWaysOfSamplingAgree) {
  for (const NamedScene& s : lit_scenes(kWidth, kHeight)) expect_agreement(s, 64, 16);
}

}  // namespace
}  // namespace orrery::test
