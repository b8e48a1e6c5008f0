// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "data/table.h"

namespace orrery::arrays {

/// Builds a text column row by row.
class WordIndex {
 public:
  void add(std::string_view word) {
    if (words_.index.empty() || words_.words[words_.index.back()] != word) {
      const auto [at, is_new] =
          indices_.try_emplace(std::string(word), static_cast<std::uint32_t>(words_.words.size()));
      if (is_new) words_.words.emplace_back(word);
      words_.index.push_back(at->second);
    } else {
      words_.index.push_back(words_.index.back());
    }
  }
  data::Words take() { return std::move(words_); }

 private:
  data::Words words_;
  std::unordered_map<std::string, std::uint32_t> indices_;
};

}  // namespace orrery::arrays
