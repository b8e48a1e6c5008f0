// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte.h"

#include <gtest/gtest.h>

namespace orrery::film {
namespace {

/// Published vectors of the hash, all lengths of its last block.
TEST(FilmCryptomatte, MatchesMurmurHash3) {
  EXPECT_EQ(murmur3(""), 0u);
  EXPECT_EQ(murmur3("", 1), 0x514e28b7u);
  EXPECT_EQ(murmur3("", 0xffffffffu), 0x81f16f39u);
  EXPECT_EQ(murmur3("test"), 0xba6bd213u);
  EXPECT_EQ(murmur3("Hello, world!"), 0xc0363e43u);
  EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  EXPECT_EQ(murmur3(std::string("\0\0\0", 3)), 0x85f0b427u);
  EXPECT_EQ(murmur3("\xff\xff\xff\xff"), 0x76293b50u);
}

TEST(FilmCryptomatte, MatchesTheIdsOfTheSpecification) {
  EXPECT_EQ(matte_id_text(matte_id("bunny")), "13851a76");
  EXPECT_EQ(matte_id_text(matte_id("default")), "42c9679f");
  EXPECT_EQ(matte_id_text(matte_id("CryptoObject")).substr(0, 7), "3ae39a5");
  EXPECT_EQ(matte_id_text(0xau), "0000000a");
}

TEST(FilmCryptomatte, NoIdIsInfiniteNanOrSubnormal) {
  int moved = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string name = "sphere." + std::to_string(i);
    const std::uint32_t exponent = matte_id(name) >> 23 & 0xff;
    ASSERT_NE(exponent, 0u) << name;
    ASSERT_NE(exponent, 0xffu) << name;
    moved += matte_id(name) != murmur3(name) ? 1 : 0;
  }
  EXPECT_GT(moved, 80);  // 2 of 256
  EXPECT_LT(moved, 240);
}

}  // namespace
}  // namespace orrery::film
