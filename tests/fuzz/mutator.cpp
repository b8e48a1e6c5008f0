// SPDX-License-Identifier: Apache-2.0
#include "fuzz/mutator.h"

#include <algorithm>

namespace orrery::fuzz {

void Mutator::accident(std::string& bytes) {
  const std::size_t at = below(bytes.size() + 1);
  const std::size_t length = below(std::min<std::size_t>(bytes.size() - at, 40) + 1);
  switch (below(8)) {
    case 0:  // flip a bit
      if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      return;
    case 1: bytes.resize(at); return;
    case 2: bytes.erase(at, length); return;
    case 3: bytes.insert(at, bytes.substr(at, length)); return;
    case 4: bytes.insert(below(bytes.size() + 1), bytes.substr(at, length)); return;
    case 5: bytes.insert(at, words_[below(words_.size())]); return;
    case 6: bytes.replace(at, length, words_[below(words_.size())]); return;
    default: bytes.insert(at, good_[below(good_.size())].substr(0, length)); return;
  }
}

std::string Mutator::mutant() {
  std::string bytes = good_[below(good_.size())];
  for (std::size_t i = below(8) + 1; i > 0; --i) accident(bytes);
  return bytes;
}

std::string Mutator::noise(std::size_t most) {
  std::string bytes(below(most + 1), '\0');
  for (char& byte : bytes) byte = static_cast<char>(random_());
  return bytes;
}

}  // namespace orrery::fuzz
