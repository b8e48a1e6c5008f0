// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <gtest/gtest.h>

#include <string>

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
