// SPDX-License-Identifier: Apache-2.0
// Directions sampled from image backgrounds against the integral of their density, which is known exactly: within a
// cell the density is bilinear in longitude and cosine, so its integral over a rectangle is its value at the midpoint
// times the solid angle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <hwy/highway.h>

#include "compile/environment.h"
#include "kernel/environment-inl.h"
#include "kernel/isa.h"
#include "kernel/sampler-inl.h"
#include "math/dispatch.h"
#include "scene/lat_long_map.h"
#include "support/chi_square.h"

namespace orrery::test {

/// Directions and what is known of each, in rows whose length is a multiple of 16.
struct Rows {
  std::vector<double> u, v, x, y, z, r, g, b, inverse, pdf;
  explicit Rows(std::size_t count)
      : u(count), v(count), x(count), y(count), z(count), r(count), g(count), b(count), inverse(count), pdf(count) {}
};

}  // namespace orrery::test

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

template <class D>
hn::Vec<D> load(D d, const std::vector<double>& from, std::size_t first) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T lanes[hn::MaxLanes(D())];
  for (std::size_t l = 0; l < hn::Lanes(d); ++l) lanes[l] = static_cast<T>(from[first + l]);
  return hn::Load(d, lanes);
}
template <class D>
void store(D d, hn::Vec<D> v, std::vector<double>& to, std::size_t first) {
  HWY_ALIGN hn::TFromD<D> lanes[hn::MaxLanes(D())];
  hn::Store(v, d, lanes);
  for (std::size_t l = 0; l < hn::Lanes(d); ++l) to[first + l] = static_cast<double>(lanes[l]);
}

/// Samples with u and v; fills the rest but pdf.
template <class D>
void sample_all(D d, const kernel::Environment& env, Rows& out) {
  for (std::size_t i = 0; i < out.u.size(); i += hn::Lanes(d)) {
    const auto s = k::sample_environment(d, env, load(d, out.u, i), load(d, out.v, i));
    store(d, s.direction.x, out.x, i);
    store(d, s.direction.y, out.y, i);
    store(d, s.direction.z, out.z, i);
    store(d, s.radiance.x, out.r, i);
    store(d, s.radiance.y, out.g, i);
    store(d, s.radiance.z, out.b, i);
    store(d, s.inverse_pdf, out.inverse, i);
  }
}
/// Fills pdf and radiance of the directions.
template <class D>
void judge_all(D d, const kernel::Environment& env, Rows& out) {
  for (std::size_t i = 0; i < out.u.size(); i += hn::Lanes(d)) {
    const k::Vec3<hn::Vec<D>> w = {load(d, out.x, i), load(d, out.y, i), load(d, out.z, i)};
    store(d, k::pdf_of(d, env, k::environment_footprint(d, env, w)), out.pdf, i);
    const auto radiance = k::environment_radiance(d, env, w);
    store(d, radiance.x, out.r, i);
    store(d, radiance.y, out.g, i);
    store(d, radiance.z, out.b, i);
  }
}
void sample_double(const kernel::Environment& env, Rows& out) { sample_all(hn::ScalableTag<double>(), env, out); }
void sample_float(const kernel::Environment& env, Rows& out) { sample_all(hn::ScalableTag<float>(), env, out); }
void sample_one(const kernel::Environment& env, Rows& out) { sample_all(hn::FixedTag<double, 1>(), env, out); }
void judge_map_double(const kernel::Environment& env, Rows& out) { judge_all(hn::ScalableTag<double>(), env, out); }
void judge_map_float(const kernel::Environment& env, Rows& out) { judge_all(hn::ScalableTag<float>(), env, out); }

/// Fills u and v with the numbers of a pixel's samples at one vertex.
void draw_numbers(kernel::SamplerKind kind, std::uint32_t pixel, std::uint32_t first, Rows& out) {
  const hn::ScalableTag<double> d;
  const hn::RebindToUnsigned<std::remove_const_t<decltype(d)>> du;
  for (std::size_t i = 0; i < out.u.size(); i += hn::Lanes(d)) {
    const auto random = k::random_at_vertex(d, {kind, 9}, hn::Set(du, pixel), hn::Iota(du, first + i), 1, false);
    hn::StoreU(random.v[0], d, &out.u[i]);
    hn::StoreU(random.v[1], d, &out.v[i]);
  }
}

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#ifndef ORRERY_OTHER_SET
namespace orrery::test {

using OfRows = void(const kernel::Environment& env, Rows& out);
ORRERY_DECLARE_INSTANCES(OfRows sample_double, sample_float, sample_one, judge_map_double, judge_map_float;
                         void draw_numbers(kernel::SamplerKind kind, std::uint32_t pixel, std::uint32_t first,
                                           Rows& out);)

namespace {

using compile::EnvironmentMap;
using compile::EnvironmentSampling;
using compile::EnvironmentSettings;
using scene::LatLongMap;

/// Texels of very different brightness, a quarter of them black.
std::shared_ptr<LatLongMap> wild_image(int width, int height) {
  auto image = std::make_shared<LatLongMap>(width, height);
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 3 * width; ++x)
      image->row(y)[x] = uniform(random) < 0.25 ? 0.0F : static_cast<float>(std::exp2(6 * uniform(random)));
  return image;
}

/// A grey map with one texel as much brighter as given.
std::shared_ptr<LatLongMap> hot_image(int width, int height, float ratio) {
  auto image = std::make_shared<LatLongMap>(width, height);
  for (int y = 0; y < height; ++y) std::fill_n(image->row(y), 3 * width, 1.0F);
  std::fill_n(image->row(height / 3) + 3 * (width / 5), 3, ratio);
  return image;
}

scene::Sun low_sun() { return {{0.6, 0.48, 0.64}, 1.081e-5, {4e5, 3e5, 2e5}}; }

EnvironmentMap map_of(const std::shared_ptr<LatLongMap>& image, EnvironmentSampling sampling) {
  EnvironmentSettings settings;
  settings.rotation = 40;
  settings.scale = 2;
  settings.sampling = sampling;
  return EnvironmentMap(image, settings);
}

/// The rectangles in longitude and cosine into which `split` x `split` parts divide each cell.
class Rectangles {
 public:
  Rectangles(const kernel::Environment& env, int split) : env_(env), split_(split) {
    const int height = static_cast<int>(env.height);
    cosines_.push_back(1);
    for (int j = 1; j <= height; ++j) cosines_.push_back(std::cos(std::numbers::pi * (j - 0.5) / height));
    cosines_.push_back(-1);
  }
  std::size_t columns() const { return env_.width * static_cast<std::size_t>(split_); }
  std::size_t rows() const { return (env_.height + 1) * static_cast<std::size_t>(split_); }
  double cosine(double row) const {  // in rectangles from the top
    const double cell = std::min(std::floor(row / split_), static_cast<double>(env_.height));
    const double begin = cosines_[static_cast<std::size_t>(cell)], end = cosines_[static_cast<std::size_t>(cell) + 1];
    return begin + (end - begin) * (row / split_ - cell);
  }
  double solid_angle(std::size_t row) const {
    const auto at = static_cast<double>(row);
    return (cosine(at) - cosine(at + 1)) * 2 * std::numbers::pi / static_cast<double>(columns());
  }
  /// Directions of all midpoints, and some more at the end to fill a row.
  Rows midpoints() const {
    Rows out((columns() * rows() + 15) / 16 * 16);
    for (std::size_t i = 0; i < columns() * rows(); ++i) {
      const double c = cosine(static_cast<double>(i / columns()) + 0.5), s = std::sqrt(1 - c * c);
      const double across = (static_cast<double>(i % columns()) + 0.5) / split_ + 0.5;  // texels from the left edge
      const double longitude = 2 * std::numbers::pi * (0.5 + env_.turn - across / env_.width);
      out.x[i] = s * std::sin(longitude);
      out.y[i] = c;
      out.z[i] = s * std::cos(longitude);
    }
    return out;
  }
  std::size_t index(double x, double y, double z) const {
    const double u = 0.5 - std::atan2(x, z) / (2 * std::numbers::pi) + env_.turn - 0.5 / env_.width;
    const auto column =
        std::min(static_cast<std::size_t>((u - std::floor(u)) * static_cast<double>(columns())), columns() - 1);
    std::size_t low = 0, high = rows();
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (cosine(static_cast<double>(middle)) >= y ? low : high) = middle;
    }
    return low * columns() + column;
  }

 private:
  const kernel::Environment& env_;
  int split_;
  std::vector<double> cosines_;
};

std::vector<std::shared_ptr<LatLongMap>> images() {
  std::vector<std::shared_ptr<LatLongMap>> out;
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 6}, {5, 3}, {16, 8}, {37, 18}, {20, 41}})
    out.push_back(wild_image(width, height));
  out.push_back(hot_image(64, 32, 1e6F));
  return out;
}

std::string name_of(const LatLongMap& image, EnvironmentSampling sampling) {
  return std::to_string(image.width()) + " x " + std::to_string(image.height()) +
         (sampling == EnvironmentSampling::kCompensated ? ", compensated" : ", complete");
}

constexpr EnvironmentSampling kSamplings[] = {EnvironmentSampling::kCompensated, EnvironmentSampling::kComplete};

TEST(StatisticalEnvironment, DensityIntegratesToOne) {
  for (const auto& image : images()) {
    for (const EnvironmentSampling sampling : kSamplings) {
      const EnvironmentMap map = map_of(image, sampling);
      if (!map.view().is_sampled) continue;
      const Rectangles cells(map.view(), 1);
      Rows at = cells.midpoints();
      ORRERY_BEST_INSTANCE(judge_map_double)(map.view(), at);
      double total = 0;
      for (std::size_t i = 0; i < cells.columns() * cells.rows(); ++i)
        total += at.pdf[i] * cells.solid_angle(i / cells.columns());
      EXPECT_NEAR(total, 1, 1e-11) << name_of(*image, sampling);
    }
  }
}

TEST(StatisticalEnvironment, SamplesHaveTheDensity) {
  constexpr std::uint32_t kBatch = 1 << 14, kBatches = 16;
  for (const auto& image : images()) {
    for (const EnvironmentSampling sampling : kSamplings) {
      const EnvironmentMap map = map_of(image, sampling);
      if (!map.view().is_sampled) continue;
      const Rectangles parts(map.view(), 2);
      Rows at = parts.midpoints();
      ORRERY_BEST_INSTANCE(judge_map_double)(map.view(), at);
      for (const bool in_double : {true, false}) {
        std::vector<double> expected(parts.columns() * parts.rows());
        std::vector<std::uint64_t> counts(expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
          expected[i] = at.pdf[i] * parts.solid_angle(i / parts.columns()) * kBatch * kBatches;
        Rows batch(kBatch);
        for (std::uint32_t n = 0; n < kBatches; ++n) {
          ORRERY_BEST_INSTANCE(draw_numbers)(kernel::SamplerKind::kIndependent, n, 0, batch);
          (in_double ? ORRERY_BEST_INSTANCE(sample_double) : ORRERY_BEST_INSTANCE(sample_float))(map.view(), batch);
          for (std::size_t i = 0; i < kBatch; ++i) ++counts[parts.index(batch.x[i], batch.y[i], batch.z[i])];
        }
        if (expected.size() < 3) continue;
        const ChiSquare result = chi_square(counts, expected);
        EXPECT_LT(std::abs(result.z), kLargestZ) << name_of(*image, sampling) << (in_double ? "" : ", float");
      }
    }
  }
}

/// The mean of 1 / pdf over samples is the solid angle of all directions that are sampled.
TEST(StatisticalEnvironment, CompleteSamplingReachesEveryDirection) {
  auto image = wild_image(24, 12);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 3 * 24; ++x) image->row(y)[x] += 0.5F;
  image->sun = low_sun();
  const EnvironmentMap map = map_of(image, EnvironmentSampling::kComplete);
  Rows batch(1 << 18);
  ORRERY_BEST_INSTANCE(draw_numbers)(kernel::SamplerKind::kSobol, 0, 0, batch);
  ORRERY_BEST_INSTANCE(sample_double)(map.view(), batch);
  double sum = 0;
  for (const double inverse : batch.inverse) sum += inverse;
  EXPECT_NEAR(sum / static_cast<double>(batch.u.size()), 4 * std::numbers::pi, 0.02);
}

TEST(StatisticalEnvironment, TheSunIsSampledByItsShareOfThePower) {
  auto image = wild_image(24, 12);
  image->sun = low_sun();
  const EnvironmentMap map = map_of(image, EnvironmentSampling::kComplete);
  const kernel::Environment& env = map.view();
  const double sun_power = 2 * std::numbers::pi * 1.081e-5 * 3e5 * 2;
  EXPECT_NEAR(env.sun_probability, sun_power / env.power, 1e-12);

  constexpr int kSide = 16;
  std::vector<std::uint64_t> counts(kSide * kSide);
  Rows batch(1 << 18);
  ORRERY_BEST_INSTANCE(draw_numbers)(kernel::SamplerKind::kIndependent, 0, 0, batch);
  ORRERY_BEST_INSTANCE(sample_double)(env, batch);
  Rows judged = batch;
  ORRERY_BEST_INSTANCE(judge_map_double)(env, judged);
  std::uint64_t inside = 0;
  const auto dot = [&](const math::Vec3d& a, std::size_t i) {
    return a.x * batch.x[i] + a.y * batch.y[i] + a.z * batch.z[i];
  };
  for (std::size_t i = 0; i < batch.u.size(); ++i) {
    ASSERT_NEAR(judged.pdf[i] * batch.inverse[i], 1, 1e-12);
    ASSERT_EQ(judged.r[i], batch.r[i]);
    ASSERT_NEAR(batch.x[i] * batch.x[i] + batch.y[i] * batch.y[i] + batch.z[i] * batch.z[i], 1, 1e-14);
    const double across = dot(env.sun_tangent, i), up = dot(env.sun_bitangent, i), square = across * across + up * up;
    const double versine = square / (1 + std::sqrt(1 - square)) / env.sun_one_minus_cos;
    if (versine >= 1 || dot(env.sun, i) < 0) continue;
    ++inside;
    const double turn = std::atan2(up, across) / (2 * std::numbers::pi) + 0.5;
    ++counts[static_cast<std::size_t>(std::min(kSide - 1, static_cast<int>(versine * kSide)) * kSide +
                                      std::min(kSide - 1, static_cast<int>(turn * kSide)))];
  }
  // The map adds next to nothing inside the cone.
  const double expected = env.sun_probability * static_cast<double>(batch.u.size());
  EXPECT_NEAR(static_cast<double>(inside), expected, 5 * std::sqrt(expected));
  EXPECT_LT(std::abs(chi_square_of_equal_bins(counts).z), kLargestZ);
}

/// Radiance over density varies by the difference between an angle and its cosine within a row alone, so that a sun of
/// one texel causes next to no noise.
TEST(StatisticalEnvironment, RadianceIsAlmostProportionalToTheDensity) {
  const EnvironmentMap map = map_of(hot_image(512, 256, 1e9F), EnvironmentSampling::kCompensated);
  Rows batch(1 << 16);
  ORRERY_BEST_INSTANCE(draw_numbers)(kernel::SamplerKind::kIndependent, 0, 0, batch);
  ORRERY_BEST_INSTANCE(sample_double)(map.view(), batch);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < batch.u.size(); ++i) {
    const double excess = (batch.r[i] - 2) * batch.inverse[i];
    sum += excess;
    squares += excess * excess;
  }
  const auto count = static_cast<double>(batch.u.size());
  EXPECT_LT(squares / count / (sum / count * sum / count) - 1, 1e-4);
}

/// Sobol points keep their advantage through the warp: the error of a smooth integral, the irradiance, falls much
/// faster than with random numbers.
TEST(StatisticalEnvironment, SamplesStayStratified) {
  const EnvironmentMap map = map_of(wild_image(64, 32), EnvironmentSampling::kComplete);
  constexpr std::uint32_t kRuns = 64, kSamples = 256;
  double error[2] = {};
  double reference = 0;
  for (const std::size_t kind : {0u, 1u}) {
    std::vector<double> means;
    for (std::uint32_t run = 0; run < kRuns; ++run) {
      Rows batch(kSamples);
      ORRERY_BEST_INSTANCE(draw_numbers)
      (kind == 0 ? kernel::SamplerKind::kSobol : kernel::SamplerKind::kIndependent, run, 0, batch);
      ORRERY_BEST_INSTANCE(sample_double)(map.view(), batch);
      double sum = 0;
      for (std::size_t i = 0; i < kSamples; ++i)
        sum += std::max(batch.y[i], 0.0) * (batch.r[i] + batch.g[i] + batch.b[i]) * batch.inverse[i];
      means.push_back(sum / kSamples);
      if (kind == 0) reference += means.back() / kRuns;
    }
    for (const double mean : means) error[kind] += (mean - reference) * (mean - reference);
  }
  EXPECT_LT(std::sqrt(error[0] / error[1]), 0.2);
}

TEST(StatisticalEnvironment, BitsDoNotDependOnLanesOrInstructionSet) {
  auto image = wild_image(37, 18);
  image->sun = low_sun();
  image->sun.radiance = {4e4, 3e4, 2e4};
  const EnvironmentMap map = map_of(image, EnvironmentSampling::kCompensated);
  Rows first(1 << 14);
  ORRERY_BEST_INSTANCE(draw_numbers)(kernel::SamplerKind::kIndependent, 0, 0, first);
  Rows one = first;
  ORRERY_BEST_INSTANCE(sample_double)(map.view(), first);
  ORRERY_BEST_INSTANCE(sample_one)(map.view(), one);
  EXPECT_EQ(one.x, first.x);
  EXPECT_EQ(one.r, first.r);
  EXPECT_EQ(one.inverse, first.inverse);
  for (const std::string& isa : kernel::available_isas()) {
    if (isa.find("sse") != std::string::npos || isa.find("SSE") != std::string::npos)
      continue;  // without fused operations
    ASSERT_TRUE(kernel::limit_isa(isa));
    Rows other = first;
    ORRERY_BEST_INSTANCE(sample_double)(map.view(), other);
    EXPECT_EQ(other.x, first.x) << isa;
    EXPECT_EQ(other.y, first.y) << isa;
    EXPECT_EQ(other.z, first.z) << isa;
    EXPECT_EQ(other.g, first.g) << isa;
    EXPECT_EQ(other.inverse, first.inverse) << isa;
  }
  ASSERT_TRUE(kernel::limit_isa(""));
}

TEST(StatisticalEnvironment, SinglePrecisionAgreesWithDouble) {
  auto image = wild_image(64, 32);
  image->sun = low_sun();
  const EnvironmentMap map = map_of(image, EnvironmentSampling::kCompensated);
  Rows wide(1 << 14);
  ORRERY_BEST_INSTANCE(draw_numbers)(kernel::SamplerKind::kIndependent, 0, 0, wide);
  ORRERY_BEST_INSTANCE(sample_float)(map.view(), wide);  // directions that a float holds
  Rows narrow = wide;
  ORRERY_BEST_INSTANCE(judge_map_double)(map.view(), wide);
  ORRERY_BEST_INSTANCE(judge_map_float)(map.view(), narrow);
  std::size_t on_the_rim = 0;
  for (std::size_t i = 0; i < wide.u.size(); ++i) {
    if (std::abs(narrow.r[i] - wide.r[i]) > 1e4) {  // the rim of the sun
      ++on_the_rim;
      continue;
    }
    ASSERT_NEAR(narrow.r[i], wide.r[i], 1e-3 * std::max(wide.r[i], 1.0));
    ASSERT_NEAR(narrow.pdf[i], wide.pdf[i], 1e-3 * std::max(wide.pdf[i], 0.05));
  }
  EXPECT_LT(on_the_rim, wide.u.size() / 500);
}

}  // namespace
}  // namespace orrery::test
#endif
