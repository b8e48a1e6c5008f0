// SPDX-License-Identifier: Apache-2.0
#include "data/text_lines.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::data {
namespace {

class DataTextLines : public testing::Test {
 protected:
  auto source(const std::string& text) {
    support::write_bytes(folder_ / "a.txt", text);
    return ByteSource::open(folder_ / "a.txt", 1 << 24);
  }
  support::TempDir folder_;
};

TEST_F(DataTextLines, RangesDivideTheLinesAmongThem) {
  const std::string text = "a\nbcd\n\nef\nghijklm\nn";
  const auto bytes = source(text);
  for (std::uint64_t cut = 0; cut <= text.size(); ++cut) {
    TextLines lines;
    lines.read(*bytes, 0, cut, true);
    std::string all(lines.begin(), lines.end());
    std::uint64_t count = lines.count();
    lines.read(*bytes, cut, text.size(), false);
    if (cut > 0) {
      all.append(lines.begin(), lines.end());
      count += lines.count();
      EXPECT_EQ(all, text + "\n") << cut;
      EXPECT_EQ(count, 6u) << cut;
    }
  }
}

TEST_F(DataTextLines, BlankLinesAndCommentsHaveNoRow) {
  const auto bytes = source("1\n \t\r\n# x\n#ff0000\n%% y\n");
  TextLines lines;
  lines.read(*bytes, 0, bytes->size(), true);
  EXPECT_EQ(lines.count(), 5u);
  EXPECT_EQ(lines.filled_count(false), 4u);
  EXPECT_EQ(lines.filled_count(true), 2u);
}

TEST_F(DataTextLines, NewlinesAreCountedInLongTexts) {
  std::string text(100'000, 'x');
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < text.size(); i += 1 + i % 7) {
    text[i] = '\n';
    ++count;
  }
  EXPECT_EQ(newline_count(text.data(), text.data() + text.size()), count);
}

TEST_F(DataTextLines, ACursorReadsAndSkipsLines) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += "line " + std::to_string(i) + (i % 2 == 0 ? "\r\n" : "\n");
  text += " \nlast";
  const auto bytes = source(text);
  TextCursor cursor(*bytes);
  std::string line;
  ASSERT_TRUE(cursor.next(line));
  EXPECT_EQ(line, "line 0");
  EXPECT_EQ(cursor.skip(4000), 4000u);
  EXPECT_EQ(cursor.line(), 4002u);
  ASSERT_TRUE(cursor.next(line));
  EXPECT_EQ(line, "line 4001");
  EXPECT_EQ(cursor.skip(998), 998u);
  EXPECT_TRUE(cursor.has_filled());
  ASSERT_TRUE(cursor.next_filled(line));
  EXPECT_EQ(line, "last");
  EXPECT_FALSE(cursor.has_filled());
  EXPECT_FALSE(cursor.next(line));
  EXPECT_EQ(cursor.skip(3), 0u);
  const auto unended = source("a\nb");
  EXPECT_EQ(TextCursor(*unended).skip(9), 2u) << "the last line lacks its end";
}

TEST_F(DataTextLines, LongLinesAreRefusedWithTheirNumber) {
  const auto bytes = source("a\n" + std::string(kMaxLineBytes + 10, 'x'));
  TextCursor cursor(*bytes);
  std::string line;
  ASSERT_TRUE(cursor.next(line));
  try {
    cursor.next(line);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_EQ(error.diagnostics().at(0).line, 2);
  }
}

TEST_F(DataTextLines, WordsAreSeparatedByBlanks) {
  EXPECT_EQ(trimmed(" \ta b\r"), "a b");
  EXPECT_EQ(words_of("  a\tbc \r"), (std::vector<std::string_view>{"a", "bc"}));
  EXPECT_EQ(words_of("a,b,,c", ","), (std::vector<std::string_view>{"a", "b", "c"}));
}

}  // namespace
}  // namespace orrery::data
