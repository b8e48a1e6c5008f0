// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>

#include "base/stop_point.h"

namespace orrery::base {

/// Accumulates the items 0 .. count - 1 on all threads. The result does not depend on their number, even for sums of
/// floating-point numbers.
///
/// `start`    a value of no items
/// `add`      add(value, i) includes an item in a value
/// `join`     join(a, b) includes the value b in a
/// Errors     base::Error(kStopped) in a StopScope
template <class Value, class Add, class Join>
Value accumulate_parallel(std::size_t count, const Value& start, Add add, Join join) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  const StopPoint stop;
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, count, kBlock), start,
      [&](const tbb::blocked_range<std::size_t>& block, Value value) {
        stop.check();
        for (std::size_t i = block.begin(); i < block.end(); ++i) add(value, i);
        return value;
      },
      [&](Value a, const Value& b) {
        join(a, b);
        return a;
      });
}

/// Returns whether `is_good(i)` is true for all items 0 .. count - 1; on all threads.
template <class IsGood>
bool are_all(std::size_t count, IsGood is_good) {
  return accumulate_parallel(
      count, true, [&](bool& all, std::size_t i) { all = all && is_good(i); }, [](bool& a, bool b) { a = a && b; });
}

}  // namespace orrery::base
