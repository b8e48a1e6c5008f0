// SPDX-License-Identifier: Apache-2.0
#include "data/elements.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/text.h"
#include "data/text_cursor.h"

namespace orrery::data {

int atomic_number(std::string_view word) {
  word = trimmed(word);
  const std::string symbol = base::lower(word);
  if (symbol == "d") return 1;
  for (std::size_t i = 0; i < kElementSymbols.size(); ++i)
    if (symbol == base::lower(kElementSymbols[i])) return static_cast<int>(i) + 1;
  constexpr auto kLast = static_cast<int>(kElementSymbols.size());
  int number = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_number = status == std::errc() && end == word.data() + word.size();
  return is_number && number >= 1 && number <= kLast ? number : 0;
}

void settle_element(const std::vector<std::string>& names, Roles& roles) {
  if (std::all_of(names.begin(), names.end(), [](const std::string& name) { return atomic_number(name) != 0; })) return;
  const std::string column = std::exchange(roles.element, {});
  if (roles.type.empty()) roles.type = column;
}

}  // namespace orrery::data
