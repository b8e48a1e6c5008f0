// SPDX-License-Identifier: Apache-2.0
#include "base/base64.h"

#include <cstddef>
#include <cstdint>

namespace orrery::base {

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out((bytes.size() + 2) / 3 * 4, '=');
  char* to = out.data();
  const auto add = [&](std::uint32_t word, int digits) {
    for (int k = 0; k < digits; ++k) *to++ = kDigits[word >> (18 - 6 * k) & 63];
  };
  const auto word_of = [&](std::size_t i, std::size_t count) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < count; ++k)
      word |= std::uint32_t{static_cast<unsigned char>(bytes[i + k])} << (16 - 8 * k);
    return word;
  };
  const std::size_t whole = bytes.size() - bytes.size() % 3;
  for (std::size_t i = 0; i < whole; i += 3) add(word_of(i, 3), 4);
  if (whole < bytes.size()) add(word_of(whole, bytes.size() - whole), static_cast<int>(bytes.size() - whole) + 1);
  return out;
}

}  // namespace orrery::base
