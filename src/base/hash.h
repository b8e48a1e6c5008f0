// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace orrery::base {

/// FNV-1a over 64-bit words. Folds high bits down, since the product carries only upwards. Not cryptographic.
///
/// Reference  fnv
class Hash {
 public:
  void add(double x) { add_bits(std::bit_cast<std::uint64_t>(x)); }
  void add_bits(std::uint64_t bits) {
    state_ = (state_ ^ bits) * 0x100000001b3u;
    state_ ^= state_ >> 29;
  }
  /// Sixteen hexadecimal digits.
  std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof(digits), "%016" PRIx64, state_);
    return digits;
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
