// SPDX-License-Identifier: Apache-2.0
#include "points/ticks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace orrery::points {
namespace {

/// Ticks are at least this share of the range apart.
constexpr double kMinShare = 0.1;
/// Numbers from this size on, and ranges below the second, have an exponent.
constexpr double kLargestFixed = 1e6, kSmallestFixed = 1e-3;
/// Smaller ranges have one tick, because the spacing of doubles would be visible.
constexpr double kMinRange = 1e-290, kMinRelativeRange = 1e-12;

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

std::string fixed_text(double value, int decimals) {
  char text[400];
  const auto [end, status] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, std::max(decimals, 0));
  return status == std::errc() ? std::string(text, end) : "?";
}

std::string shortest_text(double value) {
  char text[64];
  const auto [end, status] = std::to_chars(text, text + sizeof text, value);
  std::string out(text, status == std::errc() ? end : text);
  std::erase(out, '+');  // of "1e+300"
  return out;
}

}  // namespace

std::vector<Tick> nice_ticks(double first, double last) {
  const double low = std::min(first, last), high = std::max(first, last);
  const double size = std::max(std::abs(low), std::abs(high)), range = high - low;
  if (!std::isfinite(range)) return {{low, shortest_text(low)}, {high, shortest_text(high)}};
  const bool is_fixed = size == 0 || (size >= kSmallestFixed && size < kLargestFixed);
  if (!(range > std::max(kMinRange, kMinRelativeRange * size))) return {{low, shortest_text(low)}};
  int exponent = exponent_of(range * kMinShare);
  double digit = 1;
  for (const double larger : {2.0, 5.0, 10.0}) {
    if (digit * std::pow(10, exponent) >= range * kMinShare * (1 - 1e-9)) break;
    digit = larger;
  }
  if (digit == 10) {
    digit = 1;
    ++exponent;
  }
  const int largest = exponent_of(size);
  std::vector<Tick> out;
  // Multiples are divided where possible: 3 / 10 is the double closest to 0.3, 3 * 0.1 is not.
  const double power = std::pow(10, std::abs(exponent));
  const auto multiple = [&](double n) { return exponent < 0 ? n * digit / power : n * digit * power; };
  const double step = multiple(1);
  for (double n = std::ceil(low / step - 1e-9); n <= std::floor(high / step + 1e-9); ++n) {
    const double value = n == 0 ? 0 : multiple(n);  // not -0
    Tick tick{value, is_fixed ? fixed_text(value, -exponent) : "0"};
    if (!is_fixed && value != 0) {
      // All use the exponent of the largest.
      const double mantissa = value / std::pow(10, largest);
      tick.label = fixed_text(mantissa, largest - exponent) + 'e' + std::to_string(largest);
    }
    out.push_back(std::move(tick));
  }
  return out;
}

}  // namespace orrery::points
