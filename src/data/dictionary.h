// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "data/table.h"

namespace orrery::data {

/// Numbers distinct strings in order of first appearance.
///
/// `Word`     std::string, or std::string_view of text that the caller keeps
template <class Word = std::string>
class Dictionary {
 public:
  std::uint32_t index_of(std::string_view word) {
    // Neighbouring rows mostly share the string.
    if (last_ < words_.size() && words_[last_] == word) return last_;
    auto at = indices_.find(word);
    if (at == indices_.end()) {
      at = indices_.emplace(word, static_cast<std::uint32_t>(words_.size())).first;
      words_.emplace_back(word);
    }
    return last_ = at->second;
  }

  const std::vector<Word>& words() const { return words_; }
  std::vector<Word> take() { return std::move(words_); }
  void clear() {
    words_.clear();
    indices_.clear();
  }

 private:
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };

  std::vector<Word> words_;
  std::unordered_map<Word, std::uint32_t, Hash, std::equal_to<>> indices_;
  std::uint32_t last_ = 0;
};

/// A text column under construction.
class WordColumn {
 public:
  void add(std::string_view word) { index_.push_back(dictionary_.index_of(word)); }
  Words take() { return {dictionary_.take(), std::move(index_)}; }

 private:
  Dictionary<> dictionary_;
  std::vector<std::uint32_t> index_;
};

}  // namespace orrery::data
