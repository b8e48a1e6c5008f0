// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace orrery::fuzz {

/// Makes bad files out of good ones, the same on every machine.
class Mutator {
 public:
  /// `words` are what the format is made of: put in where they do not belong.
  Mutator(std::uint64_t seed, std::vector<std::string> good, std::vector<std::string> words)
      : random_(seed), good_(std::move(good)), words_(std::move(words)) {}

  /// One of the good files after one to eight small accidents.
  std::string mutant();
  /// Up to `most` bytes of nothing.
  std::string noise(std::size_t most);

 private:
  std::size_t below(std::size_t end) { return end == 0 ? 0 : static_cast<std::size_t>(random_() % end); }
  void accident(std::string& bytes);

  std::mt19937_64 random_;  // its distributions differ between libraries, its numbers do not
  std::vector<std::string> good_, words_;
};

}  // namespace orrery::fuzz
