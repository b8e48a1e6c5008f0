// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "kernel/sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Points of the sequence `name`, four coordinates each, in SIMD lanes of type U.
template <class U>
void points(std::uint32_t name, std::uint32_t order, std::uint32_t first, std::size_t count, std::uint32_t* out) {
  const hn::ScalableTag<U> du;
  HWY_ALIGN U lanes[4][hn::MaxLanes(du)];
  for (std::size_t i = 0; i < count; i += hn::Lanes(du)) {
    const auto index = hn::Iota(du, static_cast<U>(first + i));
    const auto p = sobol(du, index, hn::Set(du, static_cast<U>(name)), order, true);
    for (int k = 0; k < 4; ++k) hn::Store(p.v[k], du, lanes[k]);
    for (std::size_t l = 0; l < hn::Lanes(du) && i + l < count; ++l)
      for (std::size_t k = 0; k < 4; ++k) out[(i + l) * 4 + k] = static_cast<std::uint32_t>(lanes[k][l]);
  }
}
void points_64(std::uint32_t name, std::uint32_t order, std::uint32_t first, std::size_t count, std::uint32_t* out) {
  points<std::uint64_t>(name, order, first, count, out);
}
void points_32(std::uint32_t name, std::uint32_t order, std::uint32_t first, std::size_t count, std::uint32_t* out) {
  points<std::uint32_t>(name, order, first, count, out);
}

/// Numbers of one lane: four for each sample of a pixel at a vertex, or of its second point.
void numbers(const Sampler& sampler, std::uint32_t pixel, std::uint32_t vertex, bool second, std::uint32_t first,
             std::size_t count, double* out) {
  const hn::FixedTag<double, 1> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (std::size_t i = 0; i < count; ++i) {
    const auto p = hn::Set(du, pixel), s = hn::Set(du, first + i);
    const auto four = second ? second_random_at_vertex(d, sampler, p, s, vertex, true)
                             : random_at_vertex(d, sampler, p, s, vertex, true);
    for (int k = 0; k < 4; ++k) *out++ = hn::GetLane(four.v[k]);
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

struct Point {
  std::uint32_t v[4];
};

std::vector<Point> points_of(std::uint32_t name, std::uint32_t first, std::size_t count, std::uint32_t order = 0) {
  std::vector<Point> out(count);
  HWY_NAMESPACE::points_32(name, order, first, count, out[0].v);
  return out;
}

std::vector<double> numbers_of(const Sampler& sampler, std::uint32_t pixel, std::uint32_t vertex, std::uint32_t first,
                               std::size_t count, bool second = false) {
  std::vector<double> out(4 * count);
  HWY_NAMESPACE::numbers(sampler, pixel, vertex, second, first, count, out.data());
  return out;
}

TEST(KernelSampler, ColumnsMatchThePublishedPoints) {
  // Without scrambling, point 1 is 1/2, point 2 is 1/4 or 3/4, and point 4 an odd multiple of 1/8: joe2008's table for
  // three dimensions.
  const auto value = [](std::uint32_t reversed) {
    double out = 0;
    for (int bit = 0; bit < 32; ++bit) out += (reversed >> bit & 1) != 0 ? std::ldexp(1.0, -bit - 1) : 0;
    return out;
  };
  const auto& third = kSobolColumns.third;
  EXPECT_EQ(value(third[0]), 0.5);
  EXPECT_EQ(value(third[0] ^ third[1]), 0.25);
  EXPECT_EQ(value(third[1] ^ third[2]), 0.375 + 0.75 - 2 * 0.25);  // 0.11 ^ 0.011 in binary: 0.101
  EXPECT_EQ(value(kSobolColumns.fourth[0]), 0.5);
  EXPECT_EQ(value(kSobolColumns.fourth[1]), 0.75);
  EXPECT_EQ(value(kSobolColumns.fourth[2]), 0.125);
}

TEST(KernelSampler, BothLaneWidthsGiveTheSamePoints) {
  std::vector<std::uint32_t> wide(4 * 1000), narrow(4 * 1000);
  for (const std::uint32_t name : {0u, 1u, 0xdeadbeefu}) {
    for (std::uint32_t order = 0; order < kSobolOrders.size(); ++order) {
      HWY_NAMESPACE::points_64(name, order, 37, 1000, wide.data());
      HWY_NAMESPACE::points_32(name, order, 37, 1000, narrow.data());
      EXPECT_EQ(wide, narrow);
    }
  }
}

/// The orders of bounce vertices permute points in blocks of 2^kSobolFreeBits; those of the camera and time do not.
int smallest_block_bits(std::uint32_t order) {
  return order == 0 || order == kSobolTimeOrder ? 0 : static_cast<int>(kSobolFreeBits);
}

TEST(KernelSampler, EveryBlockIsANetInTheFirstTwoDimensions) {
  for (std::uint32_t order = 0; order < kSobolOrders.size(); ++order) {
    for (std::uint32_t name = 1; name < 20; ++name) {
      for (int bits = smallest_block_bits(order); bits <= 8; ++bits) {
        const std::size_t count = std::size_t{1} << bits;
        const auto p = points_of(name, static_cast<std::uint32_t>(3 * count), count, order);
        for (int across = 0; across <= bits;
             ++across) {  // 2^across columns x 2^(bits - across) rows: one point per cell
          std::set<std::pair<std::uint32_t, std::uint32_t>> cells;
          for (const Point& point : p)
            cells.insert({across == 0 ? 0 : point.v[0] >> (32 - across),
                          across == bits ? 0 : point.v[1] >> (32 - (bits - across))});
          ASSERT_EQ(cells.size(), count) << order << " " << name << " " << bits << " " << across;
        }
      }
    }
  }
}

TEST(KernelSampler, EachDimensionIsStratifiedAtEveryPowerOfTwo) {
  for (std::uint32_t order = 0; order < kSobolOrders.size(); ++order)
    for (std::uint32_t name = 1; name < 20; ++name)
      for (const int bits : {smallest_block_bits(order) + 1, 9})
        for (std::size_t k = 0; k < 4; ++k) {
          std::set<std::uint32_t> strata;
          for (const Point& p : points_of(name, 0, std::size_t{1} << bits, order)) strata.insert(p.v[k] >> (32 - bits));
          ASSERT_EQ(strata.size(), std::size_t{1} << bits);
        }
}

/// z-score of equally likely cells: (sum (n - e)^2 / e - f) / sqrt(2 f), approximately normal for many cells.
double z_of(const std::vector<int>& cells) {
  double total = 0, chi = 0;
  for (const int n : cells) total += n;
  const double expected = total / static_cast<double>(cells.size());
  for (const int n : cells) chi += (n - expected) * (n - expected) / expected;
  const double freedom = static_cast<double>(cells.size()) - 1;
  return (chi - freedom) / std::sqrt(2 * freedom);
}

TEST(KernelSampler, EveryDimensionPairIsUniformOverScrambleSeeds) {
  constexpr int kSide = 32, kNames = 200000;
  for (const std::uint32_t index : {0u, 1u, 2u, 3u, 5u, 16u, 1000u}) {
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}) {
      std::vector<int> cells(kSide * kSide);
      for (std::uint32_t name = 0; name < kNames; ++name) {
        const Point p = points_of(name * 0x9e3779b1u, index, 1)[0];
        ++cells[(p.v[a] >> 27) * kSide + (p.v[b] >> 27)];
      }
      EXPECT_LT(std::abs(z_of(cells)), 5) << index << " " << a << b;
    }
  }
}

/// Variance of the mean product of two numbers at different vertices, relative to independent numbers.
struct Excess {
  double mean = 0;     ///< over all pairs of vertices and numbers
  double largest = 0;  ///< maximum over pairs of vertices
};
///
/// `with_second` second points are taken as vertices after the others
Excess product_variance(SamplerKind kind, std::size_t samples, std::uint32_t vertices, std::uint32_t first_sample = 0,
                        bool with_second = false) {
  constexpr std::size_t kNumbers = 2;  // that direct a ray
  const std::uint32_t pixels = static_cast<std::uint32_t>(std::max<std::size_t>(200, 20000 / samples));
  Sampler sampler;
  sampler.kind = kind;
  sampler.blue_noise_bits = static_cast<int>(std::bit_width(samples - 1));
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> sums;
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    std::vector<std::vector<double>> u;
    for (const bool second : {false, true})
      for (std::uint32_t v = 0; v < vertices && (with_second || !second); ++v)
        u.push_back(numbers_of(sampler, (pixel / 97) << 16 | pixel % 97, v, first_sample, samples, second));
    for (std::uint32_t a = 0; a < u.size(); ++a) {
      for (std::uint32_t b = a + 1; b < u.size(); ++b) {
        for (std::size_t i = 0; i < kNumbers * kNumbers; ++i) {
          double sum = 0;
          for (std::size_t s = 0; s < samples; ++s)
            sum += (u[a][4 * s + i / kNumbers] - 0.5) * (u[b][4 * s + i % kNumbers] - 0.5);
          // Each factor's variance is 1/12.
          sums[{a, b}] += sum * sum * 144 / static_cast<double>(samples) / (pixels * kNumbers * kNumbers);
        }
      }
    }
  }
  Excess out;
  for (const auto& [pair, variance] : sums) {
    out.mean += variance / static_cast<double>(sums.size());
    out.largest = std::max(out.largest, variance);
  }
  return out;
}

/// With a nested shuffle per vertex, samples 2k and 2k + 1 would be in opposite halves everywhere, and the mean 1.58.
TEST(KernelSampler, CrossVertexProductVarianceDoesNotExceedIndependent) {
  for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kBlueNoise}) {
    for (std::size_t samples = 4; samples <= 1024; samples *= 2) {
      const Excess at = product_variance(kind, samples, kSobolVertices);
      std::printf("%4zu samples: %.3f, at most %.3f for a pair of vertices\n", samples, at.mean, at.largest);
      EXPECT_LE(at.mean, 1.05) << samples;
      EXPECT_LE(at.largest, samples < 64 ? 3 : 1.25) << samples;
    }
  }
  for (std::size_t samples = 16; samples <= 1024; samples *= 4)
    EXPECT_LE(product_variance(SamplerKind::kSobol, samples, 3).mean, 0.7) << "first three vertices, " << samples;
  EXPECT_LE(product_variance(SamplerKind::kSobol, 64, kSobolVertices, Sampler::kSecondHalf + 192).mean, 1.05);
  EXPECT_LE(product_variance(SamplerKind::kSobol, 16, kSobolVertices + 3).mean, 1.05) << "including later vertices";
  EXPECT_NEAR(product_variance(SamplerKind::kIndependent, 16, 4).mean, 1, 0.05) << "independent numbers must give 1";
}

TEST(KernelSampler, SecondPointProductVarianceDoesNotExceedIndependent) {
  for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kBlueNoise}) {
    for (std::size_t samples = 4; samples <= 256; samples *= 4) {
      const Excess at = product_variance(kind, samples, 4, 0, true);
      std::printf("%4zu samples: %.3f, of a pair of points at most %.3f\n", samples, at.mean, at.largest);
      EXPECT_LE(at.mean, 1.05) << samples;
      EXPECT_LE(at.largest, samples < 64 ? 3 : 1.25) << samples;
    }
  }
  EXPECT_NEAR(product_variance(SamplerKind::kIndependent, 16, 2, 0, true).mean, 1, 0.1);
}

TEST(KernelSampler, SecondPointsDifferFromAllOthers) {
  for (const SamplerKind kind : {SamplerKind::kIndependent, SamplerKind::kSobol}) {
    Sampler sampler;
    sampler.kind = kind;
    std::set<std::vector<double>> points;
    const std::uint32_t vertices = kSobolVertices + 2;
    for (const bool second : {false, true})
      for (std::uint32_t v = 0; v < vertices; ++v)
        for (std::uint32_t s = 0; s < 16; ++s) points.insert(numbers_of(sampler, 5, v, s, 1, second));
    EXPECT_EQ(points.size(), 2 * vertices * 16);
  }
}

TEST(KernelSampler, VerticesHalvesPixelsAndSeedsAreIndependent) {
  Sampler sampler;
  constexpr int kSide = 16;
  std::vector<int> vertices(kSide * kSide), halves(kSide * kSide), pixels(kSide * kSide), seeds(kSide * kSide);
  Sampler other = sampler;
  other.seed = 2;
  const auto cell = [](double a, double b) {
    return static_cast<std::size_t>(a * kSide) * kSide + static_cast<std::size_t>(b * kSide);
  };
  for (std::uint32_t pixel = 0; pixel < 20000; ++pixel) {
    const auto here = numbers_of(sampler, pixel, 0, 3, 1), next = numbers_of(sampler, pixel, 1, 3, 1),
               half = numbers_of(sampler, pixel, 0, Sampler::kSecondHalf + 3, 1),
               beside = numbers_of(sampler, pixel + 1, 0, 3, 1), reseeded = numbers_of(other, pixel, 0, 3, 1);
    for (std::size_t k = 0; k < 4; ++k) {
      ++vertices[cell(here[k], next[k])];
      ++halves[cell(here[k], half[k])];
      ++pixels[cell(here[k], beside[k])];
      ++seeds[cell(here[k], reseeded[k])];
    }
  }
  for (const auto& cells : {vertices, halves, pixels, seeds}) EXPECT_LT(std::abs(z_of(cells)), 5);
}

TEST(KernelSampler, BlueNoiseNeighboursShareOneSequence) {
  Sampler sampler;
  sampler.kind = SamplerKind::kBlueNoise;
  sampler.blue_noise_bits = 2;
  // Four samples in each of 2 x 2 pixels: together the sixteen points are one net.
  std::set<int> strata;
  for (const std::uint32_t pixel : {0x00060004u, 0x00060005u, 0x00070004u, 0x00070005u}) {
    const auto n = numbers_of(sampler, pixel, 0, 0, 4);
    for (std::size_t i = 0; i < 4; ++i) strata.insert(static_cast<int>(n[4 * i] * 16));
  }
  EXPECT_EQ(strata.size(), 16u);
  // A pixel's further samples differ from its neighbour's.
  EXPECT_NE(numbers_of(sampler, 0x00060004u, 0, 4, 4), numbers_of(sampler, 0x00060005u, 0, 0, 4));
}

}  // namespace
}  // namespace orrery::kernel
