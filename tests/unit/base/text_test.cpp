// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/atomic_file.h"

namespace orrery::base {
namespace {

const std::vector<std::string> kKeys = {"samples", "max_depth", "seed", "precision", "shading", "accelerator"};

TEST(BaseText, FindsInsertedDeletedReplacedAndSwappedLetters) {
  EXPECT_EQ(closest("sampless", kKeys), "samples");
  EXPECT_EQ(closest("sampes", kKeys), "samples");
  EXPECT_EQ(closest("sanples", kKeys), "samples");
  EXPECT_EQ(closest("smaples", kKeys), "samples");
}

TEST(BaseText, TranspositionCountsAsOneEdit) {
  // Four letters allow one edit: two edits would be too many.
  EXPECT_EQ(closest("sede", {"seed"}), "seed");
}

TEST(BaseText, IgnoresCase) { EXPECT_EQ(closest("Max_Depth", kKeys), "max_depth"); }

TEST(BaseText, EmptyIfNothingIsClose) {
  EXPECT_EQ(closest("gamma", kKeys), "");
  EXPECT_EQ(closest("", kKeys), "");
  EXPECT_EQ(closest("seed", {}), "");
  EXPECT_EQ(closest("r", {"x", "y", "z"}), "") << "single letters have nothing in common";
}

TEST(BaseText, ChoosesTheClosest) {
  EXPECT_EQ(closest("material", {"materials", "material_"}), "materials") << "the first of equally close candidates";
  EXPECT_EQ(closest("shadin", {"shadow", "shading"}), "shading");
}

TEST(BaseText, VeryLongNamesAreNotCompared) {
  EXPECT_EQ(closest(std::string(100000, 'a'), {std::string(100000, 'a')}), "");
}

TEST(BaseText, DidYouMeanIsEmptyWithoutACandidate) {
  EXPECT_EQ(did_you_mean("sampels", kKeys), "did you mean `samples`?");
  EXPECT_EQ(did_you_mean("gamma", kKeys), "");
}

TEST(BaseText, JoinsWithCommas) {
  EXPECT_EQ(joined({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(joined({}), "");
}

TEST(BaseText, ANumberIsTheWholeText) {
  EXPECT_EQ(number_of<int>("42"), 42);
  EXPECT_EQ(number_of<double>("-1.5e3"), -1500);
  for (const char* text : {"", "4x", "x4", "1 2"}) EXPECT_FALSE(number_of<int>(text)) << text;
  EXPECT_FALSE(number_of<std::uint8_t>("256"));
}

TEST(BaseText, OneIsSingular) {
  EXPECT_EQ(counted(1, "rod"), "1 rod");
  EXPECT_EQ(counted(0, "rod"), "0 rods");
}

TEST(BaseText, ReplacesAllOccurrences) {
  EXPECT_EQ(replaced("a.b.", ".", ".."), "a..b..");
  EXPECT_EQ(replaced("", ".", "x"), "");
}

TEST(BaseText, BytesHaveTheLargestUnitAboveOne) {
  EXPECT_EQ(bytes_text(0), "0.0 KiB");
  EXPECT_EQ(bytes_text(1536), "1.5 KiB");
  EXPECT_EQ(bytes_text(1024 * 1024), "1.0 MiB");
  EXPECT_EQ(bytes_text(5ull << 40), "5.0 TiB");
  EXPECT_EQ(bytes_text(5ull << 50), "5120.0 TiB");
}

TEST(BaseText, PrintableTextIsUtf8WithoutControlCharacters) {
  for (const char* text : {"", "a b", "~$`'\"\\", "\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\x98\x80"})
    EXPECT_TRUE(is_printable(text)) << text;
  for (const char* text : {"\n", "a\tb", "\x1B[2J", "\x7F", "\xC2\x85", "\xFF", "\xC3", "\xC0\x80", "\xED\xA0\x80",
                           "\xEF\xBF\xBF", "\xF4\x90\x80\x80"})
    EXPECT_FALSE(is_printable(text)) << text;
}

TEST(BaseText, OnlyWordsWithSpecialCharactersAreQuoted) {
  EXPECT_EQ(shell_quoted("a/b.png"), "a/b.png");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted("5 \u00C5"), "'5 \u00C5'");
  EXPECT_EQ(shell_quoted("a\x15!'\\"), "$'a\\025\\041\\047\\134'");
}

/// What bash makes of words that it reads from a script.
std::string words_in_bash(const std::vector<std::string>& words) {
  const TempDir folder;
  const std::string script = (folder.path() / "script").string();
  std::ofstream out(script, std::ios::binary);
  out << "printf '%s\\n\\0'";
  for (const std::string& word : words) out << ' ' << word;
  out << '\n';
  out.close();
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> bash(popen(("LC_ALL=C bash " + script).c_str(), "r"), pclose);
  std::string text;
  for (int c = std::fgetc(bash.get()); c != EOF; c = std::fgetc(bash.get())) text += static_cast<char>(c);
  return text;
}

TEST(BaseText, BashReadsQuotedWordsAsTheyWereAndTheyArePrintable) {
  std::mt19937 random(1);
  std::vector<std::string> quoted_words;
  std::string expected;
  const auto add = [&](const std::string& word) {
    EXPECT_TRUE(is_printable(shell_quoted(word))) << printable(word);
    quoted_words.push_back(shell_quoted(word));
    expected += word + std::string("\n\0", 2);
  };
  for (int byte = 1; byte < 256; ++byte) add({static_cast<char>(byte)});
  for (int i = 0; i < 5000; ++i) {
    // Half of the words are made of few characters, among which those that matter to a shell are frequent.
    const std::string few = "a7 '\"\\$`!\n\x15\x0f\x1b\x85\xc2\xc3\xa9";
    std::string word(random() % 12, '\0');
    for (char& c : word) c = i % 2 == 0 ? few[random() % few.size()] : static_cast<char>(1 + random() % 255);
    add(word);
  }
  EXPECT_EQ(words_in_bash(quoted_words), expected);
}

TEST(BaseText, EncodesTheTestVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(BaseText, EncodesBytesAbove127AndZero) {
  EXPECT_EQ(base64(std::string("\xff\xfe\x00\x80", 4)), "//4AgA==");
  EXPECT_EQ(base64("\xfb\xef\xbe"), "++++");
}

}  // namespace
}  // namespace orrery::base
