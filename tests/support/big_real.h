// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpfr.h>

namespace orrery::test {

/// A 320-bit floating-point number: products of doubles from 1e-30 to 1e30 lose nothing that a test could detect.
class BigReal {
 public:
  BigReal() : BigReal(0.0) {}
  BigReal(double value) {  // NOLINT(google-explicit-constructor): doubles are exact here
    mpfr_init2(value_, kBits);
    mpfr_set_d(value_, value, MPFR_RNDN);
  }
  BigReal(const BigReal& other) : BigReal() { mpfr_set(value_, other.value_, MPFR_RNDN); }
  BigReal& operator=(const BigReal& other) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~BigReal() { mpfr_clear(value_); }

  friend BigReal operator+(const BigReal& a, const BigReal& b) { return apply(mpfr_add, a, b); }
  friend BigReal operator-(const BigReal& a, const BigReal& b) { return apply(mpfr_sub, a, b); }
  friend BigReal operator*(const BigReal& a, const BigReal& b) { return apply(mpfr_mul, a, b); }
  friend BigReal operator/(const BigReal& a, const BigReal& b) { return apply(mpfr_div, a, b); }
  friend bool operator<(const BigReal& a, const BigReal& b) { return mpfr_less_p(a.value_, b.value_) != 0; }
  friend BigReal sqrt(const BigReal& a) {
    BigReal out;
    mpfr_sqrt(out.value_, a.value_, MPFR_RNDN);
    return out;
  }
  double to_double() const { return mpfr_get_d(value_, MPFR_RNDN); }

 private:
  static constexpr mpfr_prec_t kBits = 320;
  template <class Function>
  static BigReal apply(Function function, const BigReal& a, const BigReal& b) {
    BigReal out;
    function(out.value_, a.value_, b.value_, MPFR_RNDN);
    return out;
  }
  mpfr_t value_;
};

}  // namespace orrery::test
