// SPDX-License-Identifier: Apache-2.0
#include "data/text_number.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>

namespace orrery::data {
namespace {

/// strtod() of glibc is correctly rounded.
void expect_number(const std::string& word) {
  double value = -1;
  ASSERT_TRUE(parse_number(word, value)) << word;
  const auto expected = std::bit_cast<std::uint64_t>(std::strtod(word.c_str(), nullptr));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(value), expected) << word << " " << value;
  const std::string padded = word + std::string(kDecimalBytes, '\n');
  if (scan_decimal(padded.data(), value) != padded.data() + word.size()) return;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(value), expected) << word << " " << value;
}

TEST(DataTextNumber, AreCorrectlyRounded) {
  for (const char* const word : {"0",
                                 "-0",
                                 "-0.0",
                                 "1",
                                 "+1",
                                 "1.",
                                 ".5",
                                 "-.5",
                                 "+.5e1",
                                 "00012.500",
                                 "1e22",
                                 "1e23",
                                 "9007199254740993",
                                 "9007199254740992.5",
                                 "18446744073709551617",
                                 "1844674407370955161.7",
                                 "123456789012345678901234567890",
                                 "0.1",
                                 "2.2250738585072014e-308",
                                 "5e-324",
                                 "2e-324",
                                 "1e-400",
                                 "-1e-400",
                                 "1e400",
                                 "-1e400",
                                 "1e-99999999999999999999",
                                 "1e99999999999999999999",
                                 "0e999999999",
                                 "1.7976931348623157e308",
                                 "1.7976931348623159e308",
                                 "12345678",
                                 "123456789",
                                 "1234567.8",
                                 "1234567.89",
                                 "0.00000001",
                                 "0.000000001",
                                 "1E5",
                                 "1e+5",
                                 "1e05",
                                 "inf",
                                 "-inf",
                                 "Infinity",
                                 "107.484",
                                 "0.0729685",
                                 "8.5e-05",
                                 "-12345.678e-3"})
    expect_number(word);
  expect_number("0." + std::string(400, '0') + "1");
  expect_number("1" + std::string(400, '0'));
  expect_number("1" + std::string(400, '0') + "e-400");
  expect_number("0." + std::string(400, '0') + "1e401");
}

TEST(DataTextNumber, AreCorrectlyRoundedAtRandom) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 200000; ++i) {
    char word[64];
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    std::snprintf(word, sizeof word, "%.*g", static_cast<int>(random() % 19) + 1, value);
    expect_number(word);
    std::snprintf(
        word, sizeof word, "%.*g", static_cast<int>(random() % 9) + 1,
        std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), -static_cast<int>(random() % 80)));
    expect_number(word);
    std::snprintf(
        word, sizeof word, "%.*f", static_cast<int>(random() % 12),
        std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), -40 - static_cast<int>(random() % 30)));
    expect_number(word);
  }
}

/// The number of characters that scan_decimal() takes.
std::size_t scanned(const std::string& text, double& value) {
  const std::string padded = text + std::string(kDecimalBytes, '\n');
  const char* const end = scan_decimal(padded.data(), value);
  return end == nullptr ? 0 : static_cast<std::size_t>(end - padded.data());
}

TEST(DataTextNumber, DecimalNumbersAreScanned) {
  double value = -1;
  for (const char* const word : {"0.5", "-.5", "7.", "-0.0", "1234567.8", "1234567.12345678", "-0.00000000000001"}) {
    EXPECT_EQ(scanned(word, value), std::string_view(word).size()) << word;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(std::strtod(word, nullptr))) << word;
  }
  for (const char* const word :
       {"", ".", "-", "-.", "+1.5", "12", "12345678.5", "e.5", "--1.5", "nan", ",1.5", "\xFF.5"})
    EXPECT_EQ(scanned(word, value), 0u) << word;
  EXPECT_EQ(scanned("1.5e3", value), 3u);
  EXPECT_EQ(scanned("1.5.2", value), 3u);
  EXPECT_EQ(scanned("0.1234567890123456", value), 16u) << "there are more digits than it takes";
}

TEST(DataTextNumber, DecimalNumbersAreCorrectlyRounded) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 2000000; ++i) {
    std::string word = random() % 2 == 0 ? "" : "-";
    for (std::uint64_t left = random() % 8; left > 0; --left) word += static_cast<char>('0' + random() % 10);
    word += '.';
    for (std::uint64_t left = random() % 8 + 1; left > 0; --left) word += static_cast<char>('0' + random() % 10);
    double value = -1, expected = 0;
    ASSERT_EQ(scanned(word, value), word.size()) << word;
    std::from_chars(word.data(), word.data() + word.size(), expected);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected)) << word;
  }
}

TEST(DataTextNumber, ExponentsMayBeFortran) {
  double value = 0;
  ASSERT_TRUE(parse_number("1.5d2", value));
  EXPECT_EQ(value, 150);
  ASSERT_TRUE(parse_number("-1.5D-02", value));
  EXPECT_EQ(value, -0.015);
  ASSERT_TRUE(parse_number("0.12345678901234567890123D+01", value));
  EXPECT_EQ(value, 1.2345678901234567890123);
  ASSERT_TRUE(parse_number("NaN", value));
  EXPECT_TRUE(std::isnan(value));
  ASSERT_TRUE(parse_number("-nan", value));
  EXPECT_TRUE(std::isnan(value));
}

TEST(DataTextNumber, OtherWordsAreRefused) {
  double value = 0;
  for (const char* const word : {"",      "-",     "+",   ".",         "-.",     "e5",   "1e",   "1e+", "1.5.2", "1,5",
                                 "0x10",  "--1",   "+-1", "-+1",       "1-",     "nano", "infx", "1 ",  " 1",    "1d",
                                 "1d5e2", "1_000", "in",  "12345678x", "1.5e5.", "+ 1",  "1\n2", "\n",  "d5"})
    EXPECT_FALSE(parse_number(word, value)) << word;
  EXPECT_FALSE(parse_number(std::string_view("1\0", 2), value));
}

}  // namespace
}  // namespace orrery::data
