// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cinttypes>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/text.h"

namespace orrery::base {

/// FNV-1a over 64-bit words. Folds high bits down, since the product carries only upwards. Not cryptographic.
///
/// Reference  fnv
class Hash {
 public:
  void add(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof(bits));
    add_bits(bits);
  }
  void add_bits(std::uint64_t bits) {
    state_ = (state_ ^ bits) * 0x100000001b3u;
    state_ ^= state_ >> 29;
  }
  /// Sixteen hexadecimal digits.
  std::string text() const {
    std::string out;
    append(out, "%016" PRIx64, state_);
    return out;
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

/// The hash of the bytes of a text.
inline std::string text_hash(std::string_view text) {
  Hash hash;
  for (const char c : text) hash.add_bits(static_cast<unsigned char>(c));
  return hash.text();
}

}  // namespace orrery::base
