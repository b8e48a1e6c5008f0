// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "annotation/legend.h"
#include "base/text.h"

namespace orrery::annotation {

namespace {

/// Numbers from this size on, and ranges below the second, have an exponent.
constexpr double kLargestFixed = 1e6, kSmallestFixed = 1e-3;
/// Smaller ranges have one tick, because the spacing of doubles would be visible.
constexpr double kMinRange = 1e-290, kMinRelativeRange = 1e-12;

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

std::string fixed_text(double value, int decimals) { return fmt::format("{:.{}f}", value, std::max(decimals, 0)); }

std::string shortest_text(double value) {
  char text[64];  // more than any
  std::string out(text, std::to_chars(text, std::end(text), value).ptr);
  std::erase(out, '+');  // of "1e+300"
  return out;
}

}  // namespace

std::vector<Tick> nice_ticks(double first, double last, double least) {
  const double low = std::min(first, last), high = std::max(first, last);
  const double size = std::max(std::abs(low), std::abs(high)), range = high - low;
  if (!std::isfinite(range)) return {{low, shortest_text(low)}, {high, shortest_text(high)}};
  const bool is_fixed = size == 0 || (size >= kSmallestFixed && size < kLargestFixed);
  if (!(range > std::max(kMinRange, kMinRelativeRange * size))) return {{low, shortest_text(low)}};
  int exponent = exponent_of(range * least);
  double digit = 1;
  for (const double larger : {2.0, 5.0, 10.0}) {
    if (digit * std::pow(10, exponent) >= range * least * (1 - 1e-9)) break;
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

std::vector<Tick> ticks_of(const points::ValueScale& scale, double least) {
  const double low = std::min(scale.first(), scale.last()), high = std::max(scale.first(), scale.last());
  constexpr double kTiny = 1e-9;  // relative; ends may be rounded
  const double decades = scale.is_log() ? std::log10(high / low) : 0;
  if (!(decades >= 1 - kTiny) || !std::isfinite(decades)) return nice_ticks(scale.first(), scale.last(), least);
  const double most_ticks = std::min(8.0, std::max(1.0, 1 / least));
  const int step = static_cast<int>(std::ceil(decades / most_ticks));
  std::vector<Tick> out;
  for (int exponent = exponent_of(low); exponent <= exponent_of(high * (1 + kTiny)); ++exponent) {
    if (exponent % step != 0) continue;
    for (const int digit : {1, 2, 5}) {
      if (digit > 1 && (decades >= 3 || 3 * decades > most_ticks)) continue;
      // The closest double; 0 if there is none.
      const double value = base::number_of<double>(fmt::format("{}e{}", digit, exponent)).value_or(0);
      if (value >= low * (1 - kTiny) && value <= high * (1 + kTiny)) out.push_back({value, shortest_text(value)});
    }
  }
  return out;
}

}  // namespace orrery::annotation
