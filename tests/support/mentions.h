// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace orrery::test {

/// Whether a message contains all of `facts`, in this order: names, numbers and key words, whose wording between them
/// may change.
inline testing::AssertionResult mentions(std::string_view message, const std::vector<std::string_view>& facts) {
  std::size_t from = 0;
  for (const std::string_view fact : facts) {
    const std::size_t at = message.find(fact, from);
    if (at == std::string_view::npos)
      return testing::AssertionFailure() << "`" << message << "` lacks `" << fact << "`"
                                         << (from > 0 ? " after the facts before it" : "");
    from = at + fact.size();
  }
  return testing::AssertionSuccess();
}

}  // namespace orrery::test
