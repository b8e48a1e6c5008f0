// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte.h"

#include <bit>
#include <cstdio>

namespace orrery::film {
namespace {

std::uint32_t scrambled(std::uint32_t k) { return std::rotl(k * 0xcc9e2d51u, 15) * 0x1b873593u; }

}  // namespace

std::uint32_t murmur3(const std::string& text, std::uint32_t seed) {
  const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(text[i])}; };
  std::uint32_t h = seed;
  std::size_t i = 0;
  for (; i + 4 <= text.size(); i += 4) {
    h ^= scrambled(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    h = std::rotl(h, 13) * 5 + 0xe6546b64u;
  }
  std::uint32_t rest = 0;
  for (std::size_t k = text.size(); k > i; --k) rest = rest << 8 | byte(k - 1);
  if (i < text.size()) h ^= scrambled(rest);
  h ^= static_cast<std::uint32_t>(text.size());
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

std::uint32_t matte_id(const std::string& name) {
  const std::uint32_t hash = murmur3(name);
  const std::uint32_t exponent = hash >> 23 & 0xff;
  return exponent == 0 || exponent == 0xff ? hash ^ 1u << 23 : hash;
}

std::string matte_id_text(std::uint32_t id) {
  char text[9];
  std::snprintf(text, sizeof(text), "%08x", id);
  return text;
}

}  // namespace orrery::film
