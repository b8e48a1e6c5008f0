// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace orrery::test {

/// A 113-bit floating-point number, ten times as fast as BigReal and precise enough without heavy cancellation.
class QuadReal {
 public:
  QuadReal(double value = 0) : value_(value) {}  // NOLINT(google-explicit-constructor): doubles are exact here

  friend QuadReal operator+(QuadReal a, QuadReal b) { return QuadReal(a.value_ + b.value_, 0); }
  friend QuadReal operator-(QuadReal a, QuadReal b) { return QuadReal(a.value_ - b.value_, 0); }
  friend QuadReal operator*(QuadReal a, QuadReal b) { return QuadReal(a.value_ * b.value_, 0); }
  friend QuadReal operator/(QuadReal a, QuadReal b) { return QuadReal(a.value_ / b.value_, 0); }
  friend bool operator<(QuadReal a, QuadReal b) { return a.value_ < b.value_; }
  /// Two Newton steps double the 53 bits of the double result twice.
  friend QuadReal sqrt(QuadReal a) {
    if (!(0.0 < a)) return 0.0;
    QuadReal x = std::sqrt(a.to_double());
    for (int i = 0; i < 2; ++i) x = (x + a / x) * 0.5;
    return x;
  }
  double to_double() const { return static_cast<double>(value_); }

 private:
  __extension__ using Number = __float128;
  QuadReal(Number value, int) : value_(value) {}
  Number value_;
};

}  // namespace orrery::test
