// SPDX-License-Identifier: Apache-2.0
#include "plot/range.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::plot {
namespace {

/// Values that are kept for percentiles, 128 MiB, and for crowded().
constexpr std::size_t kMaxKept = std::size_t{1} << 24, kMaxSample = std::size_t{1} << 16;

/// Parses "0.5" or "99%". None if it is neither.
std::optional<RangeChoice::End> parse_end(std::string_view text) {
  const bool is_percentile = text.ends_with('%');
  if (is_percentile) text.remove_suffix(1);
  RangeChoice::End out{0, is_percentile};
  if (!base::from_text(text, out.value) || !std::isfinite(out.value)) return {};
  return out;
}

void parse_ends(std::string_view word, const std::string& text, RangeChoice& out) {
  const std::size_t colon = word.find(':');
  const auto low = parse_end(word.substr(0, colon));
  const auto high = colon == std::string_view::npos ? std::nullopt : parse_end(word.substr(colon + 1));
  if (!low || !high)
    base::refuse(fmt::format(
        "--range: `{}` is not a range; write LOW:HIGH, e.g. 0:12 or 1%:99%, log, symmetric, or several with commas",
        text));
  for (const RangeChoice::End& end : {*low, *high}) {
    if (end.is_percentile && !(end.value >= 0 && end.value <= 100))
      base::refuse("--range: percentiles are from 0% to 100%");
    if (std::abs(end.value) > scene::kLargestValue) base::refuse("--range: the numbers must be from -1e+300 to 1e+300");
  }
  if (low->is_percentile == high->is_percentile && !(low->value < high->value))
    base::refuse("--range: the first number must be less than the second");
  out.low = *low;
  out.high = *high;
}

}  // namespace

std::optional<scene::Interval> RangeChoice::fixed() const {
  if (low.is_percentile || high.is_percentile) return {};
  if (!is_symmetric) return scene::Interval{low.value, high.value};
  const double reach = std::max(std::abs(low.value), std::abs(high.value));
  return scene::Interval{-reach, reach};
}

RangeChoice parse_range(const std::string& text) {
  RangeChoice out;
  out.is_set = true;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view word = std::string_view(text).substr(begin, end - begin);
    if (word == "log")
      out.is_log = true;
    else if (word == "symmetric")
      out.is_symmetric = true;
    else
      parse_ends(word, text, out);
    begin = end + 1;
  }
  if (out.is_log && out.is_symmetric) base::refuse("--range: log excludes symmetric: logarithms have values above 0");
  if (out.is_log &&
      ((!out.low.is_percentile && !(out.low.value > 0)) || (!out.high.is_percentile && !(out.high.value > 0))))
    base::refuse("--range: the numbers must be above 0 with log");
  return out;
}

RangeFinder::RangeFinder(const RangeChoice& choice) : choice_(choice) {
  const auto needs_values = [](const RangeChoice::End& end) {
    return end.is_percentile && end.value != 0 && end.value != 100;
  };
  needs_values_ = needs_values(choice.low) || needs_values(choice.high);
}

void RangeFinder::add(double value) {
  extremes_.low = count_ == 0 ? value : std::min(extremes_.low, value);
  extremes_.high = count_ == 0 ? value : std::max(extremes_.high, value);
  if (count_ % stride_ == 0) values_.push_back(value);
  ++count_;
  if (values_.size() < (needs_values_ ? kMaxKept : kMaxSample)) return;
  for (std::size_t i = 0; i < values_.size() / 2; ++i) values_[i] = values_[2 * i];
  values_.resize(values_.size() / 2);
  stride_ *= 2;
}

double RangeFinder::end(const RangeChoice::End& end) {
  if (!end.is_percentile) return end.value;
  if (end.value == 0) return extremes_.low;
  if (end.value == 100) return extremes_.high;
  const auto rank = static_cast<std::ptrdiff_t>(std::lround(end.value / 100 * static_cast<double>(values_.size() - 1)));
  std::nth_element(values_.begin(), values_.begin() + rank, values_.end());
  return values_[static_cast<std::size_t>(rank)];
}

double rounded(double x, int digits) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.*g", digits, x);
  return std::strtod(text, nullptr);
}

std::string range_text(const scene::Interval& range) {
  const auto digits_suffice = [&](int digits) {
    const double error =
        std::max(std::abs(rounded(range.low, digits) - range.low), std::abs(rounded(range.high, digits) - range.high));
    return range.low == range.high || error <= (range.high - range.low) / 1000;
  };
  int digits = 4;
  while (digits < 17 && !digits_suffice(digits)) ++digits;
  return scene::number_text(rounded(range.low, digits)) + ":" + scene::number_text(rounded(range.high, digits));
}

scene::Interval RangeFinder::range() {
  scene::Interval out{end(choice_.low), end(choice_.high)};
  if (!(out.low <= out.high))
    throw base::Error(base::ErrorKind::kBadData,
                      fmt::format("--range: {} is not below {}; the values are from {} to {}",
                                  scene::number_text(out.low), scene::number_text(out.high),
                                  scene::number_text(extremes_.low), scene::number_text(extremes_.high)));
  if (!choice_.is_symmetric) return out;
  const double reach = std::max(std::abs(out.low), std::abs(out.high));
  return {-reach, reach};
}

std::optional<scene::Interval> RangeFinder::crowded() {
  if (needs_values_ || !choice_.low.is_percentile || !choice_.high.is_percentile || choice_.is_log) return {};
  std::sort(values_.begin(), values_.end());
  const std::size_t most = (99 * values_.size() + 99) / 100;
  const double tenth = extremes_.high / 10 - extremes_.low / 10;
  for (std::size_t i = 0; i + most <= values_.size(); ++i)
    if (values_[i + most - 1] - values_[i] <= tenth && tenth > 0)
      return scene::Interval{values_[i], values_[i + most - 1]};
  return {};
}

}  // namespace orrery::plot
