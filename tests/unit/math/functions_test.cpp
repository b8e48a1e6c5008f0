// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <hwy/highway.h>

#include "math/dispatch.h"
#include "math/functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::math::HWY_NAMESPACE {

template <class T>
void sin_cos_all(const T* u, T* sine, T* cosine, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto turn = sin_cos_turn(d, hn::LoadU(d, u + i));
    hn::StoreU(turn.sin, d, sine + i);
    hn::StoreU(turn.cos, d, cosine + i);
  }
}
template <class T>
void angle_all(const T* x, const T* y, T* turn, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(atan2_turn(d, hn::LoadU(d, y + i), hn::LoadU(d, x + i)), d, turn + i);
}
void angle_double(const double* x, const double* y, double* turn, std::size_t n) { angle_all(x, y, turn, n); }
void angle_float(const float* x, const float* y, float* turn, std::size_t n) { angle_all(x, y, turn, n); }
template <class T>
void product_errors(const T* a, const T* b, T* error, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, a + i), y = hn::LoadU(d, b + i);
    hn::StoreU(product_error(d, x, y, x * y), d, error + i);
  }
}
void product_errors_double(const double* a, const double* b, double* e, std::size_t n) { product_errors(a, b, e, n); }
void product_errors_float(const float* a, const float* b, float* e, std::size_t n) { product_errors(a, b, e, n); }
void sin_cos_double(const double* u, double* s, double* c, std::size_t n) { sin_cos_all(u, s, c, n); }
void sin_cos_float(const float* u, float* s, float* c, std::size_t n) { sin_cos_all(u, s, c, n); }

}  // namespace orrery::math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#ifndef ORRERY_OTHER_SET
namespace orrery::math {

using OfDoubles = void(const double* a, const double* b, double* out, std::size_t count);
using OfFloats = void(const float* a, const float* b, float* out, std::size_t count);
ORRERY_DECLARE_INSTANCES(OfDoubles angle_double, product_errors_double; OfFloats angle_float, product_errors_float;
                         void sin_cos_double(const double* u, double* sine, double* cosine, std::size_t count);
                         void sin_cos_float(const float* u, float* sine, float* cosine, std::size_t count);)

namespace {

constexpr std::size_t kCount = 1 << 16;
constexpr long double kTwoPi = 6.283185307179586476925286766559005768L;

template <class T>
std::vector<T> numbers_in_unit_interval() {
  std::vector<T> u(kCount);
  for (std::size_t i = 0; i < kCount; ++i) u[i] = static_cast<T>(i) / static_cast<T>(kCount - 1);
  return u;
}

template <class T, class Function>
double worst_turn_error(Function function) {
  const auto u = numbers_in_unit_interval<T>();
  std::vector<T> s(kCount), c(kCount);
  function(u.data(), s.data(), c.data(), kCount);
  long double worst = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const long double angle = kTwoPi * static_cast<long double>(u[i]);
    worst = std::max({worst, std::abs(std::sin(angle) - static_cast<long double>(s[i])),
                      std::abs(std::cos(angle) - static_cast<long double>(c[i]))});
  }
  return static_cast<double>(worst);
}

TEST(MathFunctions, SineAndCosineOfATurn) {
  EXPECT_LE(worst_turn_error<double>(ORRERY_BEST_INSTANCE(sin_cos_double)), 2.3e-16);
  EXPECT_LE(worst_turn_error<float>(ORRERY_BEST_INSTANCE(sin_cos_float)), 1.2e-7);
}

template <class T, class Function>
void expect_exact_product_errors(Function function, std::int64_t target) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> fraction(1, 2);
  std::uniform_int_distribution<int> exponent(-30, 30);
  std::vector<T> a(1024), b(1024), error(1024);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = static_cast<T>(std::ldexp(fraction(engine), exponent(engine)));
    b[i] = static_cast<T>(-std::ldexp(fraction(engine), exponent(engine)));
  }
  function(a.data(), b.data(), error.data(), a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_EQ(error[i], std::fma(a[i], b[i], -(a[i] * b[i]))) << "target " << target << ": " << a[i] << " * " << b[i];
}

TEST(MathFunctions, ErrorsOfProductsAreExactOnEveryTarget) {
  std::int64_t targets = target_choice().available();
  for (; targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    target_choice().limit(target);
    expect_exact_product_errors<double>(ORRERY_BEST_INSTANCE(product_errors_double), target);
    expect_exact_product_errors<float>(ORRERY_BEST_INSTANCE(product_errors_float), target);
  }
  target_choice().limit(-1);
}

struct WorstErrors {
  double absolute = 0, relative = 0;
};

/// Compares atan2_turn with long double, for angles down to the smallest in all four quadrants.
template <class T, class Function>
WorstErrors worst_angle_errors(Function function) {
  std::vector<T> x(kCount), y(kCount), turn(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    // Odd indices are small angles beside the x axis.
    const long double angle = i % 2 == 0 ? kTwoPi * static_cast<long double>(i) / kCount
                                         : std::exp2(-60.0L * static_cast<long double>(i) / kCount);
    const long double radius = std::exp2(static_cast<long double>(i % 41) - 20);
    x[i] = static_cast<T>(radius * std::cos(angle));
    y[i] = static_cast<T>(radius * std::sin(angle));
  }
  function(x.data(), y.data(), turn.data(), kCount);
  WorstErrors worst;
  for (std::size_t i = 0; i < kCount; ++i) {
    const long double expected = std::atan2(static_cast<long double>(y[i]), static_cast<long double>(x[i])) / kTwoPi;
    const auto error = static_cast<double>(std::abs(expected - static_cast<long double>(turn[i])));
    worst.absolute = std::max(worst.absolute, error);
    worst.relative = std::max(worst.relative, expected == 0 ? error : error / static_cast<double>(std::abs(expected)));
  }
  return worst;
}

TEST(MathFunctions, AngleOfAPoint) {
  const WorstErrors wide = worst_angle_errors<double>(ORRERY_BEST_INSTANCE(angle_double));
  EXPECT_LE(wide.absolute, 6e-17);
  EXPECT_LE(wide.relative, 4e-16);
  const WorstErrors narrow = worst_angle_errors<float>(ORRERY_BEST_INSTANCE(angle_float));
  EXPECT_LE(narrow.absolute, 4e-8);
  EXPECT_LE(narrow.relative, 2e-7);
}

TEST(MathFunctions, AnglesOfTheAxesAreExact) {
  const double x[16] = {0, 1, 0, -1, 0, 1, -1, -1, 1}, y[16] = {0, 0, 2, 0, -3, 1, 1, -1, -1};
  const double expected[9] = {0, 0, 0.25, 0.5, -0.25, 0.125, 0.375, -0.375, -0.125};
  double turn[16];
  ORRERY_BEST_INSTANCE(angle_double)(x, y, turn, 16);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(turn[i], expected[i]) << x[i] << ", " << y[i];
}

TEST(MathFunctions, QuarterTurnsAreExact) {
  const double u[8] = {0, 0.25, 0.5, 0.75, 1, 0.125, 0, 0};
  double s[8], c[8];
  ORRERY_BEST_INSTANCE(sin_cos_double)(u, s, c, 8);
  const double sine[5] = {0, 1, 0, -1, 0}, cosine[5] = {1, 0, -1, 0, 1};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(s[i], sine[i]) << u[i];
    EXPECT_EQ(c[i], cosine[i]) << u[i];
  }
  EXPECT_EQ(s[5], c[5]);
}

}  // namespace
}  // namespace orrery::math
#endif
