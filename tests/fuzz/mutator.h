// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace orrery::fuzz {

/// Mutates valid files. The result depends on the seed only, not on the machine.
class Mutator {
 public:
  /// `words` are tokens of the format; mutations insert them at random positions.
  Mutator(std::uint64_t seed, std::vector<std::string> good, std::vector<std::string> words)
      : random_(seed), good_(std::move(good)), words_(std::move(words)) {}

  /// Returns one of the valid files after one to eight mutations.
  std::string mutant();
  /// Returns up to `most` random bytes.
  std::string noise(std::size_t most);

 private:
  std::size_t below(std::size_t end) { return end == 0 ? 0 : static_cast<std::size_t>(random_() % end); }
  void accident(std::string& bytes);

  std::mt19937_64 random_;  // used without std distributions, which differ between libraries
  std::vector<std::string> good_, words_;
};

}  // namespace orrery::fuzz
