// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "unit/math/functions_test.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
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
void sin_cos_double(const double* u, double* s, double* c, std::size_t n) { sin_cos_all(u, s, c, n); }
void sin_cos_float(const float* u, float* s, float* c, std::size_t n) { sin_cos_all(u, s, c, n); }

}  // namespace orrery::math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::math {
namespace {

HWY_EXPORT(sin_cos_double);
HWY_EXPORT(sin_cos_float);

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
  EXPECT_LE(worst_turn_error<double>(ORRERY_BEST(sin_cos_double)), 2.3e-16);
  EXPECT_LE(worst_turn_error<float>(ORRERY_BEST(sin_cos_float)), 1.2e-7);
}

TEST(MathFunctions, QuarterTurnsAreExact) {
  const double u[8] = {0, 0.25, 0.5, 0.75, 1, 0.125, 0, 0};
  double s[8], c[8];
  ORRERY_BEST(sin_cos_double)(u, s, c, 8);
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
